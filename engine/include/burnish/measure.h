// Measuring the engine on this machine: ground truth by path tracing, what every approximation costs and gets wrong, the quality that spends a time budget best, the hard cases with their
// bounds, and what each guard of the shading text costs in energy.
#pragma once
#include <burnish/plan.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace burnish {

// ---- Ground truth (docs/reference.md)

struct ReferenceProgress {
  int samples = 0, of = 0;   ///< of each pixel
  double error = 0;          ///< estimated: rms over the picture of a pixel's standard error, over the picture's rms
  double seconds = 0;        ///< wall time of this call
};
struct ReferenceOptions {
  glm::ivec2 size{640, 360};   ///< pixels
  int samples = 256;           ///< of each pixel, 1 to 1,000,000
  double untilError = 0;       ///< stops once ReferenceProgress::error is below it (and 16 samples are in); 0: never
  std::uint64_t seed = 1;      ///< another seed, other noise
  int bounces = -1;            ///< surfaces that light may meet on its way, the one seen aside; 0: direct light alone; -1: no limit (Russian roulette)
  bool pixelArea = true;       ///< samples spread over the pixel; false: all through its centre, as rasterization samples
  int threads = 0;             ///< 0: one for each core; the picture does not depend on it
  std::filesystem::path state; ///< what was traced so far is kept here (every half minute and at the end) and taken up again; empty: nowhere
  std::function<bool(const ReferenceProgress&)> progress;  ///< called from the calling thread after each pass; false ends the work with what is there
};
/// A path-traced picture, rows from top to bottom, F32 with three channels.
struct ReferencePicture {
  Image radiance;  ///< cd/m²
  Image direct;    ///< of it what light sources and surroundings bring without a bounce, emission of what is seen included
  Image albedo, normal;  ///< of the first surface: diffuse albedo + F0, 0..1; world space, 0 where there is none
  Image variance;  ///< of each pixel's mean, (cd/m²)²
  int samples = 0;
  double error = 0;  ///< as ReferenceProgress::error
  // What was traced, for the file's header:
  std::uint64_t seed = 1;
  int bounces = -1;
  bool pixelArea = true;
  std::string scene, camera;  ///< names for people; traceReference leaves them empty
};
/// Traces paths through the scene with the materials, lights, camera and shading text of the renderer: `quality` says which rungs shade (of specular, diffuse and Fresnel; the preset `exact` is the
/// one to compare with). Multiple importance sampling of lights, surroundings and emissive surfaces (Veach 1997). Lights are occluded as castsShadow says; stand-ins, probes and baked occlusion have
/// no part. Deterministic: the same options and scene give the same picture on any number of threads. Errors: a scene that is too large, a state file of other options.
BURNISH_API Result<ReferencePicture> traceReference(const Scene& scene, const View& view, const Quality& quality, const ReferenceOptions& options, Report& report);
/// One OpenEXR file with layers: R G B, direct.*, albedo.*, normal.*, variance.*; samples and error are in its header. Complete or absent.
BURNISH_API Result<void> writeReference(const std::filesystem::path& file, const ReferencePicture& picture);
/// Reads what writeReference wrote. Errors name the file and what is missing.
BURNISH_API Result<ReferencePicture> readReference(const std::filesystem::path& file);
/// A picture in cd/m² (F32, three or four channels) as the renderer develops it for a display: U8 RGB. exposureEv empty: metered as its automatic exposure is; `metered` then says what was found.
BURNISH_API Image develop(const Image& radiance, ToneMap toneMap, std::optional<float> exposureEv, float* metered = nullptr);

// ---- What accuracy costs (docs/cost.md)

/// A measured figure: the median of several. Repeating the measurement gives a median between low and high 19 times in 20 (docs/cost.md).
struct Spread {
  double median = 0, low = 0, high = 0;
  int count = 0;
};
/// How far a picture is from another. Pixels that are not finite in either do not count, and are counted.
struct PictureError {
  double rms = 0;         ///< of the linear difference, over the rms of the other, both held at four times the exposure's white; the noise of a path-traced one is taken off
  double rmsSpread = 0;   ///< standard error of rms from that noise; 0 between two pictures of the renderer
  double psnr = 0;        ///< dB, of the two as developed for a display; infinite where they are equal
  double perceptual = 0;  ///< Butteraugli's 3-norm of the developed pictures (libjxl): 1 is a difference that is just seen
  double p999 = 0;        ///< 99.9th percentile over pixels of |difference| / (other + its mean), luminance
  double energy = 0;      ///< sum over sum of the other, less 1: above 0 it is too bright
  long long skipped = 0;  ///< pixels that are not finite
  long long uncertain = 0;  ///< pixels where the other's noise is over half of its value and mean together: left out of rms and energy
};
/// One rung, or one setting of a choice.
struct RungCost {
  std::string name;          ///< "schlick"; of a choice "512"
  bool inForce = false;      ///< the base quality has it
  Spread passMs, frameMs;    ///< of the passes that it changes, and of the frame, the rest as in the base quality
  Spread exactPassMs;        ///< the rest as in the preset `exact`; count 0 where that was not timed
  PictureError exact;        ///< against the exact rung, the rest as in the base quality
  PictureError exactRest;    ///< against the exact rung, the rest as in the preset `exact`
  bool exactRestKnown = false;  ///< that one was rendered; the time may have been too short
  PictureError truth;        ///< against ground truth, the rest as in the base quality
  bool dominated = false;    ///< another rung of the term is no slower and no less exact, and better in one by more than the spread
  std::string note;          ///< why a figure is missing, or what else is to be said; may be empty
  Image picture;             ///< U8 RGB, developed
  Image difference;          ///< F32, one channel: |picture - exact| over the exposure's white, linear
};
struct TermCost {
  std::string name, what;
  std::string calledBy;      ///< what in the scene exercises it
  bool choice = false;       ///< no term of the lighting equation: a size, a format, a layout
  std::string setting;       ///< what of the rest is changed so that the term counts ("geometry=void"); empty: nothing
  std::string exactRung;     ///< what errors count against
  Image exactPicture;        ///< U8 RGB
  std::vector<RungCost> rungs;
};
/// A whole quality, measured.
struct FrontPoint {
  Quality quality;
  std::vector<std::string> settings;  ///< what differs from the base quality, "term=rung"
  Spread ms;                          ///< of the frame
  PictureError error;                 ///< against CostReport::against
  bool dominated = false;             ///< not on the front
};
struct CostReport {
  std::string scene, camera, command;  ///< command: what makes this report again
  glm::ivec2 size{0};
  Capabilities machine;
  std::string backend, cpu;
  std::string clock;                   ///< "CPU time" (software renderers) or "GPU time": what ms are
  std::string against;                 ///< "ground truth" or "exact": what the front's errors count against
  int referenceSamples = 0;
  double referenceNoise = 0;
  std::vector<TermCost> terms;
  std::vector<FrontPoint> front;       ///< presets first, then what was tried, cheapest first
  FrontPoint base, exact;              ///< the base quality and the preset `exact`
  std::vector<std::pair<std::string, double>> contributors;  ///< of the base quality's error against ground truth: what closing each gap would take off rms, largest first
  Image truthPicture, basePicture, exactPicture;  ///< U8 RGB, developed alike
  Image baseDifference, exactDifference;  ///< F32, one channel, against ground truth
  double differenceScale = 0;          ///< white of all difference pictures
  double seconds = 0;                  ///< wall time that it took
  std::vector<std::pair<std::string, std::string>> idle;  ///< terms and choices that the scene does not exercise, each with the reason
  std::vector<std::string> warnings;
};
struct CostOptions {
  glm::ivec2 size{640, 360};
  Quality base;                        ///< its exposure, if set, develops all pictures; else the base picture's automatic one
  std::string baseName = "default";
  const ReferencePicture* truth = nullptr;  ///< not owned; of `size`; none: errors against ground truth are left out
  int rounds = 7;                      ///< pairs of frames, with the rung and without, at least 3
  double minutes = 12;                 ///< wall time to spend; fewer rounds and no timings with the exact rest when it runs short; 0: no limit
  std::vector<std::string> terms;      ///< these alone, and choices by their names (costChoices()); empty: all that the scene exercises
  bool choices = true;                 ///< sizes, formats and layouts too
  std::string backend;                 ///< name for the report
  /// Opens a context of its own and makes it current on the calling thread, a thread of the measurement's, which also closes it. Half of all pictures are made there, beside the others: drivers compile
  /// programs on one thread. Nothing runs there while times are taken. Empty: all is done on the context that is current.
  std::function<Result<std::unique_ptr<Context>>()> secondContext;
  std::function<bool(double share, std::string_view what)> progress;  ///< false ends the work with an error
};
/// Names of the choices that are no terms, in the order in which they are measured: "normal-storage", "resolution-scale", ... (docs/storage.md).
BURNISH_API std::span<const std::string_view> costChoices();
/// Renders every rung of every term that the scene exercises in this view and holds time and error against the rest. The context must be current. Pictures are linear, without antialiasing,
/// through pixel centres.
BURNISH_API Result<CostReport> measureCost(const ProcAddress& getProcAddress, const Scene& scene, const View& view, const CostOptions& options, Report& report);

struct BudgetOptions {
  double ms = 0;                       ///< of the frame, in the report's clock; 0: by targetError
  double targetError = 0;              ///< rms against CostReport::against
  double minutes = 5;                  ///< wall time to spend
  std::function<bool(double share, std::string_view what)> progress;
};
struct BudgetResult {
  double ms = 0, targetError = 0;      ///< what was asked for, as in BudgetOptions
  bool met = false;                    ///< false: nothing that was measured fits; `best` is the nearest
  FrontPoint best;                     ///< measured, not added up
  std::optional<FrontPoint> next;      ///< the cheapest that is better: what the next milliseconds would buy
  int measured = 0;                    ///< combinations that were rendered
};
/// For each budget the set of rungs with the least error whose measured frame time fits, its spread included (or the least time whose error fits). One search: what is rendered for one budget serves
/// the others. Starts from `cost`, whose front it extends by what it measures. `options` as measureCost had them. Only terms that the scene exercises are touched, and no antialiasing or bloom.
/// Errors: budgets that ask for nothing, a report of another size, stopped by `progress` (of the first budget), OpenGL's. When the time is up (the sum of all minutes) it returns what it has.
BURNISH_API Result<std::vector<BudgetResult>> spendBudget(const ProcAddress& getProcAddress, const Scene& scene, const View& view, const CostOptions& options, std::span<const BudgetOptions> budgets, CostReport& cost,
                                                          Report& report);

/// Into the folder: index.html (self-contained), cost.json, cost.csv, and plots as SVG and PNG. Each file complete or absent.
BURNISH_API Result<void> writeCostReport(const std::filesystem::path& folder, const CostReport& cost, const std::vector<BudgetResult>& budgets, Report& report);

// ---- Hard cases (docs/hard_cases.md)

/// One hard case on one backend: it holds when `value` is finite and at most `bound`. Bounds come from the double-precision oracle or from geometry.
struct StabilityCase {
  std::string id;       ///< "H12", as docs/hard_cases.md numbers them
  std::string what;     ///< one line, with the unit of value and bound
  std::string backend;  ///< "double", "float" (the shading text as C++), or the OpenGL backend's name
  double value = 0, bound = 0;
  bool pass = false;
  std::string note;     ///< where the value was found, or the error; may be empty
};

/// One guard (epsilon, clamp, saturate) of the shading text.
struct GuardRow {
  std::string name;             ///< as shaders/shading/constants.h declares it
  double value = 0;             ///< NaN where the guard is a clamp to [0, 1] or the like
  std::string reason;
  double worstEnergyLoss = 0;   ///< largest share of the reflected energy that it takes away, over rungs × roughness × angle; 0.01 is 1 %
  std::string where;            ///< where that is: rung, roughness, n·v; empty: it changes nothing there
  double worstEnergyGain = 0;   ///< likewise, what it adds
  int nonfiniteWithout = 0;     ///< cells of the same grid, and adversarial inputs, that are not finite without the guard
};

/// Called before each case with how many are done, of how many.
using MeasureProgress = std::function<void(int done, int total, std::string_view what)>;

struct StabilityOptions {
  std::vector<std::string> cases;        ///< ids, "H12": these alone; empty: all
  bool quick = false;                    ///< without the cases that take more than a second or so on a software renderer
  std::filesystem::path shaderOverride;  ///< RendererOptions::shaderOverride of the pictures, and of the shading text as GLSL
  MeasureProgress progress;
};
/// Every id that has a case, in order: "H1" to "H29".
BURNISH_API std::vector<std::string> stabilityIds();
/// The hard cases of the shading text as C++, in double and in float, and of what is computed on the CPU. No OpenGL. Some seconds.
BURNISH_API std::vector<StabilityCase> stabilityOnCpu(const StabilityOptions& options = {});
/// The hard cases on the current context: the shading text as GLSL, and pictures through the renderer. `backend`: the name for the rows. Errors of OpenGL itself are rows that fail.
/// A minute or so on a software renderer.
BURNISH_API std::vector<StabilityCase> stabilityOnGpu(const ProcAddress& getProcAddress, std::string_view backend, const StabilityOptions& options = {});
/// The guard ledger: each guard taken out by itself, in double. No OpenGL. Some seconds.
BURNISH_API std::vector<GuardRow> guardLedger(const MeasureProgress& progress = {});

}  // namespace burnish
