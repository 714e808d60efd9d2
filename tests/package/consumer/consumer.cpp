// A program that embeds the engine: README's example, compiled and run by tests/package. Argument: the PNG to write.
// [readme]
#include <burnish/renderer.h>

#include <cstdio>

namespace bn = burnish;

static bn::Result<bn::Image> picture() {
  auto context = bn::Context::create({});  // or your own context: all that the engine needs of it is getProcAddress
  if (!context) return bn::fail(context.error());

  bn::Scene scene;
  bn::Material gold;
  gold.albedo = bn::findSubstance("gold")->f0;
  gold.substance = bn::encodeMetalness(1);
  gold.roughness = 0.3f;
  bn::Mesh square;
  square.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  square.indices = {0, 1, 2, 0, 2, 3};
  bn::Report report;
  auto mesh = bn::validated(square, report);
  if (!mesh) return bn::fail(mesh.error());
  const auto node = scene.nodes.add({});
  scene.instances.add({"square", node, scene.meshes.add(*mesh), scene.materials.add(gold)});
  scene.lights.add({.name = "sun", .kind = bn::LightKind::Directional, .node = node, .intensity = 10});
  scene.environment.color = glm::vec3(0.5f);

  auto renderer = bn::Renderer::create((*context)->procAddress());
  if (!renderer) return bn::fail(renderer.error());
  auto target = bn::OffscreenTarget::create((*context)->procAddress(), {320, 180}, bn::Output::Display);
  if (!target) return bn::fail(target.error());
  const bn::View view = bn::lookAt({0, 0, 4}, {0, 0, 0});
  auto frame = (*renderer)->render(scene, {&view, 1}, (*target)->target(), {});
  if (!frame) return bn::fail(frame.error());
  return (*target)->read();
}
// [/readme]

namespace {
const std::uint8_t* pixel(const bn::Image& image, int x, int y) { return image.u8() + (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * 4; }
}  // namespace

int main(int argc, char** argv) {
  const auto image = picture();
  if (!image || argc < 2) {
    std::fprintf(stderr, "%s\n", image ? "usage: consumer IMG.png" : image.error().message().c_str());
    return 1;
  }
  if (const auto written = bn::writePng(argv[1], *image); !written) {
    std::fprintf(stderr, "%s\n", written.error().message().c_str());
    return 1;
  }
  // Gold in the middle (red over green over blue), grey surroundings in the corner.
  const std::uint8_t* middle = pixel(*image, 160, 90);
  const std::uint8_t* corner = pixel(*image, 2, 2);
  std::printf("middle %d,%d,%d corner %d,%d,%d\n", middle[0], middle[1], middle[2], corner[0], corner[1], corner[2]);
  const bool gold = middle[0] > middle[1] + 10 && middle[1] > middle[2] + 10;
  const bool grey = corner[0] > 20 && std::abs(corner[0] - corner[1]) <= 2 && std::abs(corner[1] - corner[2]) <= 2;
  if (gold && grey) return 0;
  std::fprintf(stderr, "the picture is not what the scene says\n");
  return 1;
}
