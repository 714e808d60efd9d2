// A program that embeds the engine. The part between the marks is README's example; tests/package compiles and runs it. Argument: the PNG to write.
// [readme]
#include <burnish/renderer.h>
using namespace burnish;

// `gl` is your context's getProcAddress, `target` your framebuffer and its size.
Result<FrameStats> drawFrame(const ProcAddress& gl, const Target& target) {
  Scene scene;
  const Material gold{.name = "gold", .albedo = findSubstance("gold")->f0, .substance = 1, .roughness = 0.3f};
  const Mesh square{.name = "square", .positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, .indices = {0, 1, 2, 0, 2, 3}};
  Report report;
  const auto mesh = validated(square, report);  // checks it and makes what is missing: here, normals
  if (!mesh) return fail(mesh.error());
  const auto node = scene.nodes.add({});
  scene.instances.add({.name = "square", .node = node, .mesh = scene.meshes.add(*mesh), .material = scene.materials.add(gold)});
  scene.lights.add({.name = "sun", .kind = LightKind::Directional, .node = node, .intensity = 1});
  scene.environment.color = {0.5f, 0.5f, 0.5f};

  auto renderer = Renderer::create(gl, {.hostState = HostState::Save});  // keep it: one a context, for all frames
  if (!renderer) return fail(renderer.error());
  const View view = lookAt({0, 0, 4}, {0, 0, 0});
  return (*renderer)->render(scene, {&view, 1}, target, {.exposureEv = 3});
}
// [/readme]

#include <cstdio>
#include <cstdlib>

static Result<Image> picture() {
  auto context = Context::create({});
  if (!context) return fail(context.error());
  const ProcAddress gl = (*context)->procAddress();
  auto target = OffscreenTarget::create(gl, {320, 180}, Output::Display);
  if (!target) return fail(target.error());
  if (const auto frame = drawFrame(gl, (*target)->target()); !frame) return fail(frame.error());
  return (*target)->read();
}

static const std::uint8_t* pixel(const Image& image, int x, int y) {
  return image.u8() + (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * 4;
}

int main(int argc, char** argv) {
  const auto image = picture();
  if (!image || argc < 2) {
    std::fprintf(stderr, "%s\n", image ? "usage: consumer IMG.png" : image.error().message().c_str());
    return 1;
  }
  if (const auto written = writePng(argv[1], *image); !written) {
    std::fprintf(stderr, "%s\n", written.error().message().c_str());
    return 1;
  }
  // Off the highlight the square is gold (red over green over blue); around it is the grey environment.
  const std::uint8_t* square = pixel(*image, 120, 50);
  const std::uint8_t* corner = pixel(*image, 2, 2);
  std::printf("square %d,%d,%d corner %d,%d,%d\n", square[0], square[1], square[2], corner[0], corner[1], corner[2]);
  const bool gold = square[0] > square[1] + 10 && square[1] > square[2] + 10 && square[0] < 255;
  const bool grey = corner[0] > 20 && std::abs(corner[0] - corner[1]) <= 2 && std::abs(corner[1] - corner[2]) <= 2;
  if (gold && grey) return 0;
  std::fprintf(stderr, "the picture is not what the scene says\n");
  return 1;
}
