// Probes: finding places for them, baking their light with the engine's own renderer over several bounces, and the folder that holds them (docs/probes.md, docs/probe_files.md).
// The types are in scene.h. Units: metres, cd/m². Nothing here keeps a thread when it returns; contexts must be current on the calling thread.
#pragma once
#include <burnish/renderer.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace burnish {

struct PlacementOptions {
  bool rooms = true;            ///< a box and a probe for each room that is found
  bool grid = true;             ///< a lattice over what is inside
  double gridSpacing = 0;       ///< metres; 0: chosen from the rooms' sizes
  int maxGridPoints = 4096;     ///< a spacing that is too small for this is enlarged, with a warning
  int threads = 0;              ///< 0: one for each core; the result does not depend on it
  std::function<void(double share)> progress;  ///< called with 0 to 1 from the calling thread
};
/// Finds rooms in the scene's geometry: places for reflection probes with boxes, and a lattice without the points that are inside something. Probes that the scene has already (from nodes of
/// its file) stay and count. Not baked: radiance is empty; the grid's points have `valid` and `distances`.
BURNISH_API Result<ProbeSet> placeProbes(const Scene& scene, const PlacementOptions& options, Report& report);

struct BakeOptions {
  Quality quality;           ///< rungs of the lighting equation; what belongs to the picture (antialiasing, bloom, screen occlusion) is left out
  int size = 128;            ///< texels along an edge of a reflection probe's capture, a power of two, 16 to 2048
  int ambientSize = 16;      ///< likewise of a grid point's
  ReflectionLobe lobe = ReflectionLobe::BlinnPhong;
  int bounces = 0;           ///< 0: until the estimated rest is under `until`
  double until = 0.01;       ///< estimated rest of the light, change · q / (1 - q), over all of it
  int maxBounces = 64;       ///< more are an error where `bounces` is 0
  double albedoLimit = 0.98; ///< what surfaces reflect at most in all (diffuse and specular) while baking, 0 to 1
  int threads = 0;           ///< of the filter; 0: one for each core; the result does not depend on it
};

/// What a bounce changed.
struct BounceReport {
  int bounce = 0;        ///< from 1: light that comes straight from lights, emission and sky
  double change = 0;     ///< of the probes' light against the bounce before, over all of it: rms of irradiance over all capture points, directions and channels
  double light = 0;      ///< all of it: rms of irradiance over π, cd/m²
  double ratio = 0;      ///< q: what this bounce added (change · light) over what the one before added; 0 in the first bounce
  double rest = 0;       ///< estimated: change · q / (1 - q); infinite while q is not known or not below 1
  int captured = 0, reused = 0;  ///< capture points
};

struct BakeReport {
  std::vector<BounceReport> bounces;
  double captureMs = 0, filterMs = 0, storeMs = 0;  ///< CPU time of the process
  double wallMs = 0;
};

/// Which part of a bake a call does.
struct BakeJob {
  std::filesystem::path folder;
  bool resume = false;       ///< takes what an earlier, unfinished or outdated bake left in the folder where it still holds; without it a folder with probes is an error
  int shard = 0, shards = 1; ///< with `bounce`: this part of the capture points, 0 <= shard < shards
  int bounce = 0;            ///< 0: all of them; else this one alone, whose part is written for mergeBounce()
  std::function<void(int bounce, int done, int total, double secondsLeft)> progress;  ///< secondsLeft negative: not known yet
  std::function<void(const BounceReport&)> bounced;  ///< after each bounce
};

/// Bakes the scene's probes (scene.probes, whose light is not looked at) into a folder. The same scene and options give the same bytes, whether in one go, resumed or in shards.
BURNISH_API Result<BakeReport> bakeProbes(const ProcAddress& getProcAddress, const Scene& scene, const BakeOptions& options, const BakeJob& job, Report& report);
/// Joins the parts of the bounce that all shards of a folder have written, and permits the next. Needs neither scene nor context. When the bake is over it writes the set: `finished` says so.
struct MergeReport {
  BounceReport bounce;
  bool finished = false;
};
BURNISH_API Result<MergeReport> mergeBounce(const std::filesystem::path& folder, Report& report);

/// Reads a folder that bakeProbes() or writeProbes() wrote. Hashes are checked; a damaged, cut off or lying file is one Error that names it and the place in it.
BURNISH_API Result<ProbeSet> readProbes(const std::filesystem::path& folder, Report& report);
/// Writes a set as a folder: complete or absent. The folder is made if it is missing; an old set in it stays until the new one is complete. Radiance is rounded to half floats over a power of two a
/// probe, the rest is exact. Errors: what docs/probe_files.md does not allow, a folder that holds other things, one that a bake is writing to.
BURNISH_API Result<void> writeProbes(const std::filesystem::path& folder, const ProbeSet& probes, Report& report);

/// What a folder of probes holds and what is wrong with it.
struct ProbeFolder {
  struct File {
    std::string name;
    std::uint64_t bytes = 0;
    double scale = 1;  ///< of a cube: what its half floats are multiplied by
  };
  ProbeSet set;                   ///< what could be read: probes whose file is damaged have no levels
  std::string writer;             ///< empty: there is no set yet
  std::vector<File> files;        ///< of the set
  std::string options;            ///< JSON of the bake's options; empty: not baked by bakeProbes()
  std::vector<BounceReport> bounces;  ///< of the bake that made the set; captured and reused are 0
  int joined = 0;                 ///< bounces in the work folder
  std::vector<std::string> wrong;     ///< one text each, with file and place
};
/// Looks at everything in a folder, the bake's work folder too. Error: there is no such folder, or it holds no probes.
BURNISH_API Result<ProbeFolder> inspectProbes(const std::filesystem::path& folder);

}  // namespace burnish
