#include "cost/bench.h"

#include <algorithm>
#include <cmath>

#include "cost/bench_impl.h"
#include "reference/shading.h"

namespace burnish::cost {
namespace {

glm::vec3 toneMapped(ToneMap curve, glm::vec3 c) {
  switch (curve) {
    case ToneMap::Neutral: return shading::f32::tonemapNeutral(c);
    case ToneMap::AgX: return shading::f32::tonemapAgx(c);
    case ToneMap::Aces: return shading::f32::tonemapAces(c);
    default: return shading::f32::tonemapNone(c);
  }
}

}  // namespace

Bench::Bench() = default;
Bench::~Bench() = default;

Result<std::unique_ptr<Bench>> Bench::create(const ProcAddress& getProcAddress, const Scene& scene, const View& view, glm::ivec2 size, const Quality& base, Report& report) {
  std::unique_ptr<Bench> bench(new Bench);
  bench->impl_ = std::make_unique<Impl>(scene, view, size, base, report);
  Impl& b = *bench->impl_;
  auto renderer = Renderer::create(getProcAddress, {.linkOnDemand = true});
  if (!renderer) return fail(renderer.error());
  b.renderer = std::move(*renderer);
  b.finish = reinterpret_cast<void (*)()>(getProcAddress("glFinish"));
  for (const auto& [target, output] : {std::pair(&b.display, Output::Display), std::pair(&b.linear, Output::Linear)}) {
    auto made = OffscreenTarget::create(getProcAddress, size, output);
    if (!made) return fail(made.error());
    *target = std::move(*made);
  }
  if (base.exposureEv) {
    b.exposureEv = *base.exposureEv;
  } else {
    RenderRequest request;
    request.countNonfinite = true;
    const auto stats = b.renderer->render(scene, {&view, 1}, b.display->target(), base, request);
    if (!stats) return fail(stats.error());
    b.exposureEv = stats->exposureEv;
  }
  if (auto picture = bench->picture(base); !picture) return fail(picture.error());
  for (const Warning& w : b.renderer->report().warnings()) report.warn(w.place, w.what);
  return bench;
}

const Capabilities& Bench::capabilities() const { return impl_->renderer->capabilities(); }
const char* Bench::clock() const { return capabilities().software ? "CPU time" : "GPU time"; }
const Scene& Bench::scene() const { return impl_->scene; }
const View& Bench::view() const { return impl_->view; }
glm::ivec2 Bench::size() const { return impl_->size; }
const Quality& Bench::base() const { return impl_->base; }
float Bench::exposureEv() const { return impl_->exposureEv; }
double Bench::white() const { return 1.2 * std::exp2(double(impl_->exposureEv)); }  // Lagarde and de Rousiers 2014, section 5.1, as the renderer has it

FramePlan Bench::plan(const Quality& quality) const {
  PlanOptions options;
  options.size = impl_->size;
  return makePlan(impl_->scene, {&impl_->view, 1}, quality, capabilities(), options);
}

void Bench::hold(Image& linear) const {
  const float most = float(kShown * white());
  for (std::size_t i = 0; i < linear.pixelCount() * std::size_t(linear.channels); ++i)
    if (linear.f32()[i] > most) linear.f32()[i] = most;  // infinite ones too; what is no number stays
}

Bench::Truth Bench::held(const ReferencePicture& truth) const {
  Truth held{truth.radiance, truth.variance};
  hold(held.radiance);
  const float most = float(kShown * white());
  for (std::size_t i = 0; i < held.variance.pixelCount() * std::size_t(held.variance.channels); ++i)
    if (held.radiance.f32()[i] >= most) held.variance.f32()[i] = 0;
  return held;
}

Image Bench::developed(const Image& linear) const {
  Image display = makeImage(linear.width, linear.height, 3, PixelType::U8);
  const float exposure = float(1 / white());
  for (std::size_t i = 0; i < linear.pixelCount(); ++i) {
    const float* p = linear.f32() + std::size_t(linear.channels) * i;
    glm::vec3 c(p[0], p[1], p[2]);
    for (int k = 0; k < 3; ++k) c[k] = std::isfinite(c[k]) ? std::min(c[k], 65504.0f * float(white())) : 0;  // what the light buffer holds
    c = toneMapped(impl_->base.toneMap, c * exposure);
    for (int k = 0; k < 3; ++k) display.u8()[3 * i + std::size_t(k)] = std::uint8_t(std::lround(255 * std::clamp(shading::f32::srgbFromLinear(c[k]), 0.0f, 1.0f)));
  }
  return display;
}

}  // namespace burnish::cost
