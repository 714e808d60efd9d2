#include "gl/program.h"

#include <fmt/format.h>

#include <algorithm>

#include "gl/program_binary.h"

namespace burnish::gl {

struct ProgramCache::Entry {
  ProgramSource source;
  BinaryKey key;
  std::unique_ptr<Program> program;
};

/// A program on its way: texts resolved, shaders handed to the driver, nothing waited for yet.
struct ProgramCache::Job {
  struct Stage {
    GLenum type;
    std::string file;
    ShaderText text;
    GLuint shader = 0;
  };
  explicit Job(Device& d) : device(d) {}
  ~Job() {
    for (const Stage& s : stages)
      if (s.shader) device.gl.DeleteShader(s.shader);
  }
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  Device& device;
  ProgramSource source;
  std::vector<Stage> stages;
  BinaryKey key;
  Handle program;
  bool fromBinary = false;
};

namespace {

std::string memoryKey(const ProgramSource& s) {
  std::string key = s.vertex + '\n' + s.fragment + '\n' + s.compute;
  std::vector<std::string> defines = s.defines;
  std::sort(defines.begin(), defines.end());
  for (const std::string& d : defines) key += '\n' + d;
  return key;
}

std::string shaderLog(const GladGLContext& gl, GLuint shader) {
  GLint length = 0;
  gl.GetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(std::size_t(std::max(length, 0)), '\0');
  if (length > 0) gl.GetShaderInfoLog(shader, length, &length, log.data());
  log.resize(std::size_t(std::max(length, 0)));
  return log;
}

std::string programLog(const GladGLContext& gl, GLuint program) {
  GLint length = 0;
  gl.GetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::string log(std::size_t(std::max(length, 0)), '\0');
  if (length > 0) gl.GetProgramInfoLog(program, length, &length, log.data());
  log.resize(std::size_t(std::max(length, 0)));
  return log;
}

std::vector<std::pair<GLenum, std::string>> stagesOf(const ProgramSource& s) {
  std::vector<std::pair<GLenum, std::string>> stages = {
      {GL_VERTEX_SHADER, s.vertex}, {GL_FRAGMENT_SHADER, s.fragment}, {GL_COMPUTE_SHADER, s.compute}};
  std::erase_if(stages, [](const auto& stage) { return stage.second.empty(); });
  return stages;
}

std::string place(const ProgramSource& s) { return fmt::format("program \"{}\"", s.name); }

}  // namespace

ProgramCache::ProgramCache(Device& device, ShaderLibrary library, std::filesystem::path binaryFolder)
    : device_(device),
      library_(std::move(library)),
      folder_(device.caps.programBinary ? std::move(binaryFolder) : std::filesystem::path()) {}
ProgramCache::~ProgramCache() = default;

Result<std::unique_ptr<ProgramCache::Job>> ProgramCache::begin(const ProgramSource& source) {
  const GladGLContext& gl = device_.gl;
  auto job = std::make_unique<Job>(device_);
  job->source = source;
  std::sort(job->source.defines.begin(), job->source.defines.end());
  if (source.compute.empty() == source.vertex.empty())
    return fail(place(source), "neither a vertex nor a compute shader alone is given",
                "name a vertex shader (and a fragment shader), or one compute shader");
  BinaryKeyBuilder key(device_.caps);
  for (const auto& [type, file] : stagesOf(source)) {
    auto text = library_.resolve(file, job->source.defines);
    if (!text) return fail(Error{place(source) + ": " + text.error().place, text.error().what, text.error().remedy});
    key.add(type, text->text);
    job->stages.push_back({type, file, std::move(*text), 0});
  }
  job->key = key.finish();
  job->program = loadBinary(*job);
  job->fromBinary = bool(job->program);
  if (job->fromBinary) return job;

  const GLuint program = gl.CreateProgram();
  job->program = Handle(device_, Handle::Kind::Program, program);
  if (!folder_.empty()) gl.ProgramParameteri(program, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
  for (Job::Stage& stage : job->stages) {
    stage.shader = gl.CreateShader(stage.type);
    const char* text = stage.text.text.data();
    const auto length = GLint(stage.text.text.size());
    gl.ShaderSource(stage.shader, 1, &text, &length);
    gl.CompileShader(stage.shader);
    device_.label(GL_SHADER, stage.shader, stage.file);
    gl.AttachShader(program, stage.shader);
  }
  gl.LinkProgram(program);
  return job;
}

Result<Handle> ProgramCache::finish(Job& job) {
  const GladGLContext& gl = device_.gl;
  const GLuint program = job.program.id();
  if (job.fromBinary) {
    ++loaded_;
  } else {
    for (const Job::Stage& stage : job.stages) {
      GLint ok = 0;
      gl.GetShaderiv(stage.shader, GL_COMPILE_STATUS, &ok);
      if (!ok)
        return fail(place(job.source),
                    fmt::format("{} does not compile:\n{}", stage.file,
                                nameFiles(shaderLog(gl, stage.shader), stage.text.files)),
                    "correct the shader");
    }
    GLint linked = 0;
    gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
    if (!linked)
      return fail(place(job.source), fmt::format("does not link:\n{}", programLog(gl, program)),
                  "correct the interface between its shaders");
    for (const Job::Stage& stage : job.stages) gl.DetachShader(program, stage.shader);
    ++built_;
    saveBinary(job, program);
  }
  device_.label(GL_PROGRAM, program, job.source.name);
  return std::move(job.program);
}

Handle ProgramCache::loadBinary(const Job& job) {
  if (folder_.empty()) return {};
  const auto binary = readBinary(folder_, job.key);
  if (!binary) return {};
  // A format that the driver does not list is an error in GL; it can only come from another driver with the same name.
  const GladGLContext& gl = device_.gl;
  GLint count = 0;
  gl.GetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &count);
  std::vector<GLint> known(std::size_t(std::max(count, 0)));
  if (count > 0) gl.GetIntegerv(GL_PROGRAM_BINARY_FORMATS, known.data());
  if (std::find(known.begin(), known.end(), GLint(binary->format)) == known.end()) return {};
  Handle program(device_, Handle::Kind::Program, gl.CreateProgram());
  gl.ProgramBinary(program.id(), binary->format, binary->bytes.data(), GLsizei(binary->bytes.size()));
  GLint linked = 0;
  gl.GetProgramiv(program.id(), GL_LINK_STATUS, &linked);
  return linked ? std::move(program) : Handle();
}

void ProgramCache::saveBinary(const Job& job, GLuint program) const {
  if (folder_.empty()) return;
  const GladGLContext& gl = device_.gl;
  GLint size = 0;
  gl.GetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &size);
  if (size <= 0) return;
  ProgramBinary binary;
  binary.bytes.resize(std::size_t(size));
  GLsizei written = 0;
  gl.GetProgramBinary(program, size, &written, &binary.format, binary.bytes.data());
  binary.bytes.resize(std::size_t(std::max(written, 0)));
  if (!binary.bytes.empty()) writeBinary(folder_, job.key, binary);
}

Result<const Program*> ProgramCache::get(const ProgramSource& source) {
  const std::string key = memoryKey(source);
  if (const auto found = programs_.find(key); found != programs_.end()) return found->second->program.get();
  auto job = begin(source);
  if (!job) return fail(job.error());
  auto handle = finish(**job);
  if (!handle) return fail(handle.error());
  auto entry =
      std::make_unique<Entry>(Entry{source, (*job)->key, std::make_unique<Program>(std::move(*handle), source.name)});
  return programs_.emplace(key, std::move(entry)).first->second->program.get();
}

Result<int> ProgramCache::warmUp(std::span<const ProgramSource> sources) {
  std::map<std::string, std::unique_ptr<Job>> jobs;
  for (const ProgramSource& source : sources) {
    const std::string key = memoryKey(source);
    if (programs_.contains(key) || jobs.contains(key)) continue;
    auto job = begin(source);
    if (!job) return fail(job.error());
    jobs.emplace(key, std::move(*job));
  }
  for (auto& [key, job] : jobs) {
    auto handle = finish(*job);
    if (!handle) return fail(handle.error());
    programs_.emplace(
        key, std::make_unique<Entry>(
                 Entry{job->source, job->key, std::make_unique<Program>(std::move(*handle), job->source.name)}));
  }
  return int(jobs.size());
}

Result<int> ProgramCache::reload() {
  int changed = 0;
  for (auto& [key, entry] : programs_) {
    BinaryKeyBuilder now(device_.caps);
    std::vector<std::string> defines = entry->source.defines;
    std::sort(defines.begin(), defines.end());
    for (const auto& [type, file] : stagesOf(entry->source)) {
      auto text = library_.resolve(file, defines);
      if (!text) return fail(text.error());
      now.add(type, text->text);
    }
    if (now.finish() == entry->key) continue;
    auto job = begin(entry->source);
    if (!job) return fail(job.error());
    auto handle = finish(**job);
    if (!handle) return fail(handle.error());
    *entry->program = Program(std::move(*handle), entry->source.name);
    entry->key = (*job)->key;
    ++changed;
  }
  return changed;
}

}  // namespace burnish::gl
