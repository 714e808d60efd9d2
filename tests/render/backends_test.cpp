// The same picture from EGL and from OSMesa, of the fps sample.
#include <burnish/renderer.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>

#include "paths.h"

using namespace burnish;

namespace {

Image renderSample(Backend backend, const Scene& scene) {
  auto context = Context::create({.backend = backend});
  REQUIRE(context);
  const ProcAddress get = (*context)->procAddress();
  Image picture;
  {
    auto renderer = Renderer::create(get, {.debugOutput = true});
    REQUIRE(renderer);
    auto target = OffscreenTarget::create(get, {480, 270}, Output::Display);
    REQUIRE(target);
    View view;
    scene.cameras.each([&](Id<Camera>, const Camera& camera) {
      if (camera.name == "hero") view = viewOf(scene, camera);
    });
    auto stats = (*renderer)->render(scene, {&view, 1}, (*target)->target(), {.exposureEv = 4.0f}, {.countNonfinite = true});
    REQUIRE(stats);
    CHECK(stats->glErrors.empty());
    CHECK(stats->nonfinitePixels == 0);
    auto read = (*target)->read();
    REQUIRE(read);
    picture = std::move(*read);
  }
  (*context)->release();
  return picture;
}

}  // namespace

TEST_CASE("EGL and OSMesa give the same picture") {
  const std::filesystem::path file = BURNISH_BINARY_DIR "/share/burnish/samples/fps/fps.gltf";
  REQUIRE(std::filesystem::exists(file));
  auto decoder = makeDecoderPool({.helper = BURNISH_BINARY_DIR "/bin/burnish-decode"});
  Report report;
  auto scene = loadScene(file, {.decoder = decoder.get()}, report);
  if (!scene) FAIL(scene.error().message());
  const Image a = renderSample(Backend::Egl, *scene), b = renderSample(Backend::OsMesa, *scene);
  REQUIRE(a.byteSize() == b.byteSize());
  std::size_t over = 0;
  int largest = 0;
  for (std::size_t i = 0; i < a.pixelCount(); ++i) {
    int worst = 0;
    for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(int(a.u8()[i * 4 + c]) - int(b.u8()[i * 4 + c])));
    over += worst > 2;
    largest = std::max(largest, worst);
  }
  INFO("largest difference " << largest << ", pixels over 2/255: " << over << " of " << a.pixelCount());
  CHECK(double(over) <= 0.001 * double(a.pixelCount()));
  // Not a black or flat picture.
  const auto [low, high] = std::minmax_element(a.u8(), a.u8() + a.byteSize());
  CHECK(*high - *low > 200);
}
