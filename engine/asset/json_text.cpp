#include "asset/json_text.h"

#include <fmt/format.h>

namespace burnish::asset {
namespace {

// One pass over the bytes, before the parser sees them. Malformed text is the parser's to report.
std::string checkNesting(std::string_view text, const JsonLimits& limits) {
  int depth = 0;
  std::uint64_t values = 1;
  bool inString = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (inString) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        inString = false;
      continue;
    }
    if (c == '"') inString = true;
    if (c == '[' || c == '{') {
      if (++depth > limits.depth)
        return fmt::format("JSON is nested deeper than {} levels at byte {}", limits.depth, i);
      ++values;
    }
    if (c == ']' || c == '}') --depth;
    if (c == ',') ++values;
    if (values > limits.values) return fmt::format("JSON holds more than {} values", limits.values);
  }
  return {};
}

std::string lineAndColumn(std::string_view text, std::size_t position) {
  const std::string_view before = text.substr(0, std::min(position, text.size()));
  const auto lines = std::count(before.begin(), before.end(), '\n');
  const std::size_t start = before.rfind('\n');
  return fmt::format("line {}, column {}", lines + 1, before.size() - (start == before.npos ? 0 : start + 1));
}

// Builds the document from the parser's events and knows at each moment which value comes next.
class Builder final : public nlohmann::json_sax<Json> {
 public:
  Json root;
  std::string path, what;  // of the first fault; `path` is empty for faults of syntax
  std::size_t position = 0;

  bool null() override { return add(Json(nullptr)); }
  bool boolean(bool v) override { return add(Json(v)); }
  bool number_integer(std::int64_t v) override { return add(Json(v)); }
  bool number_unsigned(std::uint64_t v) override { return add(Json(v)); }
  bool number_float(double v, const std::string&) override { return add(Json(v)); }
  bool string(std::string& v) override { return add(Json(std::move(v))); }
  bool binary(Json::binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_array() override { return close(); }
  bool key(std::string& name) override {
    Level& top = stack_.back();
    auto [place, fresh] = top.value->get_ref<Json::object_t&>().try_emplace(std::move(name));
    top.member = &*place;
    if (fresh) return true;
    path = currentPath();
    what = "the name is given twice";
    return false;
  }
  bool parse_error(std::size_t at, const std::string& token, const nlohmann::detail::exception& e) override {
    position = at;
    if (e.id == 406) {  // a number that no double holds
      path = currentPath();
      what = fmt::format("number {} is not finite", token.substr(0, 40));
    } else {
      // "[json.exception.parse_error.101] parse error at line 1, column 2: what" without its head
      const std::string_view text = e.what();
      const std::size_t colon = text.find(": ");
      what = text.substr(colon == text.npos ? 0 : colon + 2);
    }
    return false;
  }

 private:
  struct Level {
    Json* value;
    Json::object_t::value_type* member = nullptr;
  };
  std::vector<Level> stack_;

  Json* place(Json&& v) {
    if (stack_.empty()) return &(root = std::move(v));
    Level& top = stack_.back();
    if (top.member) return &(top.member->second = std::move(v));
    auto& list = top.value->get_ref<Json::array_t&>();
    return &list.emplace_back(std::move(v));
  }
  bool add(Json&& v) { return place(std::move(v)) != nullptr; }
  bool open(Json&& v) {
    stack_.push_back({place(std::move(v))});
    return true;
  }
  bool close() {
    stack_.pop_back();
    return true;
  }
  [[nodiscard]] std::string currentPath() const {
    std::string text;
    for (std::size_t i = 0; i < stack_.size(); ++i) {
      const Level& l = stack_[i];
      const bool last = i + 1 == stack_.size();
      if (l.value->is_array())
        text += fmt::format("/{}", l.value->size() - (last ? 0 : 1));
      else if (l.member)
        appendPointer(text, l.member->first);
    }
    return text;
  }
};

}  // namespace

void appendPointer(std::string& pointer, std::string_view key) {
  pointer += '/';
  for (const char c : key.substr(0, 80)) {
    if (c == '~')
      pointer += "~0";
    else if (c == '/')
      pointer += "~1";
    else
      pointer += static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
  }
  if (key.size() > 80) pointer += "...";
}

Result<Json> parseJson(std::span<const std::byte> bytes, const std::string& place, const JsonLimits& limits) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (text.find_first_not_of(" \t\r\n") == text.npos)
    return fail(place, "the JSON text is empty", "export the file again");
  if (std::string fault = checkNesting(text, limits); !fault.empty())
    return fail(place, std::move(fault), "this is more than any scene needs: simplify the file");
  Builder builder;
  if (!Json::sax_parse(text.begin(), text.end(), &builder)) {
    if (!builder.path.empty()) return fail(place + ": " + builder.path, std::move(builder.what), "correct the value");
    return fail(fmt::format("{}: {}", place, lineAndColumn(text, builder.position)),
                "not JSON: " + std::move(builder.what), "export the file again");
  }
  return std::move(builder.root);
}

}  // namespace burnish::asset
