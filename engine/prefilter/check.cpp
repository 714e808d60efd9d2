// The judge of the filter: level k at R is ∫ L w / ∫ w with w of docs/shading.md, section 5, summed here over every texel of the source, in double, without any of the filter's own means.
#include <burnish/image.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <random>
#include <thread>

namespace burnish {
namespace prefilter {
namespace {

constexpr double kPi = 3.14159265358979323846;
using Vec = std::array<double, 3>;

/// Direction of a texel's centre (OpenGL 4.5 specification, table 8.19).
Vec cubeCentre(int size, std::size_t face, int x, int y) {
  const double u = (2.0 * x + 1) / size - 1, v = (2.0 * y + 1) / size - 1, length = std::sqrt(u * u + v * v + 1);
  const Vec d = face == 0 ? Vec{1, -v, -u} : face == 1 ? Vec{-1, -v, u} : face == 2 ? Vec{u, 1, v} : face == 3 ? Vec{u, -1, -v} : face == 4 ? Vec{u, -v, 1} : Vec{-u, -v, -1};
  return {d[0] / length, d[1] / length, d[2] / length};
}

/// Solid angle of the part of a face between its centre and (u, v): atan(uv / sqrt(u² + v² + 1)).
double cornerAngle(double u, double v) { return std::atan2(u * v, std::sqrt(u * u + v * v + 1)); }

/// The weight of light from l at cos = l·R, up to a factor.
class Lobe {
 public:
  Lobe(ReflectionLobe kind, double roughness) : ggx_(kind == ReflectionLobe::Ggx), alpha2_(std::pow(roughness, 4)), halfPower_(1 / alpha2_ - 1) {}
  [[nodiscard]] double operator()(double cos) const {
    if (cos <= 0) return 0;
    if (ggx_) {
      const double d = (1 - cos) / 2 + (1 + cos) / 2 * alpha2_;  // 1 - (n·h)² (1 - α²)
      return alpha2_ * alpha2_ * cos / (d * d);
    }
    constexpr double kNothing = -150;  // exp of it is 7e-66 of the lobe's peak
    const double x = (cos - 1) / 2;
    if (halfPower_ * x < kNothing) return 0;  // log1p(x) <= x
    return std::exp(halfPower_ * std::log1p(x)) * cos;
  }

 private:
  bool ggx_;
  double alpha2_;
  double halfPower_;  ///< p / 2 = 1 / α² - 1
};

/// Rows of directions with one solid angle each texel; what a cube and a lat-long picture have in common.
class Source {
 public:
  virtual ~Source() = default;
  [[nodiscard]] virtual Vec integrate(const Lobe& lobe, const Vec& r) const = 0;
};

class CubeSource final : public Source {
 public:
  explicit CubeSource(const CubeLevel& level) : level_(level) {
    const auto n = static_cast<std::size_t>(level.size);
    std::vector<double> corner((n + 1) * (n + 1));
    const auto edge = [&](std::size_t i) { return 2.0 * static_cast<double>(i) / static_cast<double>(n) - 1; };
    for (std::size_t y = 0; y <= n; ++y)
      for (std::size_t x = 0; x <= n; ++x) corner[y * (n + 1) + x] = cornerAngle(edge(x), edge(y));
    for (std::size_t y = 0; y < n; ++y)
      for (std::size_t x = 0; x < n; ++x) {
        const std::size_t i = y * (n + 1) + x;
        angle_.push_back(corner[i] - corner[i + 1] - corner[i + n + 1] + corner[i + n + 2]);
      }
  }
  [[nodiscard]] Vec integrate(const Lobe& lobe, const Vec& r) const override {
    Vec sum{};
    double total = 0;
    const auto area = angle_.size();
    for (std::size_t face = 0; face < 6; ++face)
      for (std::size_t i = 0; i < area; ++i) {
        const Vec l = cubeCentre(level_.size, face, static_cast<int>(i) % level_.size, static_cast<int>(i) / level_.size);
        const double w = lobe(l[0] * r[0] + l[1] * r[1] + l[2] * r[2]) * angle_[i];
        if (w == 0) continue;
        const float* texel = level_.texels.data() + (face * area + i) * 3;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(texel[c]) * w;
        total += w;
      }
    return {sum[0] / total, sum[1] / total, sum[2] / total};
  }

 private:
  const CubeLevel& level_;
  std::vector<double> angle_;  ///< of each texel of a face
};

class LatLongSource final : public Source {
 public:
  explicit LatLongSource(const Image& image) : image_(image) {
    for (int x = 0; x < image.width; ++x) {
      const double a = ((x + 0.5) / image.width - 0.5) * 2 * kPi;  // from -Z toward +X
      sin_.push_back(std::sin(a));
      cos_.push_back(std::cos(a));
    }
  }
  [[nodiscard]] Vec integrate(const Lobe& lobe, const Vec& r) const override {
    Vec sum{};
    double total = 0;
    const auto channels = static_cast<std::size_t>(image_.channels), width = static_cast<std::size_t>(image_.width);
    std::vector<double> across(width);  // the horizontal part of l·R at the equator
    for (std::size_t x = 0; x < width; ++x) across[x] = sin_[x] * r[0] - cos_[x] * r[2];
    for (int y = 0; y < image_.height; ++y) {
      const double theta = (y + 0.5) / image_.height * kPi, sinTheta = std::sin(theta), up = std::cos(theta) * r[1];
      const double angle = (std::cos(double(y) / image_.height * kPi) - std::cos((y + 1.0) / image_.height * kPi)) * 2 * kPi / image_.width;
      for (std::size_t x = 0; x < width; ++x) {
        const double w = lobe(sinTheta * across[x] + up) * angle;
        if (w == 0) continue;
        const float* texel = image_.f32() + (static_cast<std::size_t>(y) * width + x) * channels;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += static_cast<double>(texel[c]) * w;
        total += w;
      }
    }
    return {sum[0] / total, sum[1] / total, sum[2] / total};
  }

 private:
  const Image& image_;
  std::vector<double> sin_, cos_;
};

/// One texel of one level to be summed again.
struct Task {
  std::size_t level = 0, texel = 0;
  bool brightest = false;  ///< counts for the worst error only: it is no random one
  std::array<double, 3> error{}, reference{};
};

void addTasks(const CubeLevel& level, std::size_t k, const PrefilterCheckOptions& options, std::mt19937_64& random, std::vector<Task>& tasks) {
  const std::size_t texels = level.texels.size() / 3, wanted = static_cast<std::size_t>(std::max(options.samples, 1));
  for (std::size_t i = 0; i < std::min(wanted, texels); ++i) tasks.push_back({k, wanted >= texels ? i : random() % texels, false, {}, {}});
  const auto brightest = std::max_element(level.texels.begin(), level.texels.end()) - level.texels.begin();
  tasks.push_back({k, static_cast<std::size_t>(brightest) / 3, true, {}, {}});
}

void runTask(Task& task, const Source& source, const Cubemap& cubemap) {
  const CubeLevel& level = cubemap.levels[task.level];
  const auto n = static_cast<std::size_t>(level.size);
  const Vec r = cubeCentre(level.size, task.texel / n / n, static_cast<int>(task.texel % n), static_cast<int>(task.texel / n % n));
  task.reference = source.integrate(Lobe(*cubemap.lobe, level.roughness), r);
  for (std::size_t c = 0; c < 3; ++c) task.error[c] = static_cast<double>(level.texels[task.texel * 3 + c]) - task.reference[c];
}

void runAll(std::vector<Task>& tasks, const Source& source, const Cubemap& cubemap, const PrefilterCheckOptions& options) {
  const std::size_t most = options.threads > 0 ? static_cast<std::size_t>(options.threads) : std::max(std::thread::hardware_concurrency(), 1u);
  std::atomic<std::size_t> next = 0;
  const auto work = [&](bool calling) {
    for (std::size_t i = next++; i < tasks.size(); i = next++) {
      runTask(tasks[i], source, cubemap);
      if (calling && options.progress) options.progress(static_cast<double>(std::min(next.load(), tasks.size())) / static_cast<double>(tasks.size()));
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (std::size_t i = 1; i < std::min(most, tasks.size()); ++i) helpers.emplace_back(work, false);
    work(true);
  }
  if (options.progress) options.progress(1);  // the helpers may have left nothing to the caller
}

struct Moments {
  double mean = 0, rms = 0;
};
Moments momentsOf(const CubeLevel& level) {
  double sum = 0, squares = 0;
  for (const float v : level.texels) sum += static_cast<double>(v), squares += static_cast<double>(v) * static_cast<double>(v);
  const auto n = static_cast<double>(level.texels.size());
  return {sum / n, std::sqrt(squares / n)};
}

/// 0 of 0 is no error.
double ratio(double error, double scale) { return error == 0 ? 0 : error / scale; }

/// A level that is the source itself, if it is: compared value by value.
void compareWithSource(const CubeLevel& level, const CubeLevel& source, PrefilterCheck::Level& out) {
  const Moments moments = momentsOf(source);
  double squares = 0;
  for (std::size_t i = 0; i < level.texels.size(); ++i) {
    const double reference = static_cast<double>(source.texels[i]), error = std::abs(static_cast<double>(level.texels[i]) - reference);
    squares += error * error;
    out.worst = std::max(out.worst, ratio(error, std::max(reference, 1e-6 * moments.mean)));
  }
  out.rms = ratio(std::sqrt(squares / static_cast<double>(level.texels.size())), moments.rms);
  out.samples = static_cast<int>(level.texels.size() / 3);
}

Result<PrefilterCheck> check(const Source& source, const CubeLevel* same, const Cubemap& cubemap, const PrefilterCheckOptions& options) {
  if (!cubemap.lobe) return fail("checkPrefilter", "the cubemap has no lobe", "filter it first");
  std::vector<Task> tasks;
  std::mt19937_64 random(options.seed);
  PrefilterCheck out;
  for (std::size_t k = 0; k < cubemap.levels.size(); ++k) {
    const CubeLevel& level = cubemap.levels[k];
    if (level.size < 1 || level.texels.size() != std::size_t(level.size) * std::size_t(level.size) * 18) return fail("checkPrefilter", fmt::format("level {} lacks texels", k), "filter it again");
    out.levels.push_back({level.size, level.roughness, 0, 0, 0, true});
    if (level.roughness > 0) addTasks(level, k, options, random, tasks);
    else if (same && same->size == level.size) compareWithSource(level, *same, out.levels.back());
  }
  runAll(tasks, source, cubemap, options);
  std::vector<double> squares(out.levels.size());
  std::vector<Moments> moments;
  for (const CubeLevel& level : cubemap.levels) moments.push_back(momentsOf(level));
  for (const Task& task : tasks) {
    PrefilterCheck::Level& level = out.levels[task.level];
    for (std::size_t c = 0; c < 3; ++c) {
      level.worst = std::max(level.worst, ratio(std::abs(task.error[c]), std::max(task.reference[c], 1e-6 * moments[task.level].mean)));
      if (!task.brightest) squares[task.level] += task.error[c] * task.error[c];
    }
    if (!task.brightest) ++level.samples;
  }
  for (std::size_t k = 0; k < out.levels.size(); ++k) {
    PrefilterCheck::Level& level = out.levels[k];
    if (level.roughness > 0) level.rms = ratio(std::sqrt(squares[k] / (3.0 * level.samples)), moments[k].rms);
    level.within = level.rms <= options.error && level.worst <= 10 * options.error;  // false for NaN
  }
  return out;
}

}  // namespace
}  // namespace prefilter

Result<PrefilterCheck> checkPrefilter(const CubeLevel& source, const Cubemap& cubemap, const PrefilterCheckOptions& options) {
  if (source.size < 1 || source.texels.size() != std::size_t(source.size) * std::size_t(source.size) * 18) return fail("checkPrefilter", "the source lacks texels", "read it again");
  return prefilter::check(prefilter::CubeSource(source), &source, cubemap, options);
}

Result<PrefilterCheck> checkPrefilter(const Image& latLong, const Cubemap& cubemap, const PrefilterCheckOptions& options) {
  if (latLong.type != PixelType::F32 || latLong.channels < 3 || latLong.width < 1 || latLong.height < 1 || latLong.data.size() != latLong.byteSize())
    return fail("checkPrefilter", "the source is no float picture of three or four channels", "convert it first");
  return prefilter::check(prefilter::LatLongSource(latLong), nullptr, cubemap, options);
}

}  // namespace burnish
