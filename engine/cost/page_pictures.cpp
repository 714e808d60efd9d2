#include "cost/page_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/hash.h"
#include "cost/page_text.h"
#include "image/encode.h"
#include "image/resample.h"

namespace burnish::cost {
namespace {

constexpr int kLeastWidth = 96;  // pixels; what is less shows nothing

bool isDifference(const Image& i) { return i.type == PixelType::F32 && i.channels == 1; }
bool usable(const Image& i) {
  return i.width > 0 && i.height > 0 && i.data.size() == i.byteSize() && (isDifference(i) || (i.type == PixelType::U8 && i.channels == 3));
}

/// Points of the scale: lightness, a and b of OKLab (Ottosson 2020).
struct OkLab {
  double l, a, b;
};
constexpr OkLab kScale[] = {{0.14, 0.010, -0.035}, {0.32, 0.075, -0.125}, {0.50, 0.165, -0.055}, {0.67, 0.135, 0.095}, {0.82, 0.030, 0.145}, {0.98, -0.015, 0.060}};

double srgb(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

}  // namespace

std::array<std::uint8_t, 3> differenceColour(double share) {
  const double at = std::sqrt(std::clamp(share, 0.0, 1.0)) * static_cast<double>(std::size(kScale) - 1);
  const std::size_t low = std::min<std::size_t>(static_cast<std::size_t>(at), std::size(kScale) - 2);
  const double t = at - static_cast<double>(low);
  const OkLab &p = kScale[low], &q = kScale[low + 1];
  const double l = p.l + (q.l - p.l) * t, a = p.a + (q.a - p.a) * t, b = p.b + (q.b - p.b) * t;
  // OKLab to linear sRGB (Ottosson 2020, "A perceptual color space for image processing").
  const double lc = std::pow(l + 0.3963377774 * a + 0.2158037573 * b, 3), mc = std::pow(l - 0.1055613458 * a - 0.0638541728 * b, 3), sc = std::pow(l - 0.0894841775 * a - 1.2914855480 * b, 3);
  const double rgb[] = {4.0767416621 * lc - 3.3077115913 * mc + 0.2309699292 * sc, -1.2684380046 * lc + 2.6097574011 * mc - 0.3413193965 * sc,
                        -0.0041960863 * lc - 0.7034186147 * mc + 1.7076147010 * sc};
  std::array<std::uint8_t, 3> out;
  for (int c = 0; c < 3; ++c) out[c] = static_cast<std::uint8_t>(std::lround(srgb(rgb[c]) * 255));
  return out;
}

Image differencePicture(const Image& difference, double white) {
  Image out = makeImage(difference.width, difference.height, 3, PixelType::U8);
  constexpr int kSteps = 128;  // few colours are few bytes
  std::array<std::array<std::uint8_t, 3>, kSteps + 1> colours;
  for (int i = 0; i <= kSteps; ++i) colours[i] = differenceColour(std::pow(static_cast<double>(i) / kSteps, 2));
  for (std::size_t i = 0; i < difference.pixelCount(); ++i) {
    const double share = difference.f32()[i] / white;
    constexpr std::array<std::uint8_t, 3> kNotFinite{0, 220, 220};
    const auto colour = std::isfinite(share) ? colours[std::lround(std::sqrt(std::clamp(share, 0.0, 1.0)) * kSteps)] : kNotFinite;
    std::copy(colour.begin(), colour.end(), out.u8() + 3 * i);
  }
  return out;
}

std::string base64(std::span<const std::byte> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t word = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    for (std::size_t i = 0; i < 3; ++i) word = word << 8 | (i < count ? std::to_integer<std::uint32_t>(bytes[at + i]) : 0);
    for (std::size_t i = 0; i < 4; ++i) out += i <= count ? kDigits[word >> (18 - 6 * i) & 63] : '=';
  }
  return out;
}

void PagePictures::want(const Image& image, bool large) {
  if (!usable(image)) return;
  core::Hasher hasher;
  hasher.value(image.width), hasher.value(image.height), hasher.value(image.channels), hasher.value(image.type);
  hasher.add(image.data);
  const auto [found, isNew] = byContent_.try_emplace(hasher.finish().hex(), entries_.size());
  if (isNew) entries_.push_back({&image, large});
  Entry& entry = entries_[found->second];
  entry.large = entry.large || large;
  index_[&image] = found->second;
}

std::size_t PagePictures::encodeOnce(int widest, int width, bool large) {
  std::size_t total = 0;
  for (Entry& e : entries_) {
    if (e.large != large) continue;
    const int most = large ? widest : width;
    const bool difference = isDifference(*e.image);
    Image smaller;
    e.width = e.image->width, e.height = e.image->height;
    if (e.width > most) {
      e.height = std::max(1, static_cast<int>(std::lround(static_cast<double>(e.height) * most / e.width)));
      e.width = most;
      smaller = image::resampleArea(*e.image, e.width, e.height, difference ? image::AverageIn::Values : image::AverageIn::LinearLight);
    }
    const Image& sized = smaller.empty() ? *e.image : smaller;
    const auto png = image::encodePng(difference ? differencePicture(sized, white_) : sized, "a picture of the page");
    e.data = png ? base64(*png) : "";
    total += e.data.size();
  }
  return total;
}

void PagePictures::encode(std::size_t bytes, Report& report, int widest, int width) {
  // The few large ones get at most half of the space.
  std::size_t taken = encodeOnce(widest, width, true);
  while (taken > bytes / 2 && widest > kLeastWidth) {
    widest = std::max(kLeastWidth, static_cast<int>(widest * std::min(0.9, 0.97 * std::sqrt(static_cast<double>(bytes / 2) / static_cast<double>(taken)))));
    taken = encodeOnce(widest, width, true);
  }
  const std::size_t rest = bytes > taken ? bytes - taken : 0;
  std::size_t small = encodeOnce(widest, width, false);
  while (small > rest && width > kLeastWidth) {
    width = std::max(kLeastWidth, static_cast<int>(width * std::min(0.9, 0.97 * std::sqrt(static_cast<double>(rest) / static_cast<double>(small)))));
    small = encodeOnce(widest, width, false);
  }
  std::size_t left = bytes, dropped = 0;
  for (Entry& e : entries_) {
    if (e.data.size() <= left) left -= e.data.size();
    else e.data.clear(), ++dropped;
  }
  if (dropped > 0) report.warn("index.html", fmt::format("{} of {} pictures are left out, the page would be too large", dropped, entries_.size()));
}

bool PagePictures::has(const Image& image) const {
  const auto found = index_.find(&image);
  return found != index_.end() && !entries_[found->second].data.empty();
}

std::string PagePictures::show(const Image& image, std::string_view label) const {
  if (!has(image)) return fmt::format("<div class=\"nopicture\" role=\"img\" aria-label=\"{0}: no picture\">no picture</div>", escaped(label));
  const std::size_t i = index_.at(&image);
  return fmt::format("<svg class=\"picture\" viewBox=\"0 0 {0} {1}\" role=\"img\" aria-label=\"{2}\"><use href=\"#p{3}\"/></svg>", entries_[i].width, entries_[i].height, escaped(label), i);
}

std::string PagePictures::definitions() const {
  std::string out = "<svg width=\"0\" height=\"0\" class=\"store\" aria-hidden=\"true\"><defs>\n";
  for (std::size_t i = 0; i < entries_.size(); ++i)
    if (!entries_[i].data.empty())
      out += fmt::format("<image id=\"p{}\" width=\"{}\" height=\"{}\" href=\"data:image/png;base64,{}\"/>\n", i, entries_[i].width, entries_[i].height, entries_[i].data);
  return out + "</defs></svg>\n";
}

}  // namespace burnish::cost
