#include "cost/studio.h"

#include <algorithm>
#include <cstring>

namespace burnish::cost {

Quality pictureKey(Quality quality, float exposureEv) {
  const Quality usual;
  quality.antialiasing = Antialiasing::None;
  quality.bloom = Bloom::None;
  quality.bloomShare = usual.bloomShare;
  quality.toneMap = usual.toneMap;
  quality.exposureEv = exposureEv;  // the light buffer's range is centred on it
  return quality;
}

Result<Image> linearPicture(Renderer& renderer, const OffscreenTarget& target, const Scene& scene, const View& view, const Quality& key) {
  RenderRequest request;
  request.output = Output::Linear;
  request.displayLight = true;  // what the light buffer rounds off is part of what a user sees
  if (const auto stats = renderer.render(scene, {&view, 1}, target.target(), key, request); !stats) return fail(stats.error());
  const auto rgba = target.read();
  if (!rgba) return fail(rgba.error());
  Image rgb = makeImage(rgba->width, rgba->height, 3, PixelType::F32);
  for (std::size_t i = 0; i < rgb.pixelCount(); ++i) std::memcpy(rgb.f32() + 3 * i, rgba->f32() + 4 * i, 3 * sizeof(float));
  return rgb;
}

Result<std::unique_ptr<Studio>> Studio::create(const ProcAddress& getProcAddress, const Bench& bench) {
  std::unique_ptr<Studio> studio(new Studio(bench));
  auto renderer = Renderer::create(getProcAddress, {.linkOnDemand = true});
  if (!renderer) return fail(renderer.error());
  studio->renderer_ = std::move(*renderer);
  for (const auto& [target, output] : {std::pair(&studio->display_, Output::Display), std::pair(&studio->linear_, Output::Linear)}) {
    auto made = OffscreenTarget::create(getProcAddress, bench.size(), output);
    if (!made) return fail(made.error());
    *target = std::move(*made);
  }
  return studio;
}

Result<Image> Studio::picture(const Scene& scene, const Quality& quality) {
  auto rgb = linearPicture(*renderer_, *linear_, scene, bench_.view(), pictureKey(quality, bench_.exposureEv()));
  if (rgb) bench_.hold(*rgb);
  return rgb;
}

Result<double> Studio::frame(const Scene& scene) {
  RenderRequest request;
  request.timing = TimingMode::Profile;
  request.sequence = &scene == &bench_.scene() ? 0 : 1;
  const auto stats = renderer_->render(scene, {&bench_.view(), 1}, display_->target(), bench_.base(), request);
  if (!stats) return fail(stats.error());
  double ms = 0;
  // Shadow maps are kept from one frame to the next of a scene; where two take turns they are drawn in each.
  for (const PassTime& pass : stats->passes)
    if (pass.name != "shadow_maps") ms += renderer_->capabilities().software ? pass.cpuMs : pass.gpuMs;
  return ms;
}

Result<Spread> Studio::ratio(const Scene& scene, int rounds, const std::function<bool()>& goOn) {
  // Uploads and compilers first.
  for (int i = 0; i < 2; ++i)
    for (const Scene* warm : {&bench_.scene(), &scene})
      if (auto drawn = frame(*warm); !drawn) return fail(drawn.error());
  std::vector<double> ratios;
  auto before = frame(bench_.scene());
  for (int i = 0; i < rounds && before && (i == 0 || goOn()); ++i) {
    auto own = frame(scene);
    if (!own) return fail(own.error());
    auto after = frame(bench_.scene());
    if (!after) return fail(after.error());
    ratios.push_back(*own / std::max(0.5 * (*before + *after), 1e-9));
    before = after;
  }
  if (!before) return fail(before.error());
  return spreadOf(std::move(ratios));
}

}  // namespace burnish::cost
