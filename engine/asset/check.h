// Typed, checked access to the JSON of a glTF file. The first fault is kept, with the JSON path of the value at fault;
// from then on reads give defaults and loops end, so that the parsing code reads like the specification and carries no
// error handling of its own.
#pragma once
#include <array>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "asset/json_text.h"

namespace burnish::asset {

/// A JSON value and the way to it. Parents must outlive their children (all of them live on the stack of the function
/// that walks).
class At {
 public:
  explicit At(const Json& root) : value_(&root) {}
  At(const At& parent, std::string_view key, const Json& value) : value_(&value), parent_(&parent), key_(key) {}
  At(const At& parent, std::size_t index, const Json& value) : value_(&value), parent_(&parent), index_(index) {}
  At(const At&&, std::string_view, const Json&) = delete;
  At(const At&&, std::size_t, const Json&) = delete;
  const Json& operator*() const { return *value_; }
  const Json* operator->() const { return value_; }
  /// The JSON pointer (RFC 6901): "/meshes/0/primitives/1", "/" for the root.
  [[nodiscard]] std::string path() const;

 private:
  const Json* value_;
  const At* parent_ = nullptr;
  std::string_view key_;
  std::size_t index_ = std::numeric_limits<std::size_t>::max();
};

struct Range {
  double min = -std::numeric_limits<float>::max();
  double max = std::numeric_limits<float>::max();
  bool aboveMin = false;  ///< min itself is outside
};
inline constexpr Range kUnit{0, 1};
inline constexpr Range kNotNegative{0};
inline constexpr Range kPositive{0, std::numeric_limits<float>::max(), true};

enum class Need : bool { Optional, Required };

/// The arrays that references point into.
enum class Table : std::uint8_t {
  Accessors,
  Buffers,
  BufferViews,
  Cameras,
  Images,
  Materials,
  Meshes,
  Nodes,
  Samplers,
  Scenes,
  Skins,
  Textures,
  Lights,
  Count
};

class Check {
 public:
  Check(std::string file, Report& report) : file_(std::move(file)), report_(report) {}
  ~Check();  ///< hands the collected warnings to the report
  Check(const Check&) = delete;
  Check& operator=(const Check&) = delete;

  [[nodiscard]] bool ok() const { return !error_; }
  [[nodiscard]] const Error& error() const { return *error_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  void fail(std::string path, std::string what, std::string remedy = "correct or re-export the file");
  void fail(const At& at, std::string what, std::string remedy = "correct or re-export the file") {
    if (ok()) fail(at.path(), std::move(what), std::move(remedy));
  }
  /// For errors that already name their place.
  void fail(Error e) {
    if (ok()) error_ = std::move(e);
  }
  /// Same texts are one warning that names the first place and counts the others: a file decides how many faults it
  /// has, not how long the report is.
  void warn(const std::string& path, const std::string& what);

  // Reads of members of an object. A missing required member, a wrong type or a value out of range is a fault.
  const Json* member(const At& object, const char* key, Need need = Need::Optional);
  const Json* object(const At& object, const char* key, Need need = Need::Optional);
  const Json* array(const At& object, const char* key, Need need = Need::Optional);  ///< not empty
  double number(const At& object, const char* key, double fallback, const Range& range = {},
                Need need = Need::Optional);
  std::uint64_t integer(const At& object, const char* key, std::uint64_t fallback, std::uint64_t min = 0,
                        std::uint64_t max = kMaxInteger, Need need = Need::Optional);
  bool boolean(const At& object, const char* key, bool fallback);
  const std::string* string(const At& object, const char* key, Need need = Need::Optional);
  int reference(const At& object, const char* key, Table table, Need need = Need::Optional);  ///< -1 when absent
  std::vector<int> references(const At& object, const char* key, Table table,
                              Need need = Need::Optional);  ///< no element twice
  bool numbers(const At& object, const char* key, std::span<double> out,
               const Range& range = {});  ///< false when absent; exact length
  std::vector<double> numberList(const At& object, const char* key, std::size_t length);  ///< length 0: any

  double numberValue(const At& value, const Range& range);
  std::uint64_t integerValue(const At& value, std::uint64_t min, std::uint64_t max);
  int referenceValue(const At& value, Table table);

  /// Whether the value is an object whose name and extensions are sound.
  bool enter(const At& object);
  /// f(At, index) for each element of an array of objects.
  template <class F>
  void eachObject(const At& parent, const char* key, F&& f, Need need = Need::Optional) {
    const Json* list = array(parent, key, need);
    if (!list) return;
    const At here(parent, key, *list);
    for (std::size_t i = 0; ok() && i < list->size(); ++i) {
      const At element(here, i, (*list)[i]);
      if (enter(element)) f(element, i);
    }
  }
  /// f(At) for a member that is an object, if it is there.
  template <class F>
  bool withObject(const At& parent, const char* key, F&& f, Need need = Need::Optional) {
    const Json* value = object(parent, key, need);
    if (!value) return false;
    const At here(parent, key, *value);
    if (enter(here)) f(here);
    return true;
  }
  /// f(At) for an extension of an object, if the object has it.
  template <class F>
  bool withExtension(const At& parent, const char* name, F&& f) {
    const Json* all = object(parent, "extensions");
    if (!all) return false;
    const At here(parent, "extensions", *all);
    return withObject(here, name, f);
  }
  /// f(At) for `extras.burnish` of an object. Extras are free-form: whatever is not ours is no fault.
  template <class F>
  void withOwnExtras(const At& parent, F&& f) {
    const auto extras = parent->find("extras");
    if (!ok() || extras == parent->end() || !extras->is_object()) return;
    const auto ours = extras->find("burnish");
    if (ours == extras->end() || !ours->is_object()) return;
    const At here(parent, "extras", *extras);
    f(At(here, "burnish", *ours));
  }
  /// Warns of members of an object that the specification does not list (`name`, `extras` and `extensions` are always
  /// known).
  void known(const At& object, std::initializer_list<std::string_view> names);

  void setTableSize(Table table, std::size_t size) { sizes_[std::size_t(table)] = size; }
  [[nodiscard]] std::size_t tableSize(Table table) const { return sizes_[std::size_t(table)]; }
  std::set<std::string, std::less<>> extensionsUsed;

  static constexpr std::uint64_t kMaxInteger = std::uint64_t(1) << 53;  ///< beyond, JSON numbers are not exact

 private:
  std::string file_;
  Report& report_;
  std::optional<Error> error_;
  struct Group {
    std::string path;
    std::size_t count = 0;
  };
  std::map<std::string, Group> groups_;
  std::size_t unlisted_ = 0;
  std::vector<const std::map<std::string, Group>::value_type*> order_;
  std::array<std::size_t, std::size_t(Table::Count)> sizes_{};
};

}  // namespace burnish::asset
