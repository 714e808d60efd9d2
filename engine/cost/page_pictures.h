// Pictures of the page: PNG in the page itself, each once, as large as the page's size allows.
#pragma once
#include <burnish/image.h>
#include <burnish/result.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace burnish::cost {

/// Colour of a difference: `share` of the white of the scale, 0 to 1, drawn over its square root, so that a hundredth is still seen. sRGB. From near black over violet and orange to pale yellow;
/// lightness (OKLab) rises evenly, so that it reads in grey and to the colour-blind.
std::array<std::uint8_t, 3> differenceColour(double share);
/// A difference picture (F32, one channel) in these colours. Values that are not finite are cyan, which the scale has not.
Image differencePicture(const Image& difference, double white);
/// The bytes as base64 (RFC 4648).
std::string base64(std::span<const std::byte> bytes);

class PagePictures {
 public:
  /// `white`: of all difference pictures.
  explicit PagePictures(double white) : white_(white) {}
  /// Asks for a picture, which must outlive this: U8 with three channels, or F32 with one, a difference. `large`: one of the few that head the page. What is empty or of another kind is no picture.
  void want(const Image& image, bool large);
  /// Encodes all, none wider than `widest` (large) or `width`, smaller where they take more than `bytes` as base64. What does not fit even then is left out, with a warning.
  void encode(std::size_t bytes, Report& report, int widest = 800, int width = 480);
  /// Whether the page holds it.
  [[nodiscard]] bool has(const Image& image) const;
  [[nodiscard]] double white() const { return white_; }
  /// The picture at its place: an <svg> that shows it, read out as `label`; a box with words where the page does not hold it.
  [[nodiscard]] std::string show(const Image& image, std::string_view label) const;
  /// All pictures, once: goes anywhere into the page.
  [[nodiscard]] std::string definitions() const;

 private:
  struct Entry {
    const Image* image = nullptr;
    bool large = false;
    int width = 0, height = 0;
    std::string data;  ///< base64; empty: left out
  };
  std::size_t encodeOnce(int widest, int width, bool large);
  double white_;
  std::vector<Entry> entries_;
  std::map<const Image*, std::size_t> index_;  ///< equal pictures share an entry
  std::map<std::string, std::size_t> byContent_;
};

}  // namespace burnish::cost
