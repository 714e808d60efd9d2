#include "gl/shader_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>

namespace burnish::gl {
namespace {

constexpr std::size_t kMaxDepth = 32;

std::string_view trim(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t' || s.back() == '\r')) s.remove_suffix(1);
  return s;
}

/// "# include  "a"" as {"include", "\"a\""}; an empty name where the line is no directive.
struct Directive {
  std::string_view name, rest;
};
Directive directive(std::string_view line) {
  line = trim(line);
  if (line.empty() || line.front() != '#') return {};
  line = trim(line.substr(1));
  std::size_t end = 0;
  while (end < line.size() && (std::isalnum(static_cast<unsigned char>(line[end])) || line[end] == '_')) ++end;
  return {line.substr(0, end), trim(line.substr(end))};
}

/// Follows conditionals as far as __cplusplus decides them: shaders and C++ share files, and what only C++ includes is
/// no concern here.
class Conditionals {
 public:
  void see(const Directive& d) {
    if (d.name == "ifdef")
      stack_.push_back(d.rest == "__cplusplus" ? Cpp : Unknown);
    else if (d.name == "ifndef")
      stack_.push_back(d.rest == "__cplusplus" ? NotCpp : Unknown);
    else if (d.name == "if")
      stack_.push_back(isCpp(d.rest) ? Cpp : isNotCpp(d.rest) ? NotCpp : Unknown);
    else if (stack_.empty())
      return;
    else if (d.name == "else")
      stack_.back() = stack_.back() == Cpp ? NotCpp : stack_.back() == NotCpp ? Cpp : Unknown;
    else if (d.name == "elif")
      stack_.back() = Unknown;
    else if (d.name == "endif")
      stack_.pop_back();
  }
  [[nodiscard]] bool cppOnly() const { return std::find(stack_.begin(), stack_.end(), Cpp) != stack_.end(); }

 private:
  enum Branch { Unknown, Cpp, NotCpp };
  static bool isCpp(std::string_view s) { return s == "defined(__cplusplus)" || s == "defined __cplusplus"; }
  static bool isNotCpp(std::string_view s) { return !s.empty() && s.front() == '!' && isCpp(trim(s.substr(1))); }
  std::vector<Branch> stack_;
};

/// Whether a /* comment is open after the line. Comments do not nest; // hides what follows.
bool blockCommentAfter(std::string_view line, bool open) {
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const std::string_view two = line.substr(i, 2);
    if (open && two == "*/") {
      open = false;
      ++i;
    } else if (!open && two == "/*") {
      open = true;
      ++i;
    } else if (!open && two == "//") {
      break;
    }
  }
  return open;
}

/// Path below the root with "." and ".." resolved; empty when it would leave the root.
std::string normalized(const std::filesystem::path& path) {
  const std::string name = path.lexically_normal().generic_string();
  const bool outside = name.empty() || name.front() == '/' || name == ".." || name.rfind("../", 0) == 0 ||
                       name.find('\0') != std::string::npos;
  return outside ? std::string() : name;
}

class Resolver {
 public:
  explicit Resolver(const ShaderLibrary& library) : library_(library) {}

  Result<void> add(const std::string& name, const std::string& askedBy) {
    if (const auto at = std::find(stack_.begin(), stack_.end(), name); at != stack_.end()) {
      std::string chain;
      for (auto i = at; i != stack_.end(); ++i) chain += *i + " -> ";
      return fail(askedBy, "include cycle: " + chain + name, "move what both need into a third file");
    }
    if (std::find(out.files.begin(), out.files.end(), name) != out.files.end()) return {};
    if (stack_.size() >= kMaxDepth)
      return fail(askedBy, fmt::format("includes nest deeper than {}", kMaxDepth), "include less deeply");
    auto text = library_.file(name);
    if (!text)
      return fail(askedBy.empty()
                      ? text.error()
                      : Error{askedBy, text.error().what + " (" + text.error().place + ")", text.error().remedy});
    const std::size_t index = out.files.size();
    out.files.push_back(name);
    stack_.push_back(name);
    if (auto done = lines(name, index, *text); !done) return done;
    stack_.pop_back();
    return {};
  }

  ShaderText out;

 private:
  Result<void> lines(const std::string& name, std::size_t index, std::string_view text) {
    out.text += fmt::format("#line 1 {}\n", index);
    Conditionals conditionals;
    bool comment = false;
    for (std::size_t number = 1; !text.empty(); ++number) {
      const std::size_t end = text.find('\n');
      const std::string_view line = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      const Directive d = comment ? Directive{} : directive(line);
      comment = blockCommentAfter(line, comment);
      conditionals.see(d);
      const std::string place = fmt::format("{}:{}", name, number);
      if (d.name == "include" && !conditionals.cppOnly()) {
        const auto before = out.text.size();
        if (auto done = include(name, place, d.rest); !done) return done;
        out.text += out.text.size() == before ? "\n" : fmt::format("#line {} {}\n", number + 1, index);
      } else if (d.name == "version" || d.name == "include" || (d.name == "pragma" && d.rest.rfind("once", 0) == 0)) {
        if (d.name == "version" && d.rest.rfind("450", 0) != 0)
          return fail(place, fmt::format("#version {}", d.rest), "leave it out: 450 core is put in front");
        out.text += '\n';  // keeps the count of lines
      } else {
        out.text += line;
        out.text += '\n';
      }
    }
    return {};
  }

  Result<void> include(const std::string& from, const std::string& place, std::string_view what) {
    if (!what.empty() && what.front() == '<') return {};
    const std::size_t close = what.size() > 1 ? what.find('"', 1) : std::string_view::npos;
    if (what.empty() || what.front() != '"' || close == std::string_view::npos || close == 1)
      return fail(place, fmt::format("malformed include: {}", what), "write #include \"path/below/shaders\"");
    const std::string_view path = what.substr(1, close - 1);
    const std::string beside = normalized(std::filesystem::path(from).parent_path() / path), root = normalized(path);
    if (beside.empty() && root.empty())
      return fail(place, fmt::format("include \"{}\" leaves the shader folder", path), "include only files below it");
    return add(!beside.empty() && library_.file(beside) ? beside : root.empty() ? beside : root, place);
  }

  const ShaderLibrary& library_;
  std::vector<std::string> stack_;
};

}  // namespace

ShaderLibrary::ShaderLibrary(std::filesystem::path overrideFolder, std::span<const EmbeddedShader> embedded)
    : override_(std::move(overrideFolder)), embedded_(embedded) {}

Result<std::string> ShaderLibrary::file(std::string_view name) const {
  if (normalized(name) != name || name.empty())
    return fail(std::string(name), "not a path below the shader folder", "use a relative path without ..");
  std::error_code ignored;
  if (!override_.empty() && std::filesystem::is_regular_file(override_ / name, ignored)) {
    std::ifstream in(override_ / name, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(in), {}};
    if (in.bad() || !in.is_open())
      return fail((override_ / name).string(), "the file cannot be read", "check its permissions");
    return text;
  }
  for (const EmbeddedShader& s : embedded_)
    if (s.name == name) return std::string(s.text);
  const std::string where =
      override_.empty() ? "among the embedded ones" : "in " + override_.string() + " or among the embedded ones";
  return fail(std::string(name), "no such shader file " + where, "check the name, or add the file below shaders/");
}

Result<ShaderText> ShaderLibrary::resolve(std::string_view name, std::span<const std::string> defines) const {
  Resolver resolver(*this);
  resolver.out.text = "#version 450 core\n";
  for (const std::string& d : defines) {
    if (d.empty() || d.find_first_of("\n\r\\") != std::string::npos)
      return fail(std::string(name), fmt::format("malformed definition \"{}\"", d), "write NAME value on one line");
    resolver.out.text += "#define " + d + '\n';
  }
  if (auto done = resolver.add(std::string(name), ""); !done) return fail(done.error());
  return std::move(resolver.out);
}

std::string nameFiles(std::string_view log, std::span<const std::string> files) {
  std::string out;
  for (std::size_t i = 0; i < log.size();) {
    const auto digit = [&](std::size_t at) {
      return at < log.size() && std::isdigit(static_cast<unsigned char>(log[at]));
    };
    // A file index stands at the start of a line, or after "ERROR: " or the like, and is followed by ":line" (Mesa,
    // Intel, AMD) or "(line)" (NVIDIA).
    const bool start = i == 0 || log[i - 1] == '\n' || log[i - 1] == ' ' || log[i - 1] == '\t';
    std::size_t end = i, file = 0;
    while (digit(end) && end - i < 6) file = file * 10 + std::size_t(log[end++] - '0');
    const bool colon = end < log.size() && log[end] == ':', paren = end < log.size() && log[end] == '(';
    std::size_t lineEnd = end + 1;
    while (digit(lineEnd)) ++lineEnd;
    const bool numbered = lineEnd > end + 1 && (!paren || (lineEnd < log.size() && log[lineEnd] == ')'));
    if (start && end > i && (colon || paren) && numbered && file < files.size()) {
      out += files[file];
      out += ':';
      out += log.substr(end + 1, lineEnd - end - 1);
      i = lineEnd + (paren ? 1 : 0);
    } else {
      out += log[i++];
    }
  }
  return out;
}

}  // namespace burnish::gl
