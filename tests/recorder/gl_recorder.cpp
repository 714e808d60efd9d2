#include "recorder/gl_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <unordered_map>

namespace burnish::test {
namespace {

std::optional<Function> functionNamed(std::string_view name) {
  static const auto table = [] {
    std::unordered_map<std::string_view, Function> map;
    for (std::size_t i = 0; i < kFunctions; ++i) map.emplace(kFunctionNames[i], Function(i));
    return map;
  }();
  if (!name.starts_with("gl")) return std::nullopt;
  const auto found = table.find(name.substr(2));
  return found == table.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace

thread_local Recorder* Recorder::active_ = nullptr;

Recorder::Recorder(ProcAddress real) : getReal_(std::move(real)), ledger_([this](Function f) { return resolve(f); }) { activate(); }
Recorder::~Recorder() {
  if (active_ == this) active_ = nullptr;
}

Recorder& Recorder::active() {
  if (!active_) {
    fmt::print(stderr, "a recorded GL function was called on a thread that has no recorder\n");
    std::abort();
  }
  return *active_;
}

void* Recorder::resolve(Function f) {
  void*& address = real_[std::size_t(f)];
  if (!address) address = getReal_((std::string("gl") + kFunctionNames[std::size_t(f)]).c_str());
  return address;
}

ProcAddress Recorder::procAddress() {
  return [this](const char* name) -> void* {
    const auto f = functionNamed(name);
    return f && resolve(*f) ? kShims[std::size_t(*f)] : nullptr;
  };
}

void Recorder::recorded(Function f) {
  for (const std::uint64_t note : ledger_.takeNotes())
    if (keep_) {
      recording_.arguments.push_back(note);
      ++recording_.calls.back().count;
    }
  if (!injection_ || injecting_) return;
  injecting_ = true;
  injection_(f);
  injecting_ = false;
}

Recording Recorder::take() {
  Recording taken;
  std::swap(taken, recording_);
  taken.groups = ledger_.groupNames();
  return taken;
}

std::string Recording::text(std::size_t index) const {
  const Call& c = calls[index];
  const std::string_view kinds = kArgumentKinds[std::size_t(c.function)];
  std::string list;
  for (std::size_t i = 0; i < c.count; ++i) {
    const std::uint64_t v = arguments[c.first + i];
    const char kind = i < kinds.size() ? kinds[i] : 'n';
    if (!list.empty()) list += ", ";
    if (kind == 'f')
      list += fmt::format("{}", std::bit_cast<float>(std::uint32_t(v)));
    else if (kind == 'd')
      list += fmt::format("{}", std::bit_cast<double>(v));
    else if (kind == 'p')
      list += v ? "pointer" : "null";
    else if (kind == 'n')
      list += fmt::format("*{:x}", v);
    else
      list += std::int64_t(v) >= 0x80 && std::int64_t(v) < 0x10000 ? fmt::format("{:#x}", v) : fmt::format("{}", std::int64_t(v));
  }
  return fmt::format("{}({})  [{}]", kFunctionNames[std::size_t(c.function)], list, groups[c.group]);
}

std::size_t Recording::count(Function function) const {
  return std::size_t(std::count_if(calls.begin(), calls.end(), [&](const Call& c) { return c.function == function; }));
}

std::size_t Recording::countIn(std::string_view group) const {
  return std::size_t(std::count_if(calls.begin(), calls.end(), [&](const Call& c) { return groupOf(c) == group; }));
}

std::optional<std::string> difference(const Recording& a, const Recording& b) {
  const auto same = [&](std::size_t i) {
    const Call &x = a.calls[i], &y = b.calls[i];
    return x.function == y.function && x.count == y.count && a.groupOf(x) == b.groupOf(y) &&
           std::equal(a.arguments.begin() + x.first, a.arguments.begin() + x.first + x.count, b.arguments.begin() + y.first);
  };
  const std::size_t shared = std::min(a.calls.size(), b.calls.size());
  std::size_t i = 0;
  while (i < shared && same(i)) ++i;
  if (i == shared && a.calls.size() == b.calls.size()) return std::nullopt;
  std::string text = fmt::format("{} against {} calls; they part at call {}\n", a.calls.size(), b.calls.size(), i);
  for (std::size_t k = i > 2 ? i - 2 : 0; k < i + 3; ++k)
    text += fmt::format("  {} {}\n{}  {}\n", k < i ? ' ' : '<', k < a.calls.size() ? a.text(k) : "-", k < i ? "" : "  >", k < i ? "" : k < b.calls.size() ? b.text(k) : "-");
  return text;
}

}  // namespace burnish::test
