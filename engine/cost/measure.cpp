// measureCost: the terms that count here, each rung's picture, errors and times, and what follows from them for whole qualities. The order of the work is that of its worth, for the time may be short.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "cost/choices.h"
#include "cost/front.h"
#include "cost/ladder.h"

namespace burnish {
namespace {

using namespace cost;

// Shares of the time after which the work goes on to the next part.
constexpr double kTermsUntil = 0.66, kBesideExactUntil = 0.86, kChoicesUntil = 0.98;
constexpr int kLeastRounds = 3, kLeastTermRounds = 5;  // compiling a rung takes longer than five rounds of it, and of three the spread says little

std::string cpuName() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(std::min(line.size(), line.find(':') + 2));
  return {};
}

class Run {
 public:
  Run(const ProcAddress& getProcAddress, Bench& bench, const CostOptions& options, CostReport& out) : getProcAddress_(getProcAddress), bench_(bench), options_(options), report_(out), clock_(options.minutes, options.progress) {}

  Result<void> all() {
    for (auto step : {&Run::begin, &Run::presets, &Run::terms, &Run::besideExact, &Run::choices, &Run::end})
      if (auto done = (this->*step)(); !done) return done;
    return {};
  }

 private:
  Result<void> tell(double share, std::string_view what) { return clock_.tell(share, what) ? Result<void>{} : fail("cost", "was stopped", "run it again"); }
  [[nodiscard]] std::size_t slots(std::size_t from) const {
    std::size_t sum = 0;
    for (std::size_t i = from; i < ladders_.size(); ++i) sum += ladders_[i].qualities.size();
    return sum;
  }

  Result<void> begin();
  Result<void> presets();
  Result<void> terms();
  Result<void> besideExact();
  Result<void> choices();
  Result<void> end();
  Result<void> addPoint(const Quality& quality, const Spread& ratio);
  [[nodiscard]] int roundsFor(std::size_t ladder) const;

  const ProcAddress& getProcAddress_;
  Bench& bench_;
  const CostOptions& options_;
  CostReport& report_;
  Clock clock_;
  Bench::Truth truth_;
  Against against_;
  Quality exact_;
  std::vector<Ladder> ladders_;
  std::vector<TermCost> choices_;
  std::vector<std::pair<FrontPoint, Spread>> points_;  ///< with the ratio to the base's frame
  double frameSeconds_ = 0, pictureSeconds_ = 0;       ///< wall time of a base frame; of a rung's picture with what it is held against
};

Result<void> Run::begin() {
  if (auto told = tell(0, "the base picture"); !told) return told;
  const auto base = bench_.picture(bench_.base());
  if (!base) return fail(base.error());
  report_.basePicture = bench_.developed(**base);
  exact_ = exactOf(bench_.base());
  const double before = clock_.seconds();
  const auto exact = bench_.picture(exact_);
  if (!exact) return fail(exact.error());
  report_.exactPicture = bench_.developed(**exact);
  pictureSeconds_ = clock_.seconds() - before;
  if (const ReferencePicture* truth = options_.truth) {
    truth_ = bench_.held(*truth);
    against_ = {&truth_.radiance, &truth_.variance, bench_.developed(truth_.radiance)};
    report_.truthPicture = against_.display;
    report_.baseDifference = differenceOf(**base, truth_.radiance, bench_.white());
    report_.exactDifference = differenceOf(**exact, truth_.radiance, bench_.white());
    report_.referenceSamples = truth->samples;
    report_.referenceNoise = truth->error;
  } else {
    against_ = {*exact, nullptr, report_.exactPicture};
  }
  report_.against = against_.truth() ? "ground truth" : "exact";
  report_.differenceScale = 1;  // the exposure's white
  return {};
}

Result<void> Run::addPoint(const Quality& quality, const Spread& ratio) {
  const auto picture = bench_.picture(quality);
  if (!picture) return fail(picture.error());
  FrontPoint point;
  point.quality = quality;
  point.settings = settingsOf(quality, bench_.base());
  point.error = against_(**picture, bench_.developed(**picture));
  points_.emplace_back(std::move(point), ratio);
  return {};
}

// The base first, the preset `exact` next, then the other presets.
Result<void> Run::presets() {
  if (auto told = tell(0.02, "the presets"); !told) return told;
  std::vector<Quality> qualities{bench_.base(), exact_};
  for (const std::string_view name : presetNames()) {
    Quality preset = bench_.base();
    (void)setPreset(preset, name);
    if (std::find(qualities.begin(), qualities.end(), preset) == qualities.end()) qualities.push_back(preset);
  }
  if (const auto pictures = bench_.pictures(qualities); !pictures) return fail(pictures.error());  // and their programs with them
  const auto goOn = [this] { return !clock_.stopped(); };
  double before = clock_.seconds();
  if (auto warm = bench_.time({&qualities[0], 1}, kLeastRounds, {}, goOn); !warm) return fail(warm.error());
  frameSeconds_ = (clock_.seconds() - before) / (2 + 2 * kLeastRounds + 1);  // two to warm up, each round's pair, the last of the base's
  const auto timings = bench_.time(qualities, kLeastRounds, {}, goOn);
  if (!timings) return fail(timings.error());
  for (std::size_t i = 0; i < qualities.size(); ++i)
    if (auto added = addPoint(qualities[i], (*timings)[i].ratio); !added) return added;
  return {};
}

/// As many as the time allows if all further ladders get as many; at least kLeastTermRounds, unless fewer are asked for.
int Run::roundsFor(std::size_t ladder) const {
  const double rungs = double(slots(ladder)), each = 2 * frameSeconds_;
  const double rounds = (clock_.left(kTermsUntil) - rungs * (pictureSeconds_ + each)) / std::max(rungs * each, 1e-9);
  const int least = std::min(options_.rounds, kLeastTermRounds);
  return std::clamp(int(std::min(rounds, 1e6)), least, std::max(options_.rounds, least));
}

Result<void> Run::terms() {
  auto found = termsToMeasure(bench_.scene(), bench_.view(), bench_.size(), bench_.base(), [this](const Quality& q) { return bench_.plan(q); }, options_.terms);
  report_.idle = std::move(found.idle);
  for (TermToMeasure& term : found.terms) {
    for (const auto& [rung, why] : term.leftOut) report_.idle.emplace_back(fmt::format("{}={}", burnish::terms()[term.term].name, rung), why);
    ladders_.push_back(ladderOf(bench_, std::move(term)));
  }
  // Each rung costs its programs' compilation: where the time runs short, many terms of few rungs say more than one of many.
  std::stable_sort(ladders_.begin(), ladders_.end(), [](const Ladder& a, const Ladder& b) { return a.qualities.size() < b.qualities.size(); });
  double pictures = 0, seconds = 0, all = 0, rungSeconds = 0;  // rungSeconds: pictures and times of one, on the mean so far
  int fewest = options_.rounds;
  for (std::size_t i = 0; i < ladders_.size(); ++i) {
    Ladder& ladder = ladders_[i];
    if (clock_.left(kBesideExactUntil) <= double(ladder.qualities.size()) * rungSeconds) {
      for (std::size_t k = i; k < ladders_.size(); ++k) report_.idle.emplace_back(ladders_[k].cost.name, "the time was up");
      ladders_.resize(i);
      break;
    }
    if (auto told = tell(0.05 + 0.6 * double(i) / double(ladders_.size()), ladder.cost.name); !told) return told;
    const double before = clock_.seconds();
    if (auto judged = judge(bench_, ladder, against_); !judged) return judged;
    seconds += clock_.seconds() - before, pictures += double(ladder.qualities.size());
    pictureSeconds_ = seconds / pictures;
    const int rounds = roundsFor(i);
    fewest = std::min(fewest, rounds);
    if (auto timed = timeRungs(bench_, ladder, rounds, clock_); !timed) return timed;
    all += clock_.seconds() - before, rungSeconds = all / pictures;
    bench_.forget({&exact_, 1});
  }
  if (fewest < options_.rounds) report_.warnings.push_back(fmt::format("the time allowed {} rounds of the {} asked for in some terms: --minutes gives more", fewest, options_.rounds));
  return {};
}

Result<void> Run::besideExact() {
  double each = pictureSeconds_;
  for (std::size_t i = 0; i < ladders_.size(); ++i) {
    if (auto told = tell(0.65 + 0.2 * double(i) / double(ladders_.size()), ladders_[i].cost.name + " beside the preset exact"); !told) return told;
    const double before = clock_.seconds();
    if (auto judged = judgeBesideExact(bench_, ladders_[i], clock_, options_.choices ? kBesideExactUntil : 1, each); !judged) return judged;
    each = (clock_.seconds() - before) / double(ladders_[i].qualities.size());
    bench_.forget({&exact_, 1});
  }
  return {};
}

Result<void> Run::choices() {
  if (!options_.choices) return {};
  auto measured = measureChoices({getProcAddress_, bench_, against_, options_, clock_, kChoicesUntil});
  if (!measured) return fail(measured.error());
  choices_ = std::move(measured->terms);
  report_.idle.insert(report_.idle.end(), measured->idle.begin(), measured->idle.end());
  points_.insert(points_.end(), measured->points.begin(), measured->points.end());
  bench_.forget({&exact_, 1});
  return {};
}

Result<void> Run::end() {
  const Spread base = bench_.baseFrame();
  const double exactSeconds = frameSeconds_ * points_[1].second.median;
  for (Ladder& ladder : ladders_) {
    // One to warm up, three that count, of each rung.
    if (clock_.left() > 5 * exactSeconds * double(ladder.qualities.size()))
      if (auto timed = timeBesideExact(bench_, ladder, clock_); !timed) return timed;
    finish(ladder, base);
    for (std::size_t r = 0; r < ladder.qualities.size(); ++r) {
      FrontPoint point;
      point.quality = ladder.qualities[r];
      point.settings = settingsOf(point.quality, bench_.base());
      point.error = ladder.whole[r];
      if (ladder.ratios[r].count > 0 && !point.settings.empty()) points_.emplace_back(std::move(point), ladder.ratios[r]);
    }
    report_.terms.push_back(std::move(ladder.cost));
  }
  const auto place = [](const TermCost& cost) { return std::find_if(burnish::terms().begin(), burnish::terms().end(), [&](const Term& t) { return t.name == cost.name; }) - burnish::terms().begin(); };
  std::stable_sort(report_.terms.begin(), report_.terms.end(), [&](const TermCost& a, const TermCost& b) { return place(a) < place(b); });
  for (TermCost& choice : choices_) report_.terms.push_back(std::move(choice));
  for (auto& [point, ratio] : points_) {
    point.ms = times(ratio, base);
    report_.front.push_back(std::move(point));
  }
  report_.base = report_.front[0], report_.exact = report_.front[1];
  report_.base.ms = base;
  report_.front[0].ms = base;
  sortFront(report_.front);
  if (against_.truth()) findContributors(report_, missingLight(bench_.scene(), bench_.plan(exact_)));
  report_.seconds = clock_.seconds();
  return {};
}

Result<void> check(const CostOptions& options) {
  if (options.size.x < 1 || options.size.y < 1) return fail("cost", fmt::format("its pictures are {} x {}", options.size.x, options.size.y), "give at least 1 x 1");
  for (const std::string& name : options.terms) {
    const bool term = std::any_of(terms().begin(), terms().end(), [&](const Term& t) { return t.name == name; });
    const bool choice = std::find(costChoices().begin(), costChoices().end(), name) != costChoices().end();
    if (!term && !choice) return fail("cost", fmt::format("'{}' is no term", name), "burnish render --list-rungs lists them");
  }
  if (options.truth && (options.truth->radiance.width != options.size.x || options.truth->radiance.height != options.size.y))
    return fail("cost", fmt::format("the reference is {} x {} and the pictures {} x {}", options.truth->radiance.width, options.truth->radiance.height, options.size.x, options.size.y), "trace one of this size");
  return {};
}

}  // namespace

Result<CostReport> measureCost(const ProcAddress& getProcAddress, const Scene& scene, const View& view, const CostOptions& options, Report& report) {
  if (auto good = check(options); !good) return fail(good.error());
  auto bench = Bench::create(getProcAddress, scene, view, options.size, options.base, report);
  if (!bench) return fail(bench.error());
  (*bench)->assist(options.secondContext);
  CostReport out;
  out.size = options.size;
  out.machine = (*bench)->capabilities();
  out.backend = options.backend;
  out.cpu = cpuName();
  out.clock = (*bench)->clock();
  if (auto run = Run(getProcAddress, **bench, options, out).all(); !run) return fail(run.error());
  return out;
}

}  // namespace burnish
