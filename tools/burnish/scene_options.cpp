#include "scene_options.h"

#include <burnish/probe.h>
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdlib>

#include "samples.h"

namespace cli {
using burnish::fail;
using burnish::Result;

namespace {

std::optional<double> parseNumber(std::string_view text) {
  double value = 0;
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<glm::dvec3> parseVector(std::string_view text) {
  glm::dvec3 value{0};
  for (int i = 0; i < 3; ++i) {
    const std::size_t comma = text.find(',');
    if ((comma == std::string_view::npos) != (i == 2)) return std::nullopt;
    const auto number = parseNumber(text.substr(0, comma));
    if (!number) return std::nullopt;
    value[i] = *number;
    text.remove_prefix(i == 2 ? text.size() : comma + 1);
  }
  return value;
}

std::optional<glm::ivec2> parseSize(std::string_view text) {
  glm::ivec2 size{0};
  const std::size_t x = text.find('x');
  if (x == std::string_view::npos) return std::nullopt;
  for (int i = 0; i < 2; ++i) {
    const std::string_view part = i == 0 ? text.substr(0, x) : text.substr(x + 1);
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), size[i]);
    if (error != std::errc() || end != part.data() + part.size() || size[i] < 1 || size[i] > 16384) return std::nullopt;
  }
  return size;
}

/// An option whose text `parse` turns into `value`; what it refuses is a usage error that says `what` is expected.
template <class T, class Parse>
CLI::Option* addParsed(CLI::App& app, const std::string& flag, const std::string& type, const std::string& description, T& value, Parse parse,
                       const std::string& what) {
  return app
      .add_option_function<std::string>(
          flag,
          [&value, parse, what, flag](const std::string& text) {
            const auto parsed = parse(text);
            if (!parsed) throw CLI::ValidationError(flag, fmt::format("'{}' is not {}", text, what));
            value = *parsed;
          },
          description)
      ->type_name(type);
}

std::vector<std::string> texts(std::span<const std::string_view> names) { return {names.begin(), names.end()}; }

struct Cameras {
  std::vector<burnish::Id<burnish::Camera>> ids;
  std::vector<std::string> names;
};
Cameras camerasOf(const burnish::Scene& scene) {
  Cameras cameras;
  scene.cameras.each([&](burnish::Id<burnish::Camera> id, const burnish::Camera& camera) {
    cameras.ids.push_back(id);
    cameras.names.push_back(camera.name);
  });
  return cameras;
}

/// For an unknown term, or an unknown rung of a known one.
std::string didYouMeanRung(const std::string& term, const std::string& rung) {
  std::vector<std::string> names;
  for (const burnish::Term& t : burnish::terms()) {
    if (t.name == term) {
      names.clear();
      for (const burnish::Rung& r : t.rungs) names.emplace_back(r.name);
      return didYouMean(rung, names);
    }
    names.emplace_back(t.name);
  }
  return didYouMean(term, names);
}

Result<std::size_t> findCamera(const Cameras& cameras, const std::string& wanted, const std::string& file) {
  for (std::size_t i = 0; i < cameras.names.size(); ++i)
    if (cameras.names[i] == wanted) return i;
  if (const auto index = parseNumber(wanted); index && *index == std::floor(*index) && *index >= 0 && *index < double(cameras.ids.size()))
    return std::size_t(*index);
  if (cameras.ids.empty()) return fail(file, fmt::format("has no camera '{}' (it has none at all)", wanted), "leave --camera out, or use --eye and --target");
  return fail(file, fmt::format("has no camera '{}'{}", wanted, didYouMean(wanted, cameras.names)),
              fmt::format("choose one of: {}, or an index below {}", listed(cameras.names), cameras.ids.size()));
}

struct Animations {
  std::vector<burnish::Id<burnish::Animation>> ids;
  std::vector<std::string> names;
};
Animations animationsOf(const burnish::Scene& scene) {
  Animations all;
  scene.animations.each([&](burnish::Id<burnish::Animation> id, const burnish::Animation& animation) {
    all.ids.push_back(id);
    all.names.push_back(animation.name);
  });
  return all;
}

/// Moves the scene to --time. What does not play is said.
Result<void> playAnimations(LoadedScene& loaded, const SceneOptions& options) {
  if (!options.time) return {};
  const Animations all = animationsOf(loaded.scene);
  if (!options.animation.empty()) {
    std::optional<std::size_t> chosen;
    for (std::size_t i = all.ids.size(); i-- > 0;)
      if (all.names[i] == options.animation) chosen = i;
    if (const auto index = parseNumber(options.animation); !chosen && index && *index == std::floor(*index) && *index >= 0 && *index < double(all.ids.size())) chosen = std::size_t(*index);
    if (!chosen && all.ids.empty()) return fail(options.scene, fmt::format("has no animation '{}' (it has none at all)", options.animation), "leave --animation out");
    if (!chosen)
      return fail(options.scene, fmt::format("has no animation '{}'{}", options.animation, didYouMean(options.animation, all.names)),
                  fmt::format("choose one of: {}, or an index below {}", listed(all.names), all.ids.size()));
    burnish::animate(loaded.scene, all.ids[*chosen], *options.time);
    return {};
  }
  if (all.ids.empty()) loaded.report.warn("--time", "the scene has no animations: it changes nothing");
  const auto played = burnish::playedTogether(loaded.scene);
  std::vector<std::string> idle;
  for (std::size_t i = 0; i < all.ids.size(); ++i)
    if (std::find(played.begin(), played.end(), all.ids[i]) == played.end()) idle.push_back(all.names[i].empty() ? std::to_string(i) : shown(all.names[i]));
  if (!idle.empty()) loaded.report.warn("--time", fmt::format("not played, because an earlier animation moves the same things: {} (--animation picks one)", listed(idle)));
  burnish::animate(loaded.scene, *options.time);
  return {};
}

Result<void> chooseView(LoadedScene& loaded, const SceneOptions& options) {
  const Cameras cameras = camerasOf(loaded.scene);
  const float fov = float(options.fovDegrees.value_or(50) * M_PI / 180);
  if (options.eye) {
    loaded.view = burnish::lookAt(*options.eye, *options.target, options.up.value_or(glm::dvec3(0, 1, 0)), fov);
    loaded.cameraName = fmt::format("eye {:g},{:g},{:g}", options.eye->x, options.eye->y, options.eye->z);
    return {};
  }
  if (!options.camera.empty() || !cameras.ids.empty()) {
    std::size_t index = 0;
    if (!options.camera.empty()) {
      const auto found = findCamera(cameras, options.camera, options.scene);
      if (!found) return fail(found.error());
      index = *found;
    }
    loaded.view = burnish::viewOf(loaded.scene, *loaded.scene.cameras.get(cameras.ids[index]));
    loaded.cameraName = cameras.names[index].empty() ? fmt::format("camera {}", index) : "camera " + shown(cameras.names[index]);
  } else {
    loaded.view = burnish::framingView(loaded.scene, float(options.size.x) / float(options.size.y));
    loaded.cameraName = "a view of the whole scene";
  }
  if (options.fovDegrees) loaded.view.fovY = fov;
  return {};
}

}  // namespace

CLI::Option* addChoice(CLI::App& app, const std::string& flag, std::vector<std::string> names, std::function<void(std::size_t)> take,
                       const std::string& description) {
  const std::string help = fmt::format("{}: {}", description, listed(names));
  return app
      .add_option_function<std::string>(
          flag,
          [names = std::move(names), take = std::move(take), flag](const std::string& text) {
            const auto found = std::find(names.begin(), names.end(), text);
            if (found == names.end())
              throw CLI::ValidationError(flag, fmt::format("'{}' is not known{}; choose one of: {}", text, didYouMean(text, names), listed(names)));
            take(std::size_t(found - names.begin()));
          },
          help)
      ->type_name("NAME");
}

void SceneOptions::addTo(CLI::App& app, bool required) {
  addSceneTo(app, required);
  addViewTo(app);
}

void SceneOptions::addViewTo(CLI::App& app) {
  CLI::Option* byName = app.add_option("--camera", camera, "a camera of the scene; without one: the first, else a view of everything")->type_name("NAME|INDEX");
  CLI::Option* from = addParsed(app, "--eye", "X,Y,Z", "where the eye is, metres", eye, parseVector, "a position: give X,Y,Z");
  CLI::Option* to = addParsed(app, "--target", "X,Y,Z", "what it looks at", target, parseVector, "a position: give X,Y,Z");
  CLI::Option* head = addParsed(app, "--up", "X,Y,Z", "which way is up (0,1,0)", up, parseVector, "a direction: give X,Y,Z");
  from->needs(to)->excludes(byName);
  to->needs(from);
  head->needs(from);
  addParsed(
      app, "--fov", "DEG", "vertical field of view, degrees", fovDegrees,
      [](std::string_view text) {
        const auto value = parseNumber(text);
        return value && *value > 0 && *value < 180 ? value : std::nullopt;
      },
      "an angle above 0 and below 180 degrees");
  addParsed(app, "--size", "WxH", fmt::format("pixels ({}x{})", size.x, size.y), size, parseSize, "a size: give WxH, each 1 to 16384, for example 1280x720");
  app.add_option("--probes", probes, "a folder of probes that burnish bake wrote: they light the scene")->type_name("DIR");
  app.add_option_function<std::string>(
         "--exposure",
         [this](const std::string& text) {
           const auto ev = parseNumber(text);
           if (text != "auto" && (!ev || std::abs(*ev) > 60)) throw CLI::ValidationError("--exposure", fmt::format("'{}' is not an exposure: give EV100 or auto", text));
           development.exposureEv = text == "auto" ? std::nullopt : std::optional(float(*ev));
         },
         "EV100, or auto (the default): from this picture alone")
      ->type_name("EV|auto");
  addParsed(
      app, "--scale", "S", "pixels shaded along a side, over those of the picture, which is enlarged from them: 0.25 to 1", scale,
      [](std::string_view text) -> std::optional<float> {
        const auto value = parseNumber(text);
        return value && *value >= 0.25 && *value <= 1 ? std::optional(float(*value)) : std::nullopt;
      },
      "a scale from 0.25 to 1");
  addChoice(app, "--tonemap", texts(burnish::toneMapNames()), [this](std::size_t i) { development.toneMap = burnish::ToneMap(i), toneMapGiven = true; }, "how radiance becomes colour");
}

void SceneOptions::addSceneTo(CLI::App& app, bool required) {
  app.add_option("SCENE", scene, "a .gltf or .glb file, or the name of a sample")->required(required)->type_name("");
  CLI::Option* when = addParsed(app, "--time", "S", "plays the scene's animations to this time, seconds; each loops with its own length", time, parseNumber, "a time: give seconds");
  app.add_option("--animation", animation, "with --time: this one alone; without: in the file's order each that moves nothing an earlier one moves")->type_name("NAME|INDEX")->needs(when);
  app.add_option("--env", environment, "a lat-long picture (.hdr, .exr) that lights the scene")->type_name("FILE");
  app.add_option_function<std::string>("--quality", [this](const std::string& text) { takeQuality(text); },
                                       fmt::format("a preset of rungs ({}), or a file that burnish cost --budget wrote: a name with a slash or .json is a file", listed(texts(burnish::presetNames()))))
      ->type_name("FILE|PRESET");
  app.add_option_function<std::vector<std::string>>(
         "--set",
         [this](const std::vector<std::string>& texts) {
           burnish::Quality checked;
           for (const std::string& text : texts) {
             const std::size_t equals = text.find('=');
             if (equals == std::string::npos) throw CLI::ValidationError("--set", fmt::format("'{}' is not TERM=RUNG; 'burnish render --list-rungs' lists them", text));
             if (const auto set = burnish::setRung(checked, text.substr(0, equals), text.substr(equals + 1)); !set) {
               const auto& e = set.error();
               throw CLI::ValidationError("--set", fmt::format("{} {}{}: {}", e.place, e.what, didYouMeanRung(text.substr(0, equals), text.substr(equals + 1)), e.remedy));
             }
             sets.emplace_back(text.substr(0, equals), text.substr(equals + 1));
           }
         },
         "a rung of a term, over the preset or file; repeatable (burnish render --list-rungs)")
      ->type_name("TERM=RUNG")
      ->type_size(1)
      ->allow_extra_args(false)
      ->take_all();
  addChoice(app, "--backend", {"egl", "osmesa", "glfw"}, [this](std::size_t i) { backend = burnish::Backend(i); }, "where OpenGL comes from");
  addParsed(
      app, "--threads", "N", "at most N threads of the software renderer and N picture decoders", threads,
      [](std::string_view text) -> std::optional<int> {
        const auto value = parseNumber(text);
        return value && *value >= 1 && *value <= 1024 && *value == std::floor(*value) ? std::optional(int(*value)) : std::nullopt;
      },
      "a number of threads from 1 to 1024");
}

void SceneOptions::takeQuality(const std::string& text) {
  if (text.find('/') != std::string::npos || text.ends_with(".json")) {
    qualityFile = burnish::readQuality(text);
    preset = text;
    return;
  }
  const std::vector<std::string> names = texts(burnish::presetNames());
  if (std::find(names.begin(), names.end(), text) == names.end())
    throw CLI::ValidationError("--quality", fmt::format("'{}' is no preset{} and no .json file; choose one of: {}, or give a file (./{} if that is its name)", text, didYouMean(text, names), listed(names), text));
  preset = text;
  qualityFile.reset();
}

burnish::Quality SceneOptions::quality() const {
  burnish::Quality q = development;
  if (qualityFile && *qualityFile) {
    q = **qualityFile;
    q.exposureEv = development.exposureEv;
    if (toneMapGiven) q.toneMap = development.toneMap;
  } else {
    (void)burnish::setPreset(q, preset);  // names were checked when they were parsed
  }
  if (scale) q.resolutionScale = *scale;
  for (const auto& [term, rung] : sets) (void)burnish::setRung(q, term, rung);
  return q;
}

Result<LoadedScene> loadScene(const SceneOptions& options, Progress& progress) {
  if (options.qualityFile && !*options.qualityFile) return fail(options.qualityFile->error());
  const auto file = resolveScene(options.scene);
  if (!file) return fail(file.error());
  burnish::DecoderPoolOptions pool;
  if (options.threads > 0) pool.processes = options.threads;
  const std::unique_ptr<burnish::ImageDecoder> decoder = burnish::makeDecoderPool(pool);
  burnish::LoadOptions load;
  load.decoder = decoder.get();

  LoadedScene loaded;
  progress.stage("loading " + file->string());
  auto scene = burnish::loadScene(*file, load, loaded.report);
  if (!scene) return fail(scene.error());
  loaded.scene = std::move(*scene);
  if (!options.environment.empty()) {
    progress.stage("loading " + options.environment);
    if (auto done = burnish::loadEnvironment(loaded.scene, options.environment, load, loaded.report); !done) return fail(done.error());
  }
  if (!options.probes.empty()) {
    progress.stage("loading " + options.probes);
    auto probes = burnish::readProbes(options.probes, loaded.report);
    if (!probes) return fail(probes.error());
    loaded.scene.probes = std::move(*probes);
  }
  if (auto done = playAnimations(loaded, options); !done) return fail(done.error());
  if (auto done = chooseView(loaded, options); !done) return fail(done.error());
  return loaded;
}

Result<std::unique_ptr<burnish::Context>> openContext(const SceneOptions& options) {
  if (options.threads > 0) setenv("LP_NUM_THREADS", std::to_string(options.threads).c_str(), 1);
  burnish::ContextOptions context;
  context.backend = options.backend;
  context.visible = false;
  return burnish::Context::create(context);
}

std::vector<std::string> warningTexts(const burnish::Report& report) {
  std::vector<std::string> texts;
  for (const burnish::Warning& warning : report.warnings()) texts.push_back(warning.message());
  return texts;
}

}  // namespace cli
