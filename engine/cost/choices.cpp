#include "cost/choices.h"

#include <fmt/format.h>

#include <algorithm>

#include "cost/choices_rows.h"
#include "cost/choices_scenes.h"
#include "cost/front.h"

namespace burnish::cost {
namespace {

constexpr std::string_view kNames[] = {"normal-storage", "light-buffer", "resolution-scale", "shadow-resolution", "shadow-cascades", "prefilter", "probes"};
constexpr int kLeastRounds = 3;

/// Errors, developed pictures and differences of a choice's pictures.
void judge(const Bench& bench, const Against& against, TermCost& cost, std::span<const Image* const> pictures, std::size_t exact, std::vector<PictureError>& whole) {
  cost.exactPicture = bench.developed(*pictures[exact]);
  cost.exactRung = cost.rungs[exact].name;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    RungCost& rung = cost.rungs[i];
    rung.picture = bench.developed(*pictures[i]);
    rung.exact = errorOf({*pictures[i], rung.picture}, {*pictures[exact], cost.exactPicture});
    rung.difference = differenceOf(*pictures[i], *pictures[exact], bench.white());
    whole.push_back(against(*pictures[i], rung.picture));
    if (against.truth()) rung.truth = whole.back();
  }
}

class Run {
 public:
  explicit Run(const ChoicesRun& run) : r_(run) {}

  Result<Choices> all() {
    std::vector<QualityChoice> rows = choicesOf(r_.bench, r_.options.terms, out_.idle);
    for (const QualityChoice& choice : rows)
      if (auto done = measure(choice); !done) return fail(done.error());
    if (auto done = measureFilter(); !done) return fail(done.error());
    if (auto done = measureProbes(); !done) return fail(done.error());
    return std::move(out_);
  }

 private:
  [[nodiscard]] double left() const { return r_.clock.left(r_.share); }
  [[nodiscard]] bool goOn() const { return !r_.clock.stopped() && left() > 0; }
  Result<void> tell(std::string_view what) {
    return r_.clock.tell(0.85 + 0.12 * double(out_.terms.size() + out_.idle.size()) / double(std::size(kNames) + out_.idle.size()), what) ? Result<void>{} : fail("cost", "was stopped", "run it again");
  }
  /// As many as `seconds` allow for so many settings; 0: not even the least.
  [[nodiscard]] int roundsFor(std::size_t settings, double seconds) const {
    const double rounds = std::min(seconds / std::max(2 * frameSeconds_ * double(settings), 1e-9) - 2, 1e6);
    return rounds < kLeastRounds ? 0 : std::min(int(rounds), std::max(r_.options.rounds, kLeastRounds));
  }
  Result<Studio*> studio() {
    if (!studio_) {
      auto made = Studio::create(r_.getProcAddress, r_.bench);
      if (!made) return fail(made.error());
      studio_ = std::move(*made);
    }
    return studio_.get();
  }

  /// Once: what a base frame takes.
  Result<void> timeBase();
  Result<void> measure(const QualityChoice& choice);
  Result<void> timeQualities(const QualityChoice& choice, TermCost& cost, std::vector<Spread>& ratios);
  Result<void> measureFilter();
  Result<void> measureProbes();
  Result<void> measureScenes(SceneChoice choice);

  const ChoicesRun& r_;
  Choices out_;
  std::unique_ptr<Studio> studio_;
  double frameSeconds_ = 0;  ///< wall time of a base frame; 0: not known yet
};

// Two frames of each to warm up, three that count.
Result<void> Run::timeBase() {
  if (frameSeconds_ > 0) return {};
  const double before = r_.clock.seconds();
  const Quality base = r_.bench.base();
  if (auto warm = r_.bench.time({&base, 1}, 1); !warm) return fail(warm.error());
  frameSeconds_ = (r_.clock.seconds() - before) / 7;
  return {};
}

Result<void> Run::timeQualities(const QualityChoice& choice, TermCost& cost, std::vector<Spread>& ratios) {
  std::vector<Quality> qualities;
  for (const Setting& s : choice.settings) qualities.push_back(s.quality);
  std::vector<std::string> passes = choice.passes;
  const FramePlan first = r_.bench.plan(qualities.front());
  for (const Quality& q : qualities)
    for (std::string& name : changedPasses(first, r_.bench.plan(q)))
      if (std::find(passes.begin(), passes.end(), name) == passes.end()) passes.push_back(std::move(name));
  if (auto known = timeBase(); !known) return known;
  const int rounds = roundsFor(qualities.size(), left() / 2);
  ratios.assign(qualities.size(), {});
  if (rounds == 0) return {};
  const auto timings = r_.bench.time(qualities, rounds, passes, [this] { return goOn(); });
  if (!timings) return r_.clock.stopped() ? Result<void>(fail("cost", "was stopped", "run it again")) : fail(timings.error());
  const Spread base = r_.bench.baseFrame();
  for (std::size_t i = 0; i < timings->size(); ++i) {
    ratios[i] = (*timings)[i].ratio;
    cost.rungs[i].frameMs = times(ratios[i], base);
    cost.rungs[i].passMs = times((*timings)[i].passesRatio, base);
  }
  return {};
}

Result<void> Run::measure(const QualityChoice& choice) {
  if (left() <= 0) return out_.idle.emplace_back(choice.name, "the time was up"), Result<void>{};
  if (auto told = tell(choice.name); !told) return told;
  TermCost cost;
  cost.choice = true;
  cost.name = choice.name, cost.what = choice.what, cost.calledBy = choice.calledBy;
  std::vector<Quality> qualities;
  for (const Setting& s : choice.settings) {
    RungCost& rung = cost.rungs.emplace_back();
    rung.name = s.name, rung.note = s.note, rung.inForce = s.inForce;
    qualities.push_back(s.quality);
  }
  const auto pictures = r_.bench.pictures(qualities);
  if (!pictures) return fail(pictures.error());
  std::vector<PictureError> whole;
  judge(r_.bench, r_.against, cost, *pictures, choice.exact, whole);
  std::vector<Spread> ratios;
  if (auto timed = timeQualities(choice, cost, ratios); !timed) return timed;
  for (std::size_t i = 0; i < cost.rungs.size(); ++i)
    if (ratios[i].count == 0) cost.rungs[i].note += "; not timed: the time was up";
  markDominated(cost.rungs, ratios);
  for (std::size_t i = 0; i < choice.settings.size(); ++i) {
    if (choice.settings[i].inForce || ratios[i].count == 0) continue;
    FrontPoint point;
    point.quality = choice.settings[i].quality;
    point.settings = settingsOf(point.quality, r_.bench.base());
    point.error = whole[i];
    out_.points.emplace_back(std::move(point), ratios[i]);
  }
  out_.terms.push_back(std::move(cost));
  return {};
}

Result<void> Run::measureScenes(SceneChoice choice) {
  if (auto known = timeBase(); !known) return known;
  auto made = studio();
  if (!made) return fail(made.error());
  Studio& studio = **made;
  TermCost cost;
  cost.choice = true;
  cost.name = choice.name, cost.what = choice.what, cost.calledBy = choice.calledBy;
  std::vector<Image> pictures;
  std::vector<Spread> ratios;
  Scene scene = r_.bench.scene();
  for (const SceneSetting& s : choice.settings) {
    s.apply(scene);
    RungCost& rung = cost.rungs.emplace_back();
    rung.name = s.name, rung.note = s.note, rung.inForce = s.inForce;
    rung.passMs = {s.onceMs, s.onceMs, s.onceMs, s.onceMs > 0 ? 1 : 0};
    auto picture = studio.picture(scene, r_.bench.base());
    if (!picture) return fail(picture.error());
    pictures.push_back(std::move(*picture));
    const int rounds = roundsFor(choice.settings.size() - ratios.size(), left());
    Spread ratio;
    if (rounds > 0) {
      auto timed = studio.ratio(scene, rounds, [this] { return goOn(); });
      if (!timed) return fail(timed.error());
      ratio = *timed;
    } else {
      rung.note += rung.note.empty() ? "not timed: the time was up" : "; not timed: the time was up";
    }
    ratios.push_back(ratio);
    rung.frameMs = times(ratio, r_.bench.baseFrame());
    if (r_.clock.stopped()) return fail("cost", "was stopped", "run it again");
  }
  studio.release(scene);
  std::vector<const Image*> all;
  for (const Image& p : pictures) all.push_back(&p);
  std::vector<PictureError> whole;
  judge(r_.bench, r_.against, cost, all, choice.exact, whole);
  // Where the time that counts is the one that is taken once. Of a bake and the frames after it neither counts alone.
  std::vector<Spread> once;
  for (const RungCost& rung : cost.rungs) once.push_back(rung.passMs);
  if (std::all_of(once.begin(), once.end(), [](const Spread& s) { return s.count > 0; })) markDominated(cost.rungs, once);
  out_.terms.push_back(std::move(cost));
  return {};
}

Result<void> Run::measureFilter() {
  if (!asked(r_.options.terms, "prefilter")) return {};
  if (left() <= 0) return out_.idle.emplace_back("prefilter", "the time was up"), Result<void>{};
  if (auto told = tell("prefilter"); !told) return told;
  std::string idle;
  auto choice = filterChoice(r_.bench, idle);
  if (!choice) return fail(choice.error());
  if (choice->settings.empty()) return out_.idle.emplace_back("prefilter", idle), Result<void>{};
  return measureScenes(std::move(*choice));
}

Result<void> Run::measureProbes() {
  if (!asked(r_.options.terms, "probes")) return {};
  if (auto told = tell("probes"); !told) return told;
  std::string idle;
  auto choice = probeChoice(r_.getProcAddress, r_.bench, [this] { return left(); }, idle);
  if (!choice) return fail(choice.error());
  if (choice->settings.empty()) return out_.idle.emplace_back("probes", idle), Result<void>{};
  return measureScenes(std::move(*choice));
}

}  // namespace

// Warnings of bakes and pictures are of small, temporary things: the report has nothing of them.
Result<Choices> measureChoices(const ChoicesRun& run) { return Run(run).all(); }

}  // namespace burnish::cost

namespace burnish {
std::span<const std::string_view> costChoices() { return cost::kNames; }
}  // namespace burnish
