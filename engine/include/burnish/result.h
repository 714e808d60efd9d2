// Errors, results and warnings: how every call of the engine says what went wrong.
// The engine never throws across its API, never calls exit() and never prints: an error is a value that names the place, the fault and the remedy.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#if defined(BURNISH_BUILDING)
#define BURNISH_API __attribute__((visibility("default")))
#else
#define BURNISH_API
#endif

namespace burnish {

/// What went wrong. All three texts are for people; `place` is a file, a JSON path, a resource's name or a call.
struct Error {
  std::string place;   ///< Where: "scene.gltf: /meshes/0/primitives/1", "EGL", "view 2".
  std::string what;    ///< What is wrong, with the value found: "indices accessor 7 is out of range (5 accessors)".
  std::string remedy;  ///< What to do about it; may be empty only when nothing can be done.

  /// "place: what: remedy", the order that the command line prints after "burnish: ".
  [[nodiscard]] std::string message() const {
    std::string text = place;
    for (const std::string* part : {&what, &remedy})
      if (!part->empty()) text += (text.empty() ? "" : ": ") + *part;
    return text;
  }
};

/// A value or an Error. `if (!r) return fail(r.error());`
template <class T>
using Result = tl::expected<T, Error>;

/// Makes the error side of any Result<T>.
[[nodiscard]] inline tl::unexpected<Error> fail(Error e) { return tl::unexpected<Error>(std::move(e)); }
[[nodiscard]] inline tl::unexpected<Error> fail(std::string place, std::string what, std::string remedy = {}) {
  return tl::unexpected<Error>(Error{std::move(place), std::move(what), std::move(remedy)});
}

/// Something that the engine mended, approximated or left out; nothing is dropped in silence.
struct Warning {
  std::string place;
  std::string what;
  [[nodiscard]] std::string message() const { return place.empty() ? what : place + ": " + what; }
};

/// Collects warnings in order of arrival; the same text from the same place is kept once.
class Report {
 public:
  void warn(std::string place, std::string what) {
    for (const Warning& w : warnings_)
      if (w.place == place && w.what == what) return;
    warnings_.push_back({std::move(place), std::move(what)});
  }
  [[nodiscard]] const std::vector<Warning>& warnings() const { return warnings_; }
  [[nodiscard]] bool empty() const { return warnings_.empty(); }

 private:
  std::vector<Warning> warnings_;
};

enum class LogLevel { Debug, Info, Warning, Error };
/// Where the engine's log goes; called on the thread that renders or loads. Empty: nothing is logged.
using LogSink = std::function<void(LogLevel, std::string_view)>;

}  // namespace burnish
