// The search for budgets without OpenGL: pictures and times are made up, so that the best choice is known by trying all.
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "cost/spender.h"

using namespace burnish;
using namespace burnish::cost;

namespace {

constexpr int kWidth = 24, kHeight = 16;

/// Five terms with some levels each.
Factors someFactors() {
  const Quality base;
  std::vector<Factor> factors;
  for (const std::size_t term : {std::size_t(0), std::size_t(2), std::size_t(5), std::size_t(6), std::size_t(18)}) {
    Factor f;
    f.name = terms()[term].name;
    for (std::size_t r = 0; r < std::min<std::size_t>(terms()[term].rungs.size(), 5); ++r) f.levels.push_back({{{term, r}}, 0, 0});
    factors.push_back(std::move(f));
  }
  return {base, std::move(factors)};
}

/// A renderer in which light adds, but for pairs of settings that meddle with each other, and so do times.
class Made {
 public:
  Made(const Factors& factors, unsigned seed, double interaction) : factors_(factors), interaction_(interaction) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<double> even(0, 1);
    for (const Factor& f : factors.all()) {
      const float strength = float(0.05 + 0.4 * even(random));
      std::vector<std::vector<float>> pictures;
      std::vector<double> times;
      for (std::size_t l = 0; l < f.levels.size(); ++l) {
        // Cheap to exact: what is missed falls, the time rises, neither quite evenly.
        const double rest = double(f.levels.size() - 1 - l) / double(f.levels.size() - 1);
        std::vector<float> picture(kWidth * kHeight * 3);
        for (float& v : picture) v = strength * float(rest) * (0.4f + normal(random));
        pictures.push_back(std::move(picture));
        times.push_back((1 - rest) * (0.05 + 0.3 * even(random)));
      }
      pictures_.push_back(std::move(pictures));
      times_.push_back(std::move(times));
    }
  }
  [[nodiscard]] Image picture(const Choice& c) const {
    Image image = makeImage(kWidth, kHeight, 3, PixelType::F32);
    for (std::size_t i = 0; i < kWidth * kHeight * 3; ++i) {
      float sum = 1;
      for (std::size_t f = 0; f < c.size(); ++f) sum += pictures_[f][c[f]][i];
      for (std::size_t f = 1; f < c.size(); ++f) sum += float(interaction_) * pictures_[f][c[f]][i] * pictures_[f - 1][c[f - 1]][i] * 10;
      image.f32()[i] = sum;
    }
    return image;
  }
  [[nodiscard]] double time(const Choice& c) const {
    double sum = 0.3;
    for (std::size_t f = 0; f < c.size(); ++f) sum += times_[f][c[f]] * (f + 1 < c.size() ? 1 + interaction_ * (c[f + 1] % 2 ? 1 : -1) : 1);
    return sum;
  }
  [[nodiscard]] double ratio(const Choice& c) const { return time(c) / time(factors_.base()); }
  [[nodiscard]] Image exact() const {
    Image image = makeImage(kWidth, kHeight, 3, PixelType::F32);
    for (std::size_t i = 0; i < kWidth * kHeight * 3; ++i) image.f32()[i] = 1;
    return image;
  }

 private:
  const Factors& factors_;
  double interaction_;
  std::vector<std::vector<std::vector<float>>> pictures_;
  std::vector<std::vector<double>> times_;
};

template <class F>
void each(const Factors& factors, F&& f) {
  Choice c(factors.all().size(), 0);
  for (;;) {
    f(c);
    std::size_t i = 0;
    while (i < c.size() && ++c[i] == factors.all()[i].levels.size()) c[i++] = 0;
    if (i == c.size()) return;
  }
}

CostReport reportOf(double ms) {
  CostReport report;
  report.base.ms = {ms, ms, ms, 9};
  return report;
}

/// Pictures of what is made up, as an instrument gives them; both must outlive it.
auto pictures(const Made& made, const Against& against) {
  return [&made, &against](const Choice& c) -> Result<std::pair<Image, PictureError>> {
    Image picture = made.picture(c);
    const PictureError error = against(picture, {});
    return std::pair(std::move(picture), error);
  };
}

}  // namespace

TEST_CASE("An inverse times its matrix is one", "[cost][budget]") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (const std::size_t n : {std::size_t(1), std::size_t(2), std::size_t(17), std::size_t(60)}) {
    std::vector<double> a(n * n), m(n * n, 0);
    for (double& v : a) v = normal(random);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t k = 0; k < n; ++k) m[i * n + j] += a[i * n + k] * a[j * n + k] + (i == j ? 0.05 : 0);
    std::vector<double> inverse = m;
    invert(inverse, n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        double sum = 0;
        for (std::size_t k = 0; k < n; ++k) sum += m[i * n + k] * inverse[k * n + j];
        REQUIRE(std::abs(sum - (i == j ? 1 : 0)) < 1e-8);
      }
  }
  std::vector<double> singular(9, 1);  // two of one choice: the diagonal gives way, nothing is lost but digits
  invert(singular, 3);
  for (const double v : singular) CHECK(std::isfinite(v));
}

TEST_CASE("The model knows what it was told, and that light adds", "[cost][budget]") {
  const Factors factors = someFactors();
  const Made made(factors, 3, 0);
  const Image exact = made.exact();
  const Against against{&exact, nullptr, {}};
  Samples samples(against);
  const auto add = [&](const Choice& c) {
    const Image picture = made.picture(c);
    samples.picture(c, picture, against(picture, {}));
    samples.time(c, {made.ratio(c), made.ratio(c), made.ratio(c), 3});
  };
  add(factors.base());
  for (std::size_t f = 0; f < factors.all().size(); ++f)
    for (std::size_t l = 0; l < factors.all()[f].levels.size(); ++l) {
      Choice c = factors.base();
      c[f] = std::uint16_t(l);
      if (l != factors.base()[f]) add(c);
    }
  for (std::size_t i = 0; i < samples.all().size(); ++i) CHECK(std::sqrt(samples.product(i, i)) == Approx(samples.all()[i].error.rms).epsilon(1e-4));
  const Model model(factors, samples, 1e9);
  for (const Sample& s : samples.all()) {
    const Predicted p = model.at(s.choice);
    CHECK(p.error == Approx(s.error.rms).margin(2e-3));
    CHECK(p.ratio == Approx(s.ratio.median).margin(5e-3));
    CHECK(p.sure - p.error < 0.01);
  }
  // All combinations from single settings alone. A setting's effect beside the base goes for the same beside others, but for the share that the covariance leaves to pairs: the sum of the other
  // factors' weights. So the picture is off by no more than that share of each effect, and the error by no more than the picture (the triangle inequality).
  const double own = samples.product(0, 0);
  double worst = 0, worstSums = 0;
  each(factors, [&](const Choice& c) {
    const double truth = against(made.picture(c), {}).rms;
    const Predicted p = model.at(c);
    double effects = 0, timeEffects = 0, sums = own;
    for (std::size_t f = 0; f < c.size(); ++f) {
      Choice single = factors.base();
      single[f] = c[f];
      const std::size_t i = std::size_t(samples.find(single) - samples.all().data());
      effects += std::sqrt(std::max(samples.product(i, i) + own - 2 * samples.product(i, 0), 0.0));
      timeEffects += std::abs(made.ratio(single) - 1);
      sums += samples.product(i, i) - own;
    }
    worst = std::max(worst, std::abs(p.error - truth));
    worstSums = std::max(worstSums, std::abs(std::sqrt(std::max(sums, 0.0)) - truth));
    REQUIRE(std::abs(p.error - truth) <= Covariance::kWeights * effects + 1e-3);
    REQUIRE(std::abs(p.ratio - made.ratio(c)) <= Covariance::kWeights * timeEffects + 5e-3);
  });
  INFO("worst " << worst << ", of a model that adds squared errors " << worstSums);
  CHECK(worst < 0.5 * worstSums);
}

TEST_CASE("The search finds the best of all choices from a few", "[cost][budget]") {
  const Factors factors = someFactors();
  std::size_t all = 0;
  each(factors, [&](const Choice&) { ++all; });
  // Settings that meddle with each other up to as much as they do by themselves; a third of that the other way round, where the constraint itself is what the model can be wrong about.
  for (unsigned run = 0; run < 12; ++run) {
    const unsigned seed = 1 + run / 2;
    const bool byError = run % 2 == 1;
    const Made made(factors, seed, byError ? 0.08 : 0.25);
    const Image exact = made.exact();
    const Against against{&exact, nullptr, {}};
    Clock clock(0, {});
    std::mt19937 noise(seed);
    std::normal_distribution<double> normal(1, 0.004);
    Instrument instrument;
    instrument.picture = pictures(made, against);
    instrument.time = [&](const std::vector<Choice>& choices, int rounds) -> Result<std::vector<Spread>> {
      std::vector<Spread> out;
      for (const Choice& c : choices) {
        std::vector<double> values;
        for (int i = 0; i < rounds; ++i) values.push_back(made.ratio(c) * normal(noise));
        out.push_back(spreadOf(values));
      }
      return out;
    };
    for (const double budget : byError ? std::vector<double>{} : std::vector<double>{0.5, 0.75, 1.0}) {
      Spender spender(instrument, factors, against, clock);
      const std::vector<Goal> goals{{budget, 0}};
      REQUIRE(spender.begin(reportOf(10), goals, 1));
      REQUIRE(spender.search(goals[0], 1));
      REQUIRE(spender.verify(instrument, goals));
      const Sample* best = spender.best(goals[0]);
      REQUIRE(best);
      double least = 1e9, cheapest = 1e9;
      each(factors, [&](const Choice& c) {
        cheapest = std::min(cheapest, made.ratio(c));
        if (made.ratio(c) <= budget * 0.985) least = std::min(least, against(made.picture(c), {}).rms);  // what fits with a spread that eleven rounds of such noise have
      });
      INFO("seed " << seed << ", budget " << budget << ": " << best->error.rms << " against " << least << " of " << all << ", " << spender.measured() << " measured; cheapest " << cheapest);
      if (cheapest > budget) {
        CHECK_FALSE(spender.fits(goals[0], *best));
        continue;
      }
      CHECK(spender.fits(goals[0], *best));
      CHECK(made.ratio(best->choice) <= budget * 1.005);
      CHECK(best->error.rms <= least * 1.01 + 1e-6);
      CHECK(spender.measured() < int(all / 10));
      if (const Sample* next = spender.next(*best)) {
        CHECK(next->error.rms < best->error.rms);
        CHECK(next->ratio.median > best->ratio.median);
      }
    }
    if (!byError) continue;
    // The other way round: the fastest whose error is small enough.
    double largest = 0;
    each(factors, [&](const Choice& c) { largest = std::max(largest, against(made.picture(c), {}).rms); });
    const Goal goal{0, 0.3 * largest};
    Spender spender(instrument, factors, against, clock);
    REQUIRE(spender.begin(reportOf(10), {goal}, 1));
    REQUIRE(spender.search(goal, 1));
    double fastest = 1e9;
    each(factors, [&](const Choice& c) {
      if (against(made.picture(c), {}).rms <= goal.error) fastest = std::min(fastest, made.ratio(c));
    });
    INFO("seed " << seed << ": fastest " << fastest << ", found " << spender.best(goal)->ratio.median);
    CHECK(spender.fits(goal, *spender.best(goal)));
    CHECK(made.ratio(spender.best(goal)->choice) <= fastest * 1.03);
  }
}

TEST_CASE("What fitted by chance alone is refused when it is timed again", "[cost][budget]") {
  const Factors factors = someFactors();
  const Made made(factors, 2, 0);
  const Image exact = made.exact();
  const Against against{&exact, nullptr, {}};
  Clock clock(0, {});
  Instrument lucky, fresh;
  lucky.picture = pictures(made, against);
  // One in three is timed 4 % too fast the first time.
  lucky.time = [&](const std::vector<Choice>& choices, int) -> Result<std::vector<Spread>> {
    std::vector<Spread> out;
    for (const Choice& c : choices) {
      const double r = made.ratio(c) * ((c[0] + c[1] + c[2]) % 3 == 0 ? 0.96 : 1);
      out.push_back({r, r * 0.99, r * 1.01, 3});
    }
    return out;
  };
  fresh.time = [&](const std::vector<Choice>& choices, int) -> Result<std::vector<Spread>> {
    std::vector<Spread> out;
    for (const Choice& c : choices) out.push_back({made.ratio(c), made.ratio(c) * 0.998, made.ratio(c) * 1.002, 11});
    return out;
  };
  for (const double budget : {0.55, 0.7, 0.85}) {
    Spender spender(lucky, factors, against, clock);
    const std::vector<Goal> goals{{budget, 0}};
    REQUIRE(spender.begin(reportOf(10), goals, 1));
    REQUIRE(spender.search(goals[0], 1));
    REQUIRE(spender.verify(fresh, goals));
    const Sample& best = *spender.best(goals[0]);
    INFO("budget " << budget << ", " << made.ratio(best.choice));
    CHECK(spender.fits(goals[0], best));
    CHECK(made.ratio(best.choice) * 1.002 <= budget);
  }
}

TEST_CASE("What failed to fit by chance alone is heard again", "[cost][budget]") {
  const Factors factors = someFactors();
  const Made made(factors, 2, 0);
  const Image exact = made.exact();
  const Against against{&exact, nullptr, {}};
  Clock clock(0, {});
  Instrument slow, fresh;
  slow.picture = pictures(made, against);
  slow.time = [&](const std::vector<Choice>& choices, int) -> Result<std::vector<Spread>> {
    std::vector<Spread> out;
    for (const Choice& c : choices) out.push_back({made.ratio(c), made.ratio(c) * 0.99, made.ratio(c) * 1.01, 3});
    return out;
  };
  for (const double budget : {0.55, 0.7, 0.85}) {
    // The first time that a choice is timed again its spread reaches over the budget.
    std::map<Choice, int> heard;
    fresh.time = [&](const std::vector<Choice>& choices, int) -> Result<std::vector<Spread>> {
      std::vector<Spread> out;
      for (const Choice& c : choices) {
        const double share = heard[c]++ == 0 ? 0.5 : 0.002;
        out.push_back({made.ratio(c), made.ratio(c) * (1 - share), made.ratio(c) * (1 + share), 11});
      }
      return out;
    };
    Spender spender(slow, factors, against, clock);
    const std::vector<Goal> goals{{budget, 0}};
    REQUIRE(spender.begin(reportOf(10), goals, 1));
    REQUIRE(spender.search(goals[0], 1));
    REQUIRE(spender.verify(fresh, goals));
    const Sample& best = *spender.best(goals[0]);
    double least = 1e9;
    each(factors, [&](const Choice& c) {
      if (made.ratio(c) * 1.002 <= budget) least = std::min(least, against(made.picture(c), {}).rms);
    });
    INFO("budget " << budget << ", " << made.ratio(best.choice) << ", error " << best.error.rms << " of " << least);
    CHECK(spender.fits(goals[0], best));
    CHECK(best.error.rms <= 1.01 * least);
  }
}

TEST_CASE("Nothing fits by its median alone", "[cost][budget]") {
  const Factors factors = someFactors();
  const Made made(factors, 2, 0);
  const Image exact = made.exact();
  const Against against{&exact, nullptr, {}};
  Clock clock(0, {});
  Instrument vague;
  vague.picture = pictures(made, against);
  vague.time = [&](const std::vector<Choice>& choices, int) -> Result<std::vector<Spread>> {
    std::vector<Spread> out;
    for (const Choice& c : choices) out.push_back({made.ratio(c), 0, made.ratio(c) + 1, 3});
    return out;
  };
  const std::vector<Goal> goals{{0.99, 0}};
  Spender spender(vague, factors, against, clock);
  REQUIRE(spender.begin(reportOf(10), goals, 1));
  REQUIRE(spender.search(goals[0], 1));
  REQUIRE(spender.verify(vague, goals));
  CHECK_FALSE(spender.fits(goals[0], *spender.best(goals[0])));
}

TEST_CASE("A stopped search says so", "[cost][budget]") {
  const Factors factors = someFactors();
  const Made made(factors, 2, 0);
  const Image exact = made.exact();
  const Against against{&exact, nullptr, {}};
  int told = 0;
  Clock clock(0, [&](double, std::string_view) { return ++told < 5; });
  Instrument instrument;
  instrument.picture = [&](const Choice& c) -> Result<std::pair<Image, PictureError>> { return std::pair(made.picture(c), PictureError{}); };
  instrument.time = [&](const std::vector<Choice>& choices, int) -> Result<std::vector<Spread>> { return std::vector<Spread>(choices.size(), Spread{1, 1, 1, 3}); };
  Spender spender(instrument, factors, against, clock);
  const auto done = spender.begin(reportOf(10), {{0.5, 0}}, 1);
  REQUIRE_FALSE(done);
  CHECK(done.error().what == "was stopped");
}
