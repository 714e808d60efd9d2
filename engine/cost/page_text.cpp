#include "cost/page_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace burnish::cost {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

/// The code point at `at`, and how many bytes it takes; 0 bytes: not UTF-8 there (RFC 3629: no overlong forms, no surrogates, none over U+10FFFF).
std::size_t decode(std::string_view text, std::size_t at, std::uint32_t& point) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(at);
  const std::size_t bytes = first < 0x80 ? 1 : first >= 0xC2 && first < 0xE0 ? 2 : first >= 0xE0 && first < 0xF0 ? 3 : first >= 0xF0 && first < 0xF5 ? 4 : 0;
  if (bytes == 0 || at + bytes > text.size()) return 0;
  point = bytes == 1 ? first : first & (0xFF >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(at + i) & 0xC0) != 0x80) return 0;
    point = point << 6 | (byte(at + i) & 0x3Fu);
  }
  const bool overlong = (bytes == 3 && point < 0x800) || (bytes == 4 && point < 0x10000);
  return overlong || (point >= 0xD800 && point < 0xE000) || point > 0x10FFFF ? 0 : bytes;
}

bool shown(std::uint32_t p) {
  if (p < 0x20 || (p >= 0x7F && p < 0xA0)) return false;
  if ((p >= 0x202A && p <= 0x202E) || (p >= 0x2066 && p <= 0x2069) || p == 0x200E || p == 0x200F || p == 0x061C) return false;  // they turn the direction of what follows
  return p != 0x2028 && p != 0x2029 && (p & 0xFFFE) != 0xFFFE && !(p >= 0xFDD0 && p <= 0xFDEF);
}

}  // namespace

std::string cleanText(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    std::uint32_t point = 0;
    const std::size_t bytes = decode(text, at, point);
    if (bytes == 1 && (point == '\t' || point == '\n' || point == '\r')) out += ' ';
    else if (bytes > 0 && shown(point)) out += text.substr(at, bytes);
    else out += kReplacement;
    at += bytes > 0 ? bytes : 1;
  }
  return out;
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : cleanText(text)) {
    if (c == '&') out += "&amp;";
    else if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '"') out += "&quot;";
    else if (c == '\'') out += "&#39;";
    else out += c;
  }
  return out;
}

std::string slug(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const bool upper = c >= 'A' && c <= 'Z', plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
    if (upper || plain) out += upper ? static_cast<char>(c - 'A' + 'a') : c;
    else if (!out.empty() && out.back() != '-') out += '-';
    if (out.size() == 48) break;
  }
  while (!out.empty() && out.back() == '-') out.pop_back();
  return out.empty() ? "x" : out;
}

std::string shortened(std::string_view text, std::size_t most) {
  const std::string clean = cleanText(text);
  std::size_t points = 0, cut = clean.size();
  for (std::size_t at = 0; at < clean.size(); ++at) {
    if ((static_cast<std::uint8_t>(clean[at]) & 0xC0) == 0x80) continue;
    if (points + 1 == most) cut = at;
    ++points;
  }
  return points <= most ? clean : clean.substr(0, cut) + "…";
}

std::string number(double value, int digits) {
  if (std::isnan(value)) return "n/a";
  const std::string sign = value < 0 ? "−" : "";
  const double size = std::abs(value);
  if (std::isinf(value)) return sign + "∞";
  if (size == 0) return "0";
  if (size < 1e-4 || size >= 1e7) return sign + fmt::format("{:.{}e}", size, digits - 1);
  const int before = static_cast<int>(std::floor(std::log10(size))) + 1;
  return sign + fmt::format("{:.{}f}", size, std::max(digits - before, 0));
}

std::string percent(double share, int digits) {
  if (!std::isfinite(share)) return number(share);
  if (share != 0 && std::abs(share) < 5e-7) return "< 0.0001 %";
  return number(share * 100, digits) + " %";
}

std::string signedPercent(double share) {
  if (!std::isfinite(share)) return number(share);
  if (std::abs(share) < 5e-7) return "0 %";
  return fmt::format("{}{} %", share > 0 ? "+" : "", number(share * 100));
}

std::string duration(double seconds) {
  if (!(seconds >= 0) || !std::isfinite(seconds)) return "n/a";
  if (seconds < 60) return number(seconds, 3) + " s";
  const auto whole = static_cast<long long>(seconds);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole / 60 % 60);
}

std::string spreadText(const Spread& spread) {
  if (!measured(spread)) return "n/a";
  std::string text = number(spread.median, 4);
  if (spread.count > 1) text += fmt::format(" ({} to {})", number(spread.low, 4), number(spread.high, 4));
  return text;
}

bool measured(const PictureError& error) { return std::isfinite(error.rms) && (error.rms != 0 || error.psnr != 0); }
bool measured(const Spread& spread) { return spread.count > 0 && std::isfinite(spread.median); }

bool restMeasured(const RungCost& rung) { return rung.exactRestKnown && measured(rung.exactRest); }

bool hasTruth(const CostReport& cost) { return cost.against == "ground truth" || cost.referenceSamples > 0 || !cost.truthPicture.empty(); }

std::string_view presetOf(const CostReport& cost, const FrontPoint& point) {
  for (const std::string_view name : presetNames()) {
    Quality quality = cost.base.quality;
    if (setPreset(quality, name) && quality == point.quality) return name;
  }
  return {};
}

}  // namespace burnish::cost
