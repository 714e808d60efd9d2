#include "asset/uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace burnish::asset {
namespace {

bool isLetter(char c) { return (c | 32) >= 'a' && (c | 32) <= 'z'; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; }
int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  return isLetter(c) && lower(c) <= 'f' ? lower(c) - 'a' + 10 : -1;
}

bool equalsNoCase(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (lower(a[i]) != lower(b[i])) return false;
  return true;
}

// RFC 4648, section 4: groups of four characters, '=' only at the end, no bits left over.
Result<std::vector<std::byte>> decodeBase64(std::string_view text) {
  static constexpr auto kValues = [] {
    std::array<std::int8_t, 256> v{};
    v.fill(-1);
    constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < kAlphabet.size(); ++i) v[static_cast<unsigned char>(kAlphabet[i])] = std::int8_t(i);
    return v;
  }();
  if (text.size() % 4) return fail("", fmt::format("base64 text of {} characters is no multiple of 4", text.size()));
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
  std::vector<std::byte> out;
  out.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < text.size() - padding; ++i) {
    const int v = kValues[static_cast<unsigned char>(text[i])];
    if (v < 0) return fail("", fmt::format("character {} of the base64 text is none of base64", i));
    bits = bits << 6 | std::uint32_t(v);
    if (i % 4 == 1) out.push_back(std::byte(bits >> 4 & 255));
    if (i % 4 == 2) out.push_back(std::byte(bits >> 2 & 255));
    if (i % 4 == 3) out.push_back(std::byte(bits & 255));
  }
  return out;
}

}  // namespace

UriKind uriKind(std::string_view uri) {
  if (uri.empty()) return UriKind::Invalid;
  const std::size_t colon = uri.substr(0, uri.find_first_of("/?#")).find(':');
  if (colon == uri.npos) return UriKind::Relative;
  if (colon == 0 || !isLetter(uri[0])) return UriKind::Invalid;
  for (const char c : uri.substr(0, colon))
    if (!isLetter(c) && !(c >= '0' && c <= '9') && c != '+' && c != '-' && c != '.') return UriKind::Invalid;
  return equalsNoCase(uri.substr(0, colon), "data") ? UriKind::Data : UriKind::Remote;
}

std::string percentDecoded(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool coded =
        text[i] == '%' && i + 2 < text.size() && hexDigit(text[i + 1]) >= 0 && hexDigit(text[i + 2]) >= 0;
    out += coded ? char(hexDigit(text[i + 1]) * 16 + hexDigit(text[i + 2])) : text[i];
    if (coded) i += 2;
  }
  return out;
}

Result<DataUri> decodeDataUri(std::string_view uri) {
  const std::size_t colon = uri.find(':'), comma = uri.find(',');
  if (comma == uri.npos) return fail("", "the data URI has no ','");
  DataUri out;
  bool base64 = false;
  // mediatype *( ";" name "=" value ) [ ";base64" ]
  const std::string_view head = uri.substr(colon + 1, comma - colon - 1);
  std::size_t end = std::min(head.find(';'), head.size());
  for (const char c : head.substr(0, std::min<std::size_t>(end, 100))) out.mediaType += lower(c);
  while (end < head.size()) {
    const std::size_t start = end + 1;
    end = std::min(head.find(';', start), head.size());
    const std::string_view part = head.substr(start, end - start);
    if (end == head.size() && equalsNoCase(part, "base64"))
      base64 = true;
    else if (part.find('=') == part.npos || part.front() == '=')
      return fail("", "the data URI has a malformed parameter");
  }
  const std::string_view payload = uri.substr(comma + 1);
  if (!base64) {
    const std::string text = percentDecoded(payload);
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    out.bytes.assign(bytes, bytes + text.size());
    return out;
  }
  auto bytes = payload.find('%') == payload.npos ? decodeBase64(payload) : decodeBase64(percentDecoded(payload));
  if (!bytes) return fail(std::move(bytes.error()));
  out.bytes = std::move(*bytes);
  return out;
}

}  // namespace burnish::asset
