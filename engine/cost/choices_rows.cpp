#include "cost/choices_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace burnish::cost {
namespace {

/// Passes that look shadows up, and the one that draws their maps.
constexpr const char* kShadowed[] = {"shadow_maps", "lighting", "forward", "transparent"};
/// Shadow maps larger than this are left out.
constexpr std::uint64_t kMostBytes = 512ull << 20;

const EffectPlan& effectOf(const FramePlan& plan, std::string_view name) {
  static const EffectPlan kNone;
  const auto found = std::find_if(plan.effects.begin(), plan.effects.end(), [&](const EffectPlan& e) { return e.name == name; });
  return found == plan.effects.end() ? kNone : *found;
}
std::string callerOf(const FramePlan& plan, std::string_view effect) { return fmt::format("{}: {}", effect, effectOf(plan, effect).reason); }

std::string megabytes(std::uint64_t bytes) { return fmt::format("{:.1f} MB", double(bytes) / 1e6); }

class Rows {
 public:
  Rows(const Bench& bench, std::vector<std::pair<std::string, std::string>>& idle) : bench_(bench), base_(bench.base()), plan_(bench.plan(bench.base())), idle_(idle) {}

  void normalStorage();
  void lightBuffer();
  void shadowResolution();
  void shadowCascades();
  void resolutionScale();
  std::vector<QualityChoice> take() { return std::move(choices_); }

 private:
  QualityChoice& add(std::string_view name, std::string what, std::string calledBy) {
    QualityChoice& c = choices_.emplace_back();
    c.name = name, c.what = std::move(what), c.calledBy = std::move(calledBy);
    return c;
  }
  void setting(QualityChoice& choice, std::string name, const Quality& quality, std::string note = {}) const { choice.settings.push_back({std::move(name), std::move(note), quality, quality == base_}); }
  void idle(std::string_view name, std::string why) { idle_.emplace_back(name, std::move(why)); }

  const Bench& bench_;
  const Quality base_;
  const FramePlan plan_;
  std::vector<std::pair<std::string, std::string>>& idle_;
  std::vector<QualityChoice> choices_;
};

// The forward path quantises nothing; but occlusion that is found on the screen is none of its own: beside that, the widest format counts as exact.
void Rows::normalStorage() {
  if (!plan_.pass("gbuffer")) return idle("normal-storage", "nothing in view is in the G-buffer");
  QualityChoice& c = add("normal-storage", "how the G-buffer holds normals, and no G-buffer at all", callerOf(plan_, "geometry"));
  for (const NormalStorage storage : {NormalStorage::Oct8, NormalStorage::Oct12, NormalStorage::Oct16}) {
    Quality q = base_;
    q.normalStorage = storage;
    setting(c, std::array{"oct-8", "oct-12", "oct-16"}[std::size_t(storage)], q, fmt::format("{} bytes a pixel beside depth", bench_.plan(q).gbufferBytesPerPixel));
  }
  if (base_.occlusion <= Occlusion::Baked) {
    Quality q = base_;
    q.path = Path::Forward;
    setting(c, "forward", q, "no G-buffer: surfaces are shaded where they are drawn, with every light");
  }
  c.exact = c.settings.size() - 1;
}

void Rows::lightBuffer() {
  if (!plan_.target("light")) return idle("light-buffer", "lighting develops in place here: the frame has no light buffer");
  QualityChoice& c = add("light-buffer", "the format that radiance is gathered in, as a picture for a display has it", callerOf(plan_, "tone_mapping"));
  for (const LightBuffer buffer : {LightBuffer::R11G11B10, LightBuffer::Rgba16F, LightBuffer::Rgba32F}) {
    Quality q = base_;
    q.lightBuffer = buffer;
    const FramePlan plan = bench_.plan(q);
    setting(c, std::array{"r11g11b10", "rgba16f", "rgba32f"}[std::size_t(buffer)], q, plan.target("light") ? megabytes(plan.target("light")->bytes) : std::string());
  }
  c.exact = c.settings.size() - 1;
}

void Rows::shadowResolution() {
  if (!plan_.target("shadow_maps")) return idle("shadow-resolution", effectOf(plan_, "shadows").reason);
  QualityChoice& c = add("shadow-resolution", "texels along a side of a shadow map; maps that stay right from frame to frame are not drawn again", callerOf(plan_, "shadows"));
  std::vector<int> sizes{256, 512, 1024, 2048, 4096};
  if (std::find(sizes.begin(), sizes.end(), base_.shadowResolution) == sizes.end()) sizes.push_back(base_.shadowResolution);
  std::sort(sizes.begin(), sizes.end());
  for (const int size : sizes) {
    Quality q = base_;
    q.shadowResolution = size;
    const FramePlan plan = bench_.plan(q);
    const TargetPlan* maps = plan.target("shadow_maps");
    if (maps && maps->bytes > kMostBytes && q != base_) {
      idle(fmt::format("shadow-resolution={}", size), fmt::format("its {} maps take {}", maps->layers, megabytes(maps->bytes)));
      continue;
    }
    setting(c, std::to_string(size), q, maps ? fmt::format("{} maps, {}", maps->layers, megabytes(maps->bytes)) : std::string());
  }
  c.passes.assign(std::begin(kShadowed), std::end(kShadowed));
  c.exact = c.settings.size() - 1;
}

void Rows::shadowCascades() {
  const auto layers = [this](int cascades) {
    Quality q = base_;
    q.shadowCascades = cascades;
    const FramePlan plan = bench_.plan(q);
    return plan.target("shadow_maps") ? plan.target("shadow_maps")->layers : 0;
  };
  if (layers(1) == layers(4)) return idle("shadow-cascades", "no directional light in view casts shadows");
  QualityChoice& c = add("shadow-cascades", "maps of a directional light, each for a range of distances from the eye", callerOf(plan_, "shadows"));
  for (int cascades = 1; cascades <= 4; ++cascades) {
    Quality q = base_;
    q.shadowCascades = cascades;
    setting(c, std::to_string(cascades), q, fmt::format("{} maps in all", layers(cascades)));
  }
  c.passes.assign(std::begin(kShadowed), std::end(kShadowed));
  c.exact = c.settings.size() - 1;
}

void Rows::resolutionScale() {
  QualityChoice& c = add("resolution-scale", "pixels shaded along a side, over those of the picture", plan_.on("geometry") ? callerOf(plan_, "geometry") : callerOf(plan_, "background"));
  std::vector<float> scales{0.5f, 0.67f, 0.75f, 1};
  if (std::find(scales.begin(), scales.end(), base_.resolutionScale) == scales.end()) scales.push_back(base_.resolutionScale);
  std::sort(scales.begin(), scales.end());
  for (const float scale : scales) {
    Quality q = base_;
    q.resolutionScale = scale;
    const FramePlan plan = bench_.plan(q);
    if (scale < 1 && !plan.on("upscaling")) continue;
    setting(c, fmt::format("{:g}", scale), q, effectOf(plan, "upscaling").on ? effectOf(plan, "upscaling").reason : "every pixel");
  }
  c.exact = c.settings.size() - 1;
}

}  // namespace

bool asked(const std::vector<std::string>& only, std::string_view name) { return only.empty() || std::find(only.begin(), only.end(), name) != only.end(); }

std::vector<QualityChoice> choicesOf(const Bench& bench, const std::vector<std::string>& only, std::vector<std::pair<std::string, std::string>>& idle) {
  Rows rows(bench, idle);
  const std::pair<std::string_view, void (Rows::*)()> kMakers[] = {{"normal-storage", &Rows::normalStorage},
                                                                   {"light-buffer", &Rows::lightBuffer},
                                                                   {"resolution-scale", &Rows::resolutionScale},
                                                                   {"shadow-resolution", &Rows::shadowResolution},
                                                                   {"shadow-cascades", &Rows::shadowCascades}};
  for (const auto& [name, make] : kMakers)
    if (asked(only, name)) (rows.*make)();
  return rows.take();
}

}  // namespace burnish::cost
