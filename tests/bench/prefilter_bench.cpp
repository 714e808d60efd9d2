// What filtering an environment costs and how exact it is (docs/prefilter.md): CPU time cold and warm, memory, beside the direct sum over all texels in the same run, and error against time as the
// knob moves. --lat-long WIDTH: such a picture too, its times alone, to a base of 256².
//   prefilter_bench [--size 256,512|none] [--levels 9] [--lobe blinn-phong|ggx|both] [--errors 1e-2,...] [--samples 48] [--rounds 5] [--direct on|off] [--json FILE] [--svg FILE] [--lat-long 0]
#include <burnish/image.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "prefilter/lobe.h"
#include "prefilter/oracle.h"
#include "prefilter/source.h"

using namespace burnish;
using namespace burnish::test;

namespace {

double cpuMs() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) * 1e3 + double(t.tv_nsec) * 1e-6;
}

double peakMiB() {
  rusage u{};
  getrusage(RUSAGE_SELF, &u);
  return double(u.ru_maxrss) / 1024;
}

std::vector<double> numbers(const std::string& text) {
  std::vector<double> out;
  std::stringstream in(text);
  for (std::string part; std::getline(in, part, ',');) out.push_back(std::stod(part));
  return out;
}

/// Sky 1 with clouds and a sun, what is hard about both.
CubeLevel sourceOf(int size) {
  CubeLevel c = sunCube(size, {1, 0.3, 0.97});
  std::mt19937 random(1);
  for (float& v : c.texels) v *= 0.5f + float(random() % 1024) / 1024;
  return c;
}

const char* nameOf(ReflectionLobe lobe) { return lobe == ReflectionLobe::Ggx ? "ggx" : "blinn-phong"; }

/// The direct sum over all texels of the source with the engine's own vectors, in double: CPU ms for a whole level, from 64 of its texels.
double directMs(const CubeLevel& level, const prefilter::Source& source, ReflectionLobe shape) {
  const int texels = int(level.texels.size() / 3), samples = std::min(texels, 64);
  const prefilter::TexelsView& all = source.texelArrays(1);
  const prefilter::Lobe lobe = prefilter::Lobe::of(shape, level.roughness);
  const prefilter::FullLobe full{shape == ReflectionLobe::Ggx, lobe.power / 2, (1 / lobe.alpha2 - 1) / 2, lobe.power < 100 || shape == ReflectionLobe::Ggx ? 1 : std::min(1.0, 4 / lobe.power * 46)};
  double sums[4] = {};
  const double start = cpuMs();
  for (int k = 0; k < samples; ++k) {
    const std::size_t t = std::size_t(k) * std::size_t(texels) / std::size_t(samples), face = std::size_t(level.size) * std::size_t(level.size);
    const glm::dvec3 d = prefilter::aboutY(centreOf(level.size, int(t / face), int(t % std::size_t(level.size)), int(t / std::size_t(level.size) % std::size_t(level.size))));
    const double direction[3] = {d.x, d.y, d.z};
    prefilter::sumTexels(all, 0, source.texels(), direction, full, sums);
  }
  return (cpuMs() - start) / samples * texels;
}

struct Row {
  int size;
  ReflectionLobe lobe;
  double error, cold, warm, tables, direct, rms, worst, memory;
};

/// Fills the row's times. Empty: the error is printed.
template <class Input>
Cubemap timed(const Input& source, const PrefilterOptions& options, int rounds, Row& row) {
  Cubemap cube;
  for (int round = 0; round < rounds + 1; ++round) {
    PrefilterReport report;
    auto made = prefilterCubemap(source, options, &report);
    if (!made) {
      std::fputs((made.error().message() + "\n").c_str(), stderr);
      return {};
    }
    cube = std::move(*made);
    if (round == 0) row.cold = report.cpuMs, row.tables = report.tablesMs;
    else row.warm = std::min(row.warm, report.cpuMs);
  }
  return cube;
}

/// The same sky as a lat-long picture.
Image pictureOf(int width) {
  Image image = makeImage(width, width / 2, 3, PixelType::F32);
  const glm::dvec3 sun = glm::normalize(glm::dvec3(1, 0.3, 0.97));
  std::mt19937 random(1);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < width; ++x) {
      const double longitude = ((x + 0.5) / width - 0.5) * kCircle, polar = (y + 0.5) / image.height * kCircle / 2;
      const glm::dvec3 d(std::sin(polar) * std::sin(longitude), std::cos(polar), -std::sin(polar) * std::cos(longitude));
      const double light = glm::dot(d, sun) > std::cos(0.25 / 360 * kCircle) ? 1e5 : 1;
      for (std::size_t c = 0; c < 3; ++c) image.f32()[(std::size_t(y) * std::size_t(width) + std::size_t(x)) * 3 + c] = float(light) * (0.5f + float(random() % 1024) / 1024);
    }
  return image;
}

bool writeText(const std::string& path, const std::string& text) {
  std::error_code ignored;  // the stream says so if it cannot be written
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), ignored);
  std::ofstream out(path);
  out << text;
  out.close();
  if (!out) std::fputs(fmt::format("prefilter_bench: {} cannot be written\n", path).c_str(), stderr);
  return bool(out);
}

/// The worst level's rms error against the CPU time it took, cold, one line a lobe and size; both axes logarithmic, in colours that show on light and on dark.
std::string plotOf(const std::vector<Row>& rows) {
  constexpr double kLeft = 76, kTop = 24, kWidth = 560, kHeight = 330;
  double least[2] = {1e30, 1e30}, most[2] = {0, 0};
  for (const Row& r : rows) {
    least[0] = std::min(least[0], r.cold), most[0] = std::max(most[0], r.cold);
    least[1] = std::min(least[1], r.rms), most[1] = std::max(most[1], r.rms);
  }
  // Axes from 1, 2 or 5 times a power of ten to another (time), from one power of ten to another (error).
  std::vector<double> times;
  for (double decade = std::pow(10, std::floor(std::log10(least[0]))); decade < most[0] * 10; decade *= 10)
    for (const double tick : {1.0, 2.0, 5.0}) times.push_back(decade * tick);
  while (times.size() > 2 && times[1] <= least[0]) times.erase(times.begin());
  while (times.size() > 2 && times[times.size() - 2] >= most[0]) times.pop_back();
  const double low = std::floor(std::log10(std::max(least[1], 1e-12))), high = std::max(low + 1, std::ceil(std::log10(std::max(most[1], 1e-12))));
  const auto xOf = [&](double ms) { return kLeft + kWidth * std::log(ms / times.front()) / std::log(times.back() / times.front()); };
  const auto yOf = [&](double error) { return kTop + kHeight * (high - std::log10(std::max(error, 1e-12))) / (high - low); };
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#7d8590\">\n<title>Error of the filter against its CPU time</title>\n<g stroke=\"#7d8590\" stroke-opacity=\"0.3\">\n",
      kLeft + kWidth + 24, kTop + kHeight + 56);
  std::string labels;
  for (const double t : times) {
    out += fmt::format("<path d=\"M{:.1f} {}V{}\"/>\n", xOf(t), kTop, kTop + kHeight);
    labels += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", xOf(t), kTop + kHeight + 19, t);
  }
  for (double e = low; e <= high; ++e) {
    const double y = yOf(std::pow(10, e));
    out += fmt::format("<path d=\"M{} {:.1f}H{}\"/>\n", kLeft, y, kLeft + kWidth);
    labels += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">1e{:.0f}</text>\n", kLeft - 8, y + 4, e);
  }
  out += "</g>\n" + labels;
  out += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">CPU time, cold, ms</text>\n", kLeft + kWidth / 2, kTop + kHeight + 44);
  out += fmt::format("<text transform=\"translate(18 {}) rotate(-90)\" text-anchor=\"middle\">error of the worst level, rms over rms</text>\n", kTop + kHeight / 2);
  int series = 0;
  for (std::size_t i = 0; i < rows.size();) {
    const std::size_t first = i;
    std::string line, marks;
    const char* color = series % 2 ? "#d9822b" : "#3f8fd2";
    for (; i < rows.size() && rows[i].lobe == rows[first].lobe && rows[i].size == rows[first].size; ++i) {
      const double x = xOf(rows[i].cold), y = yOf(rows[i].rms);
      line += fmt::format("{}{:.1f} {:.1f}", i == first ? "M" : "L", x, y);
      marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"/><text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"11\">{:.0e}</text>\n", x, y, x + 7, y - 6, rows[i].error);
    }
    out += fmt::format("<g fill=\"{}\"><path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n{}<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}, {}²; beside each point: error asked for</text></g>\n", color, line, color,
                       marks, kLeft + kWidth - 8, kTop + 20 + 20 * series, rows[first].lobe == ReflectionLobe::Ggx ? "GGX" : "Blinn-Phong", rows[first].size);
    ++series;
  }
  return out + "</svg>\n";
}

}  // namespace

int main(int argc, char** argv) {
  std::string sizes = "256,512", lobes = "both", errors = "1e-2,1e-3,1e-4,1e-5,1e-6,1e-7", json, svg;
  int levels = 9, samples = 48, rounds = 5, latLong = 0;
  bool direct = true;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string key = argv[i], value = argv[i + 1];
    if (key == "--size") sizes = value;
    else if (key == "--levels") levels = std::stoi(value);
    else if (key == "--lobe") lobes = value;
    else if (key == "--errors") errors = value;
    else if (key == "--samples") samples = std::stoi(value);
    else if (key == "--rounds") rounds = std::stoi(value);
    else if (key == "--direct") direct = value == "on";
    else if (key == "--lat-long") latLong = std::stoi(value);
    else if (key == "--json") json = value;
    else if (key == "--svg") svg = value;
    else {
      std::fputs(fmt::format("prefilter_bench: unknown option {}\n", key).c_str(), stderr);
      return 2;
    }
  }
  std::vector<Row> rows;
  fmt::print("| source and base | lobe | error asked | CPU ms cold | warm | tables | direct sum, CPU s | worst level rms | worst texel | peak MiB |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const double number : sizes == "none" ? std::vector<double>() : numbers(sizes))
    for (const ReflectionLobe lobe : {ReflectionLobe::BlinnPhong, ReflectionLobe::Ggx}) {
      const int size = int(number);
      if (lobes != "both" && lobes != nameOf(lobe)) continue;
      const CubeLevel source = sourceOf(size);
      const Points points = samples ? pointsOf(source) : Points{};
      double directSum = 0;
      for (const double error : numbers(errors)) {
        PrefilterOptions o;
        o.lobe = lobe;
        o.size = size;
        o.levels = levels;
        o.error = error;
        o.threads = 1;
        Row row{size, lobe, error, 0, 1e30, 0, 0, 0, 0, 0};
        const Cubemap cube = timed(source, o, rounds, row);
        if (cube.levels.empty()) return 1;
        if (direct && directSum == 0)
          for (std::size_t k = 1; k < cube.levels.size(); ++k) directSum += directMs(cube.levels[k], *prefilter::makeSource(source, 1), lobe);
        row.direct = directSum;
        if (samples)
          for (std::size_t k = 1; k < cube.levels.size(); ++k) {
            const LevelError e = errorOf(cube.levels[k], points, lobe, samples, glm::normalize(glm::dvec3(1, 0.3, 0.97)));
            row.rms = std::max(row.rms, e.rms);
            row.worst = std::max(row.worst, e.worst);
          }
        row.memory = peakMiB();
        rows.push_back(row);
        fmt::print("| {}² | {} | {:.0e} | {:.0f} | {:.0f} | {:.0f} | {:.1f} | {:.1e} | {:.1e} | {:.0f} |\n", size, nameOf(lobe), error, row.cold, row.warm, row.tables, row.direct / 1e3, row.rms, row.worst, row.memory);
        std::fflush(stdout);
      }
    }
  if (latLong > 0) {
    const Image picture = pictureOf(latLong);
    for (const ReflectionLobe lobe : {ReflectionLobe::BlinnPhong, ReflectionLobe::Ggx}) {
      if (lobes != "both" && lobes != nameOf(lobe)) continue;
      PrefilterOptions o;
      o.lobe = lobe;
      o.levels = levels;
      o.threads = 1;
      Row row{256, lobe, o.error, 0, 1e30, 0, 0, 0, 0, 0};
      if (timed(picture, o, rounds, row).levels.empty()) return 1;
      fmt::print("| {} × {} to 256² | {} | {:.0e} | {:.0f} | {:.0f} | {:.0f} | | | | {:.0f} |\n", picture.width, picture.height, nameOf(lobe), o.error, row.cold, row.warm, row.tables, peakMiB());
    }
  }
  if (!svg.empty() && !rows.empty() && !writeText(svg, plotOf(rows))) return 1;
  if (json.empty()) return 0;
  std::string text = "[\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& r = rows[i];
    text += fmt::format("  {{\"size\": {}, \"lobe\": \"{}\", \"levels\": {}, \"error\": {}, \"cold_ms\": {:.2f}, \"warm_ms\": {:.2f}, \"tables_ms\": {:.2f}, \"direct_ms\": {:.1f}, \"rms\": {:.4g}, \"worst\": {:.4g}, \"peak_mib\": {:.0f}}}{}\n",
                       r.size, nameOf(r.lobe), levels, r.error, r.cold, r.warm, r.tables, r.direct, r.rms, r.worst, r.memory, i + 1 < rows.size() ? "," : "");
  }
  return writeText(json, text + "]\n") ? 0 : 1;
}
