// The account of a frame: each thing that was made, bound, cleared, drawn, written or waited for belongs to something in the plan.
//
// Objects: textures, buffers, framebuffers, vertex arrays, samplers, queries and programs are the plan's targets and programs, or stand for a table or target that some pass reads or
//   writes (tableOf). A target's bytes are the plan's figure.
// Work: draws, clears, dispatches, blits and read-backs happen inside a pass of the plan, write what it writes and sample what it reads.
// Bindings: what is bound (framebuffer, program, vertex array and its buffers, indexed buffer, texture) or set (uniform) is used by a draw, dispatch or clear before it is replaced.
// Waiting and asking: only in the passes that kMayAsk lists.
// A steady frame makes, frees and uploads nothing but its streams, each once.
#include "zero_cost/account.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "gl/objects.h"

namespace burnish::test {
namespace {

/// The plan's name for what an object stands for. Labels that are not here are names of targets and tables themselves, or textures of the scene.
struct TableRow {
  std::string_view prefix;  ///< of the label
  std::string_view table;   ///< as passes read or write it
};
constexpr TableRow kTables[] = {
    {"environment picture", "environment"},
    {"tiles", "light lists"},
    {"ambient lattice, ", "ambient lattice"},
    {"lattice data", "ambient lattice"},
    {"mesh ", "meshes"},
    {"draw data", "meshes"},
    {"vertices", "meshes"},
    {"materials", "materials"},
    {"material sampler", "materials"},
    {"default ", "materials"},
    {"poses", "deformed vertices"},
    {"deformation of mesh ", "deformed vertices"},
    {"deformed ", "deformed vertices"},
    {"picture behind glass", "scene_color"},
    {"transparent layer", "peel_a"},
    {"host depth", "host depth"},
    {"shadow_maps layer ", "shadow_maps"},
    {"shadow data", "shadow_maps"},
    {"shadows, ", "shadow_maps"},
    {"casters", "shadow_maps"},
};
/// Written anew in every frame, at most once a view.
constexpr std::string_view kStreams[] = {"frame data", "draw data", "lights", "light lists", "tiles", "shadow data", "probe records", "tiles, probes", "lattice data"};
/// Calls that wait for the GPU or ask it, and where a plan says that they may be.
struct AskRow {
  std::string_view pass, call;
};
constexpr AskRow kMayAsk[] = {
    {"tiles", "GetTextureSubImage"}, {"nonfinite_count", "GetTextureSubImage"}, {"transparent", "BeginQuery"}, {"transparent", "EndQuery"}, {"transparent", "GetQueryObject"}, {"deform", "MemoryBarrier"},
};
/// What a pass may clear, as the plan names it: what is drawn over everywhere needs no clear, what is not needs one.
struct ClearRow {
  std::string_view pass, table, effect = {};  ///< only while this one is on
};
constexpr ClearRow kMayClear[] = {
    {"gbuffer", "depth"}, {"gbuffer", "gbuffer_b", "host_depth_in"}, {"gbuffer", "gbuffer_d"}, {"forward", "light"}, {"forward", "depth"}, {"light_clear", "light"}, {"shadow_maps", "shadow_maps"},
    {"transparent", "peel_a"}, {"transparent", "peel_b"}, {"motion_vectors", "velocity"},
};
constexpr std::string_view kAsking[] = {"Get", "Is", "Finish", "Flush", "FenceSync", "ClientWait", "WaitSync", "BeginQuery", "EndQuery", "QueryCounter", "Read", "Map", "MemoryBarrier", "TextureBarrier", "Invalidate"};

bool lists(const std::vector<std::string>& names, std::string_view name) { return std::find(names.begin(), names.end(), name) != names.end(); }

class Account {
 public:
  Account(const FramePlan& plan, const Scene& scene, const Recording& frame, const Ledger& ledger, bool steady) : plan_(plan), frame_(frame), ledger_(ledger), steady_(steady) {
    for (const PassPlan& p : plan.passes) {
      tables_.insert(p.reads.begin(), p.reads.end());
      tables_.insert(p.writes.begin(), p.writes.end());
    }
    scene.textures.each([&](Id<Texture>, const Texture& t) { sceneTextures_.insert(t.name); });
  }
  std::vector<std::string> take() {
    for (const auto& [key, object] : ledger_.alive()) judgeObject(object);
    for (const TargetPlan& t : plan_.targets) judgeTarget(t);
    for (const Work& w : ledger_.work()) judgeWork(w);
    judgeTextureBindings();
    judgeCalls();
    return std::move(strays_);
  }

 private:
  void stray(std::string text) {
    if (strays_.size() < 40) strays_.push_back(std::move(text));
  }
  [[nodiscard]] std::string_view tableOf(const std::string& label) const {
    if (plan_.target(label) || tables_.count(label)) return label;
    for (const TableRow& row : kTables)
      if (label.starts_with(row.prefix)) return row.table;
    return sceneTextures_.count(label) ? "materials" : std::string_view(label);
  }
  [[nodiscard]] bool planned(std::string_view table) const { return tables_.count(std::string(table)) > 0 || plan_.target(table) != nullptr; }

  // Framebuffers are labelled by their attachments: "depth|gbuffer_a|gbuffer_b", "bloom level 2".
  [[nodiscard]] bool plannedFramebuffer(const std::string& label) const {
    for (std::size_t at = 0; at <= label.size();) {
      const std::size_t end = std::min(label.find('|', at), label.size());
      const std::string part = label.substr(at, end - at), name = part.substr(0, part.find(" level "));
      if (!name.empty() && !planned(tableOf(name))) return false;
      at = end + 1;
    }
    return true;
  }
  [[nodiscard]] bool plannedObject(const GlObject& o) const {
    switch (o.kind) {
      case ObjectKind::Program: return std::any_of(plan_.programs.begin(), plan_.programs.end(), [&](const ProgramPlan& p) { return p.name == o.label; });
      case ObjectKind::Framebuffer: return !o.label.empty() && plannedFramebuffer(o.label);
      case ObjectKind::VertexArray:
        if (o.label == "no vertices") return std::any_of(plan_.programs.begin(), plan_.programs.end(), [](const ProgramPlan& p) { return p.vertex == "post/screen.vert"; });
        break;
      case ObjectKind::Buffer:
        if (o.label == "frame data") return true;
        break;
      default: break;
    }
    const bool named = !o.label.empty() || (o.kind == ObjectKind::Texture && sceneTextures_.count(""));
    return named && planned(tableOf(o.label));
  }
  void judgeObject(const GlObject& o) {
    if (!plannedObject(o)) stray(fmt::format("{} '{}' ({} bytes, made in '{}') is nothing that the plan lists", kindName(o.kind), o.label, o.bytes, o.group));
  }
  void judgeTarget(const TargetPlan& t) {
    std::size_t count = 0;
    std::int64_t bytes = 0;
    for (const auto& [key, o] : ledger_.alive())
      if (o.kind == ObjectKind::Texture && o.label == t.name) ++count, bytes += o.bytes;
    if (count != 1 || bytes != std::int64_t(t.bytes)) stray(fmt::format("target '{}': {} textures with {} bytes; the plan says {} bytes", t.name, count, bytes, t.bytes));
  }

  [[nodiscard]] std::string nameOf(const Touched& t) const {
    const GlObject* o = ledger_.find(t.kind, t.id);
    if (o) return std::string(tableOf(o->label));
    return t.kind == ObjectKind::Framebuffer ? "target" : "host depth";
  }
  void judgeWork(const Work& w) {
    if (w.kind == Work::Kind::Upload) return judgeUpload(w);
    const PassPlan* pass = plan_.pass(w.group);
    if (!pass) return stray(fmt::format("{} ({}) outside of the plan's passes, in '{}'", workName(w.kind), kFunctionNames[std::size_t(w.function)], w.group));
    for (const Touched& t : w.writes) {
      const std::string name = nameOf(t);
      // A depth buffer that is only tested against is attached all the same.
      const bool tested = w.kind == Work::Kind::Draw && lists(pass->reads, name);
      if (!lists(pass->writes, name) && !tested) stray(fmt::format("{} ({}) in '{}' writes '{}', which the plan does not say", workName(w.kind), kFunctionNames[std::size_t(w.function)], w.group, name));
      if (w.kind == Work::Kind::Clear) judgeClear(w, t, name);
    }
    for (const Touched& t : w.reads) {
      const std::string name = nameOf(t);
      if (!lists(pass->reads, name) && !lists(pass->writes, name)) stray(fmt::format("{} in '{}' samples '{}', which the plan does not say", workName(w.kind), w.group, name));
    }
  }
  // Peeling clears its layers' depth once for each layer that it finds; everything else is cleared once.
  void judgeClear(const Work& w, const Touched& t, const std::string& name) {
    const bool may = std::any_of(std::begin(kMayClear), std::end(kMayClear), [&](const ClearRow& row) { return w.group == row.pass && name == row.table && (row.effect.empty() || plan_.on(row.effect)); });
    if (!may) return stray(fmt::format("'{}' is cleared in '{}', which draws all of it or none", name, w.group));
    if (++clears_[{w.framebuffer, t.id}] > 1 && w.group != "transparent") stray(fmt::format("'{}' is cleared {} times in '{}'", name, clears_[{w.framebuffer, t.id}], w.group));
  }
  void judgeUpload(const Work& w) {
    if (!steady_) return;
    const Touched& t = w.writes.front();
    const GlObject* o = ledger_.find(t.kind, t.id);
    const std::string label = o ? o->label : "?";
    const bool stream = t.kind == ObjectKind::Buffer && std::find(std::begin(kStreams), std::end(kStreams), label) != std::end(kStreams);
    if (!stream) return stray(fmt::format("upload to {} '{}' in '{}' of a frame in which nothing changed", kindName(t.kind), label, w.group));
    if (++uploads_[t.id] > 1) stray(fmt::format("'{}' is uploaded {} times, in '{}'", label, uploads_[t.id], w.group));
  }

  void judgeTextureBindings() {
    std::map<std::uint64_t, bool> batches;  // by call: whether anything of it was used
    for (const TextureBinding& b : ledger_.bindings()) {
      if (b.batch)
        batches[b.call] |= b.used;
      else if (!b.used) {
        const GlObject* o = ledger_.find(ObjectKind::Texture, b.texture);
        stray(fmt::format("texture '{}' bound to unit {} in '{}' and sampled by nothing", o ? o->label : "?", b.unit, b.group));
      }
    }
    for (const auto& [call, used] : batches)
      if (!used) stray(fmt::format("a batch of textures bound (call {}) of which nothing is sampled", call));
  }

  // ---- the sequence of calls ----

  using Slot = std::tuple<std::string_view, std::uint64_t, std::uint64_t>;
  void set(Slot slot, std::size_t call) {
    if (const auto found = pending_.find(slot); found != pending_.end()) stray(fmt::format("call {} has no use: {}", found->second, frame_.text(found->second)));
    pending_[slot] = call;
  }
  void unset(Slot slot) {
    if (const auto found = pending_.find(slot); found != pending_.end()) {
      stray(fmt::format("call {} has no use: {}", found->second, frame_.text(found->second)));
      pending_.erase(found);
    }
  }
  void bind(Slot slot, std::uint64_t id, std::size_t call) { id ? set(slot, call) : unset(slot); }
  template <class Wanted>
  void use(Wanted&& wanted) {
    std::erase_if(pending_, [&](const auto& row) { return wanted(row.first); });
  }
  void drawn(bool vertices) {
    use([&](const Slot& s) {
      const auto& [what, a, b] = s;
      return what == "program" || what == "buffer" || (what == "uniform" && a == program_) || (vertices && (what == "framebuffer" || what == "vertex array" || (what == "vertices" && a == array_)));
    });
  }
  void judgeCalls() {
    for (std::size_t i = 0; i < frame_.calls.size(); ++i) judgeCall(i);
    for (const auto& [slot, call] : pending_) stray(fmt::format("call {} has no use: {}", call, frame_.text(call)));
  }
  void judgeCall(std::size_t i) {
    const Call& c = frame_.calls[i];
    const std::string_view name = kFunctionNames[std::size_t(c.function)];
    const auto argument = [&](std::size_t k) { return frame_.arguments[c.first + k]; };
    if (frame_.groupOf(c) == "host_draw") return;  // what is bound there is for the host, whose calls are not recorded
    switch (c.function) {
      case Function::BindFramebuffer: return bind({"framebuffer", argument(0) == GL_READ_FRAMEBUFFER, 0}, argument(1), i);
      case Function::UseProgram: program_ = argument(0); return bind({"program", 0, 0}, program_, i);
      case Function::BindVertexArray: array_ = argument(0); return bind({"vertex array", 0, 0}, array_, i);
      case Function::VertexArrayVertexBuffer: return bind({"vertices", argument(0), argument(1)}, argument(2), i);
      case Function::VertexArrayElementBuffer: return bind({"vertices", argument(0), ~0ull}, argument(1), i);
      case Function::BindBufferBase: case Function::BindBufferRange: return bind({"buffer", argument(0), argument(1)}, argument(2), i);
      case Function::BindBuffersBase:
        for (std::uint64_t k = 0; k < argument(2); ++k) unset({"buffer", argument(0), argument(1) + k});
        return;
      case Function::Clear: case Function::ClearBufferfv: case Function::ClearBufferiv: case Function::ClearBufferuiv: case Function::ClearBufferfi:
        return use([](const Slot& s) { return std::get<0>(s) == "framebuffer"; });
      default: break;
    }
    if (name.starts_with("Draw") || name.starts_with("MultiDraw")) return drawn(true);
    if (name.starts_with("Dispatch")) return drawn(false);
    if (name.starts_with("ProgramUniform")) return set({"uniform", argument(0), argument(1)}, i);
    if (name.starts_with("Uniform") && !name.starts_with("UniformBlock")) return set({"uniform", program_, argument(0)}, i);
    judgeOther(i, name);
  }
  void judgeOther(std::size_t i, std::string_view name) {
    const std::string& group = frame_.groupOf(frame_.calls[i]);
    const bool makes = name.starts_with("Create") || name.starts_with("Delete") || (name.starts_with("Gen") && !name.starts_with("Generate"));
    // The host's depth texture is attached anew in each frame: it may be another one each time.
    if (steady_ && makes && group != "depth_out") return stray(fmt::format("call {} in a frame in which nothing changed: {}", i, frame_.text(i)));
    const bool asks = std::any_of(std::begin(kAsking), std::end(kAsking), [&](std::string_view prefix) { return name.starts_with(prefix); });
    const bool waits = name == "Finish" || name == "Flush";
    if (!asks || !(steady_ || waits)) return;
    const bool may = std::any_of(std::begin(kMayAsk), std::end(kMayAsk), [&](const AskRow& row) { return group == row.pass && name.starts_with(row.call); });
    if (!may && !(group == "depth_out" && name == "GetError")) stray(fmt::format("call {} waits or asks: {}", i, frame_.text(i)));
  }

  const FramePlan& plan_;
  const Recording& frame_;
  const Ledger& ledger_;
  bool steady_;
  std::set<std::string> tables_, sceneTextures_;
  std::vector<std::string> strays_;
  std::map<GLuint, int> uploads_;
  std::map<std::pair<GLuint, GLuint>, int> clears_;  // by framebuffer and texture
  std::map<Slot, std::size_t> pending_;
  std::uint64_t program_ = 0, array_ = 0;
};

/// What the host brings to a frame, made outside of the recorder.
struct Host {
  std::unique_ptr<Context> context = openContext({.backend = testBackend()});
  std::unique_ptr<OffscreenTarget> target;
  std::unique_ptr<gl::Device> device = openDevice(*context);
  gl::Texture depths[2];

  explicit Host(const Subject& s) {
    auto made = OffscreenTarget::create(context->procAddress(), s.size, s.output);
    REQUIRE(made);
    target = std::move(*made);
    for (gl::Texture& depth : depths) {
      auto texture = gl::Texture::create(*device, {.format = GL_DEPTH_COMPONENT32F, .width = s.size.x, .height = s.size.y}, "host depth");
      REQUIRE(texture);
      depth = std::move(*texture);
      const std::vector<float> far(std::size_t(s.size.x) * std::size_t(s.size.y), 1.0f);
      depth.upload(0, far.data());
    }
  }
  [[nodiscard]] Target targetFor(const Subject& s) const {
    Target t = target->target();
    if (s.hostDepthIn) t.depthIn = HostDepth{.texture = depths[0].id()};
    if (s.hostDepthOut) t.depthOut = HostDepth{.texture = depths[1].id()};
    return t;
  }
};

std::vector<std::string> namesOf(const std::vector<PassPlan>& passes) {
  std::vector<std::string> list;
  for (const PassPlan& p : passes) list.push_back(fmt::format("{}: {} -> {} by {}", p.name, fmt::join(p.reads, ", "), fmt::join(p.writes, ", "), fmt::join(p.programs, ", ")));
  return list;
}

std::optional<std::string> firstOther(std::string_view what, const std::vector<std::string>& a, const std::vector<std::string>& b) {
  if (a == b) return std::nullopt;
  const auto [x, y] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  return fmt::format("{}: {} against {}; the first that differs: '{}' against '{}'", what, a.size(), b.size(), x == a.end() ? "-" : *x, y == b.end() ? "-" : *y);
}

}  // namespace

std::vector<std::string> strays(const FramePlan& plan, const Scene& scene, const Recording& frame, const Ledger& ledger, bool steady) { return Account(plan, scene, frame, ledger, steady).take(); }

Observation observe(const Subject& s, const ObserveOptions& options) {
  Host host(s);
  Recorder recorder(host.context->procAddress());
  Ledger& ledger = recorder.ledger();
  RendererOptions o;
  o.removedEffects = options.removed;
  o.forcedEffects = options.forced;
  auto renderer = Renderer::create(recorder.procAddress(), o);
  if (!renderer) FAIL(renderer.error().message());
  RenderRequest request;
  request.output = s.output;
  request.debugView = s.debugView;
  request.countNonfinite = s.countNonfinite;
  if (s.hostDraw) request.hostDraw = [](const HostDraw&) {};
  Observation seen;
  // The subject is as it was when this is over. Its scene is the renderer's by identity: a copy would be another one.
  Node* moving = nullptr;
  glm::dmat4 standing(1);
  for (const bool second : {false, true}) {
    const bool steady = second && !s.moves;
    if (second && s.moves) {
      Scene& scene = const_cast<Scene&>(s.scene);
      const Instance* instance = scene.instances.get(scene.instances.at(1));
      moving = instance ? scene.nodes.edit(instance->node) : nullptr;
      REQUIRE(moving);
      standing = moving->local;
      moving->local[3].x += 0.05;
    }
    ledger.forgetWork();
    const std::int64_t before = ledger.bytes();
    if (steady && options.plant) recorder.after([&](Function f) { options.plant(recorder, f); });
    const auto stats = (*renderer)->render(s.scene, {&s.view, 1}, host.targetFor(s), s.quality, request);
    recorder.after({});
    if (!stats) FAIL(s.name << ": " << stats.error().message());
    seen.plan = (*renderer)->lastPlan();
    Recording& frame = second ? seen.second : seen.first;
    frame = recorder.take();
    // A frame that is sampled elsewhere than the one before may reach into other tiles: their lists may grow.
    const bool same = steady && !seen.plan.on("temporal_antialiasing");
    for (std::string& text : strays(seen.plan, s.scene, frame, ledger, same)) seen.strays.push_back(fmt::format("{} frame: {}", second ? "second" : "first", text));
    if (same && ledger.bytes() != before) seen.strays.push_back(fmt::format("the second frame takes {} bytes more", ledger.bytes() - before));
    if (ledger.bytes(ObjectKind::Texture) != std::int64_t(stats->textureBytes)) seen.strays.push_back(fmt::format("{} bytes of textures; the statistics say {}", ledger.bytes(ObjectKind::Texture), stats->textureBytes));
  }
  if (moving) moving->local = standing;
  seen.objects = ledger.inventory();
  seen.bytes = ledger.bytes();
  for (const std::string& name : ledger.unmodelled) seen.strays.push_back("nobody keeps account of gl" + name);
  auto image = host.target->read();
  REQUIRE(image);
  seen.picture = std::move(*image);
  renderer->reset();
  for (const std::string& left : ledger.inventory()) seen.strays.push_back("left behind: " + left);
  if (ledger.strangeDeletions() > 0) seen.strays.push_back(fmt::format("{} deletions of what was not there", ledger.strangeDeletions()));
  if (ledger.groupDepth() != 0 || ledger.unbalancedPops() != 0) seen.strays.push_back("debug groups are not balanced");
  return seen;
}

std::optional<std::string> difference(const Observation& a, const Observation& b) {
  if (auto d = firstOther("passes", namesOf(a.plan.passes), namesOf(b.plan.passes))) return d;
  if (a.plan.programs != b.plan.programs) return "the programs of the plans differ";
  if (a.plan.targets != b.plan.targets) return "the targets of the plans differ";
  if (auto d = firstOther("objects", a.objects, b.objects)) return d;
  if (a.bytes != b.bytes) return fmt::format("{} bytes against {}", a.bytes, b.bytes);
  if (auto d = difference(a.first, b.first)) return "first frame: " + *d;
  if (auto d = difference(a.second, b.second)) return "second frame: " + *d;
  return std::nullopt;
}

}  // namespace burnish::test
