#include "asset/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace burnish::asset {
namespace {

constexpr const char* kTableNames[] = {"accessor", "buffer",  "bufferView", "camera", "image",   "material", "mesh",
                                       "node",     "sampler", "scene",      "skin",   "texture", "light"};

std::string quote(const Json& v) {
  std::string text = v.is_structured() ? (v.is_array() ? "an array" : "an object")
                                       : v.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() > 60 ? text.substr(0, 57) + "..." : text;
}

// Integers may be written as "1.0" (glTF 2.0, section 2.7: JSON Encoding).
std::optional<double> wholeNumber(const Json& v) {
  if (!v.is_number()) return {};
  const double d = v.get<double>();
  return std::trunc(d) == d ? std::optional<double>(d) : std::nullopt;
}

}  // namespace

std::string At::path() const {
  std::vector<const At*> way;
  for (const At* a = this; a->parent_; a = a->parent_) way.push_back(a);
  if (way.empty()) return "/";
  std::string text;
  for (auto a = way.rbegin(); a != way.rend(); ++a) {
    if ((*a)->index_ == std::numeric_limits<std::size_t>::max())
      appendPointer(text, (*a)->key_);
    else
      text += fmt::format("/{}", (*a)->index_);
  }
  return text;
}

Check::~Check() {
  for (const auto* group : order_) {
    const auto& [what, at] = *group;
    report_.warn(at.path.empty() ? file_ : file_ + ": " + at.path,
                 at.count > 1 ? fmt::format("{} (and {} more like it)", what, at.count - 1) : what);
  }
  if (unlisted_) report_.warn(file_, fmt::format("{} more warnings are not listed", unlisted_));
}

void Check::fail(std::string path, std::string what, std::string remedy) {
  if (ok()) error_ = Error{path.empty() ? file_ : file_ + ": " + path, std::move(what), std::move(remedy)};
}

void Check::warn(const std::string& path, const std::string& what) {
  constexpr std::size_t kMaxGroups = 1000;
  auto found = groups_.find(what);
  if (found == groups_.end()) {
    if (groups_.size() >= kMaxGroups) {
      ++unlisted_;
      return;
    }
    found = groups_.try_emplace(what, Group{path, 0}).first;
    order_.push_back(&*found);
  }
  ++found->second.count;
}

bool Check::enter(const At& at) {
  if (!at->is_object()) {
    fail(at, fmt::format("{} where an object is expected", quote(*at)));
    return false;
  }
  string(at, "name");
  if (const Json* all = object(at, "extensions")) {
    const At here(at, "extensions", *all);
    for (const auto& [name, value] : all->items()) {
      const At extension(here, name, value);
      if (!value.is_object()) fail(extension, fmt::format("{} where an object is expected", quote(value)));
      if (!extensionsUsed.contains(name))
        fail(extension, "the extension is not declared", "list it in /extensionsUsed");
    }
  }
  return ok();
}

const Json* Check::member(const At& at, const char* key, Need need) {
  if (!ok()) return nullptr;
  const auto found = at->find(key);
  if (found != at->end()) return &*found;
  if (need == Need::Required) fail(at, fmt::format("'{}' is missing", key));
  return nullptr;
}

const Json* Check::object(const At& at, const char* key, Need need) {
  const Json* v = member(at, key, need);
  if (!v || v->is_object()) return v;
  fail(At(at, key, *v), fmt::format("{} where an object is expected", quote(*v)));
  return nullptr;
}

const Json* Check::array(const At& at, const char* key, Need need) {
  const Json* v = member(at, key, need);
  if (!v) return nullptr;
  if (v->is_array() && !v->empty()) return v;
  if (v->is_array())
    fail(At(at, key, *v), "the array is empty", "leave the property out (glTF 2.0 allows no empty arrays)");
  else
    fail(At(at, key, *v), fmt::format("{} where an array is expected", quote(*v)));
  return nullptr;
}

double Check::numberValue(const At& at, const Range& range) {
  if (!at->is_number()) {
    fail(at, fmt::format("{} where a number is expected", quote(*at)));
    return 0;
  }
  double v = at->get<double>();
  constexpr double kRounding = 1e-6;  // writers print 1.0000001 for 1
  if (v > range.max && v <= range.max + kRounding * std::abs(range.max)) v = range.max;
  if (v < range.min && v >= range.min - kRounding * std::abs(range.min)) v = range.min;
  if (v < range.min || v > range.max || !std::isfinite(v) || (range.aboveMin && v == range.min)) {
    constexpr double kLargest = std::numeric_limits<float>::max();
    const std::string low =
        range.min <= -kLargest ? "" : fmt::format(", {} {}", range.aboveMin ? "above" : "at least", range.min);
    const std::string high = range.max >= kLargest ? "" : fmt::format(", at most {}", range.max);
    fail(at, fmt::format("{} is out of range (a finite float{}{})", quote(*at), low, high));
    return 0;
  }
  return v;
}

double Check::number(const At& at, const char* key, double fallback, const Range& range, Need need) {
  const Json* v = member(at, key, need);
  return v ? numberValue(At(at, key, *v), range) : fallback;
}

std::uint64_t Check::integerValue(const At& at, std::uint64_t min, std::uint64_t max) {
  const auto v = wholeNumber(*at);
  if (!v) {
    fail(at, fmt::format("{} where a whole number is expected", quote(*at)));
    return min;
  }
  if (*v < double(min) || *v > double(max)) {
    const std::string high = max >= kMaxInteger ? "" : fmt::format(", at most {}", max);
    fail(at, fmt::format("{} is out of range (at least {}{})", quote(*at), min, high));
    return min;
  }
  return std::uint64_t(*v);
}

std::uint64_t Check::integer(const At& at, const char* key, std::uint64_t fallback, std::uint64_t min,
                             std::uint64_t max, Need need) {
  const Json* v = member(at, key, need);
  return v ? integerValue(At(at, key, *v), min, max) : fallback;
}

bool Check::boolean(const At& at, const char* key, bool fallback) {
  const Json* v = member(at, key);
  if (!v) return fallback;
  if (!v->is_boolean()) fail(At(at, key, *v), fmt::format("{} where true or false is expected", quote(*v)));
  return v->is_boolean() ? v->get<bool>() : fallback;
}

const std::string* Check::string(const At& at, const char* key, Need need) {
  const Json* v = member(at, key, need);
  if (!v) return nullptr;
  if (v->is_string()) return v->get_ptr<const std::string*>();
  fail(At(at, key, *v), fmt::format("{} where a string is expected", quote(*v)));
  return nullptr;
}

int Check::referenceValue(const At& at, Table table) {
  const auto v = wholeNumber(*at);
  const std::size_t size = tableSize(table);
  const char* name = kTableNames[std::size_t(table)];
  if (!v)
    fail(at, fmt::format("{} where the index of a {} is expected", quote(*at), name));
  else if (*v < 0 || *v >= double(size))
    fail(at, fmt::format("{} {} does not exist (the file has {} of them)", name, quote(*at), size));
  else
    return int(*v);
  return -1;
}

int Check::reference(const At& at, const char* key, Table table, Need need) {
  const Json* v = member(at, key, need);
  return v ? referenceValue(At(at, key, *v), table) : -1;
}

std::vector<int> Check::references(const At& at, const char* key, Table table, Need need) {
  const Json* list = array(at, key, need);
  if (!list) return {};
  const At here(at, key, *list);
  std::vector<int> out;
  out.reserve(list->size());
  for (std::size_t i = 0; ok() && i < list->size(); ++i) out.push_back(referenceValue(At(here, i, (*list)[i]), table));
  if (!ok()) return {};
  std::vector<int> sorted = out;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end()) fail(here, fmt::format("{} {} is listed twice", kTableNames[std::size_t(table)], *twice));
  return out;
}

bool Check::numbers(const At& at, const char* key, std::span<double> out, const Range& range) {
  const Json* list = array(at, key);
  if (!list) return false;
  const At here(at, key, *list);
  if (list->size() != out.size()) {
    fail(here, fmt::format("{} numbers where {} are expected", list->size(), out.size()));
    return false;
  }
  for (std::size_t i = 0; ok() && i < out.size(); ++i) out[i] = numberValue(At(here, i, (*list)[i]), range);
  return ok();
}

std::vector<double> Check::numberList(const At& at, const char* key, std::size_t length) {
  const Json* list = array(at, key);
  if (!list) return {};
  std::vector<double> out(length ? length : list->size());
  return numbers(at, key, out) ? out : std::vector<double>{};
}

void Check::known(const At& at, std::initializer_list<std::string_view> names) {
  for (auto member = at->begin(); ok() && member != at->end(); ++member) {
    const std::string& key = member.key();
    if (key == "name" || key == "extras" || key == "extensions") continue;
    if (std::find(names.begin(), names.end(), key) != names.end()) continue;
    std::string pointer;
    appendPointer(pointer, key);
    const std::string path = at.path();
    warn((path == "/" ? "" : path) + pointer, fmt::format("unknown property '{}' is ignored", pointer.substr(1)));
  }
}

}  // namespace burnish::asset
