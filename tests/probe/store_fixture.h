// A small set of probes with all that a folder can hold, and what tests of folders need.
#pragma once
#include <burnish/probe.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <string>

#include "gpu/temporary_folder.h"

namespace store_test {

namespace fs = std::filesystem;
using namespace burnish;

using Folder = burnish::test::TemporaryFolder;

inline std::string textOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
/// As a new file: some file systems flush one that is cut to nothing first.
inline void put(const fs::path& file, const std::string& text) {
  std::error_code ignored;
  if (!fs::is_symlink(file)) fs::remove(file, ignored);
  std::ofstream(file, std::ios::binary) << text;
}
inline void setByte(const fs::path& file, std::size_t at, char value) { std::fstream(file, std::ios::binary | std::ios::in | std::ios::out).seekp(std::streamoff(at)).put(value); }
/// Names, relative to the folder, and bytes of all that a folder holds.
inline std::map<std::string, std::string> contentOf(const fs::path& folder) {
  std::map<std::string, std::string> out;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file()) out[fs::relative(entry.path(), folder).string()] = textOf(entry.path());
  return out;
}

/// Runs `body` in a child; gives its exit code, or 1000 + signal.
inline int inChild(const std::function<int()>& body) {
  const pid_t pid = ::fork();
  if (pid == 0) ::_exit(body());
  int status = 0;
  REQUIRE(::waitpid(pid, &status, 0) == pid);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

/// Levels with values from `least` to `most`, evenly in their logarithms; the first one is `most`.
inline Cubemap radianceOf(int size, int levels, double least, double most, std::mt19937& random) {
  Cubemap cube;
  cube.lobe = ReflectionLobe::Ggx;
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < levels; ++k) {
    CubeLevel& level = cube.levels.emplace_back();
    level.size = size >> k;
    level.roughness = double(k) / levels;
    level.texels.resize(std::size_t(level.size) * std::size_t(level.size) * 18);
    for (float& v : level.texels) v = float(least * std::pow(most / least, share(random)));
  }
  cube.levels[0].texels[0] = float(most);
  return cube;
}

inline glm::dmat3 turned(double angle) { return {{std::cos(angle), 0, -std::sin(angle)}, {0, 1, 0}, {std::sin(angle), 0, std::cos(angle)}}; }

inline ProbeSet sampleSet(int size = 8) {
  std::mt19937 random(7);
  std::normal_distribution<double> number(0, 3);
  const auto vec = [&] { return glm::dvec3(number(random), number(random), number(random)); };
  ProbeSet set;
  for (int i = 0; i < 3; ++i) {
    ReflectionProbe& p = set.reflections.emplace_back();
    p.name = i == 0 ? "hall \"north\"" : i == 1 ? "Stiege ü" : "";
    p.center = vec(), p.axes = turned(0.1 * i), p.halfSize = glm::abs(vec()), p.capture = vec(), p.fade = glm::abs(vec()), p.margin = std::abs(number(random));
    for (auto& rgb : p.irradiance)
      for (double& v : rgb) v = number(random) / 3;
  }
  set.reflections[0].radiance = radianceOf(size, 2, 1e-2, 1e7, random);
  set.reflections[1].radiance = radianceOf(size, 2, 1e-9, 1e-3, random);
  AmbientGrid& g = set.grid.emplace();
  g.name = "lattice";
  g.origin = vec(), g.axes = turned(-0.7), g.spacing = {0.1, 1.0 / 3, 2}, g.counts = {3, 2, 2}, g.margin = 0.1;
  g.points.resize(12);
  for (std::size_t i = 0; i < g.points.size(); ++i) {
    AmbientGrid::Point& p = g.points[i];
    p.valid = i % 5 != 3;
    if (!p.valid) continue;
    for (glm::vec3& rgb : p.irradiance) rgb = vec();
    for (int t = 0; t < AmbientGrid::kDistanceSize * AmbientGrid::kDistanceSize; ++t) p.distances.emplace_back(std::abs(number(random)), std::abs(number(random)));
  }
  return set;
}

}  // namespace store_test
