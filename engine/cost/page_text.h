// Text of a report. What comes from scenes, drivers and hosts is untrusted: it leaves here as valid UTF-8 without control characters, escaped for where it goes. Figures as people read them.
#pragma once
#include <burnish/measure.h>

#include <string>
#include <string_view>

namespace burnish::cost {

/// Valid UTF-8 without control characters, non-characters and marks that turn the direction of text (each is U+FFFD; tab and line ends are a space).
std::string cleanText(std::string_view text);
/// Clean text for HTML and XML, as content and inside of double quotes.
std::string escaped(std::string_view text);
/// A file name's part: a to z, 0 to 9 and '-', at most 48; "x" where nothing is left.
std::string slug(std::string_view text);
/// Not more than `most` code points, the last an ellipsis where something was cut.
std::string shortened(std::string_view text, std::size_t most);

/// `digits` significant ones without an exponent between 1e-4 and 1e7, "−" for minus, "n/a" for NaN, "∞".
std::string number(double value, int digits = 3);
/// 0.0123 is "1.23 %".
std::string percent(double share, int digits = 3);
/// With its sign, also "+"; 0 has none.
std::string signedPercent(double share);
/// 3725 is "1 h 2 min".
std::string duration(double seconds);
/// "12.34" and, of more than one, its spread: " (12.1 to 12.5)"; "n/a" where nothing was measured.
std::string spreadText(const Spread& spread);

/// Whether anything was measured: a picture that was compared has a psnr above 0.
bool measured(const PictureError& error);
bool measured(const Spread& spread);
/// Errors count against ground truth and not against the preset `exact` alone.
bool hasTruth(const CostReport& cost);
/// The preset that has this point's rungs on top of the base quality; empty: none.
std::string_view presetOf(const CostReport& cost, const FrontPoint& point);

}  // namespace burnish::cost
