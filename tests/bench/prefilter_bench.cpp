// What filtering an environment costs and how exact it is (docs/prefilter.md): CPU time cold and warm, memory, beside the direct sum over all texels in the same run, and error against time as the
// knob moves.
//   prefilter_bench [--size 256,512] [--levels 9] [--lobe blinn-phong|ggx|both] [--errors 1e-2,...] [--samples 48] [--rounds 5] [--direct on|off] [--json FILE]
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

}  // namespace

int main(int argc, char** argv) {
  std::string sizes = "256,512", lobes = "both", errors = "1e-2,1e-3,1e-4,1e-5,1e-6,1e-7", json;
  int levels = 9, samples = 48, rounds = 5;
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
    else if (key == "--json") json = value;
    else {
      std::fputs(fmt::format("prefilter_bench: unknown option {}\n", key).c_str(), stderr);
      return 2;
    }
  }
  std::vector<Row> rows;
  fmt::print("| source and base | lobe | error asked | CPU ms cold | warm | tables | direct sum, CPU s | worst level rms | worst texel | peak MiB |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const double number : numbers(sizes))
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
        Cubemap cube;
        for (int round = 0; round < rounds + 1; ++round) {
          PrefilterReport report;
          auto made = prefilterCubemap(source, o, &report);
          if (!made) {
            std::fputs((made.error().message() + "\n").c_str(), stderr);
            return 1;
          }
          cube = std::move(*made);
          if (round == 0) row.cold = report.cpuMs, row.tables = report.tablesMs;
          else row.warm = std::min(row.warm, report.cpuMs);
        }
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
  if (json.empty()) return 0;
  std::error_code ignored;  // the stream says so if it cannot be written
  std::filesystem::create_directories(std::filesystem::path(json).parent_path(), ignored);
  std::ofstream out(json);
  out << "[\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& r = rows[i];
    out << fmt::format("  {{\"size\": {}, \"lobe\": \"{}\", \"levels\": {}, \"error\": {}, \"cold_ms\": {:.2f}, \"warm_ms\": {:.2f}, \"tables_ms\": {:.2f}, \"direct_ms\": {:.1f}, \"rms\": {:.4g}, \"worst\": {:.4g}, \"peak_mib\": {:.0f}}}{}\n",
                       r.size, nameOf(r.lobe), levels, r.error, r.cold, r.warm, r.tables, r.direct, r.rms, r.worst, r.memory, i + 1 < rows.size() ? "," : "");
  }
  out << "]\n";
  return out ? 0 : 1;
}
