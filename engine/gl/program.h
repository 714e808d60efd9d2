// Programs: compiled once for each set of files and definitions, kept as binaries between runs where the driver can.
#pragma once
#include <map>
#include <memory>

#include "gl/objects.h"
#include "gl/shader_source.h"

namespace burnish::gl {

/// What to build: vertex + fragment (fragment may be empty), or compute alone. `name` is for labels and errors.
struct ProgramSource {
  std::string name;
  std::string vertex, fragment, compute;  ///< shader files below shaders/
  std::vector<std::string> defines;       ///< "NAME value"; their order does not matter
};

/// A linked program. Uniform locations and bindings are explicit in the shaders.
class Program {
 public:
  Program(Handle handle, std::string name) : name_(std::move(name)), handle_(std::move(handle)) {}
  [[nodiscard]] GLuint id() const { return handle_.id(); }
  [[nodiscard]] const std::string& name() const { return name_; }
  void use() const { handle_.device().gl.UseProgram(handle_.id()); }

 private:
  std::string name_;
  Handle handle_;
};

/// The programs of one device. Pointers that get() returns stay valid until the cache is destroyed (reload() swaps what
/// they point to).
class ProgramCache {
 public:
  /// binaryFolder: where binaries are kept; made when missing; empty: none. A folder that cannot be written or a
  /// damaged file costs a compilation, never an error.
  ProgramCache(Device& device, ShaderLibrary library, std::filesystem::path binaryFolder = {});
  ~ProgramCache();
  /// From memory, else from the binary folder, else compiled. Errors name program, file and line.
  Result<const Program*> get(const ProgramSource& source);
  /// Makes all ready; all compilations are begun before the first is waited for. Returns how many were not in memory.
  Result<int> warmUp(std::span<const ProgramSource> sources);
  /// Builds anew every program whose text has changed since (override folder). On an error the old program stays.
  /// Returns how many changed.
  Result<int> reload();
  [[nodiscard]] int built() const { return built_; }    ///< compiled from text so far
  [[nodiscard]] int loaded() const { return loaded_; }  ///< taken from binaries so far

 private:
  struct Entry;
  struct Job;
  Result<std::unique_ptr<Job>> begin(const ProgramSource& source);
  Result<Handle> finish(Job& job);
  Handle loadBinary(const Job& job);
  void saveBinary(const Job& job, GLuint program) const;

  Device& device_;
  ShaderLibrary library_;
  std::filesystem::path folder_;
  std::map<std::string, std::unique_ptr<Entry>, std::less<>> programs_;
  int built_ = 0, loaded_ = 0;
};

}  // namespace burnish::gl
