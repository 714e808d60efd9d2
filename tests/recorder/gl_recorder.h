// Records what a program asks of OpenGL: wraps getProcAddress, so that every function that is loaded through it is a shim that writes down its name and arguments, calls the
// driver's and tells the ledger (gl_ledger.h). The shims are generated from glad's header.
#pragma once
#include <array>
#include <bit>
#include <concepts>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recorder/gl_ledger.h"

namespace burnish::test {

/// One call. Arguments are values; of a pointer it counts whether there is one, except where the ledger notes what it points to (names that are bound, labels, clear values).
struct Call {
  Function function;
  std::uint16_t group;      ///< index into Recording::groups
  std::uint32_t first;      ///< of its arguments in Recording::arguments
  std::uint32_t count = 0;
};

/// A sequence of calls, comparable.
struct Recording {
  std::vector<Call> calls;
  std::vector<std::uint64_t> arguments;
  std::vector<std::string> groups;  ///< debug groups from the outermost in, joined by '/'; "" outside of all
  /// "BindTextureUnit(3, 17)  [lighting]"
  [[nodiscard]] std::string text(std::size_t call) const;
  [[nodiscard]] const std::string& groupOf(const Call& call) const { return groups[call.group]; }
  [[nodiscard]] std::size_t count(Function function) const;
  [[nodiscard]] std::size_t countIn(std::string_view group) const;
};
/// The first call that differs in function, arguments or group, with its neighbours; nullopt where the sequences are the same.
std::optional<std::string> difference(const Recording& a, const Recording& b);

class Recorder {
 public:
  /// Becomes the active recorder of this thread. Its functions are valid while it lives, on this thread, while it is the active one.
  explicit Recorder(ProcAddress real);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  void activate() { active_ = this; }
  [[nodiscard]] static Recorder& active();
  /// For Renderer::create and the like; nullptr for functions that the driver lacks or glad does not know.
  [[nodiscard]] ProcAddress procAddress();
  /// A shim by its type: recorder.shim<PFNGLCLEARPROC>(Function::Clear)(mask).
  template <class Pointer>
  [[nodiscard]] Pointer shim(Function f) {
    resolve(f);
    return reinterpret_cast<Pointer>(kShims[std::size_t(f)]);
  }

  /// The calls since the last take() (or since the recorder was made).
  [[nodiscard]] Recording take();
  [[nodiscard]] std::size_t recordedCalls() const { return recording_.calls.size(); }
  /// Off: calls are counted by the ledger, not kept (long runs).
  void keepCalls(bool keep) { keep_ = keep; }
  [[nodiscard]] Ledger& ledger() { return ledger_; }
  [[nodiscard]] const Ledger& ledger() const { return ledger_; }
  /// Called after each call; the GL calls that it makes through the shims are recorded too, without calling it again. For planting faults.
  void after(std::function<void(Function)> injection) { injection_ = std::move(injection); }

  // For the shims.
  template <class... Arguments>
  void record(Function f, Arguments... arguments) {
    ledger_.beginCall(std::size_t(f));
    if (!keep_) return;
    recording_.calls.push_back({f, std::uint16_t(ledger_.group()), std::uint32_t(recording_.arguments.size())});
    (recording_.arguments.push_back(value(arguments)), ...);
    recording_.calls.back().count = sizeof...(arguments);
  }
  void recorded(Function f);
  [[nodiscard]] void* real(Function f) const { return real_[std::size_t(f)]; }

 private:
  template <class T>
  static std::uint64_t value(T v) {
    if constexpr (std::is_pointer_v<T>)
      return v != nullptr;
    else if constexpr (std::is_same_v<T, float>)
      return std::bit_cast<std::uint32_t>(v);
    else if constexpr (std::is_same_v<T, double>)
      return std::bit_cast<std::uint64_t>(v);
    else
      return std::uint64_t(std::int64_t(v));
  }
  void* resolve(Function f);

  static thread_local Recorder* active_;
  ProcAddress getReal_;
  std::array<void*, kFunctions> real_{};
  Recording recording_;
  Ledger ledger_;
  bool keep_ = true, injecting_ = false;
  std::function<void(Function)> injection_;
};

}  // namespace burnish::test
