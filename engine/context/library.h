// Shared libraries opened by name at run time, so that a machine without one gets a clear error in place of a program
// that does not start.
#pragma once
#include <burnish/result.h>

#include <span>

namespace burnish::context {

/// An opened library. It is never closed: GL drivers leave threads and exit handlers behind, and closing one under them
/// crashes.
class Library {
 public:
  /// Tries the names in order, with local symbols. `package`: what to install, for the error.
  static Result<Library> open(std::span<const char* const> names, std::string_view package);
  [[nodiscard]] void* symbol(const char* name) const;
  template <class F>
  [[nodiscard]] F function(const char* name) const {
    return reinterpret_cast<F>(symbol(name));
  }

 private:
  explicit Library(void* handle) : handle_(handle) {}
  void* handle_;
};

}  // namespace burnish::context
