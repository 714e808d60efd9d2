// Texts and figures of the page, its axes, colours and tables: what comes from outside cannot leave its place.
#include <burnish/measure.h>

#include <catch2/catch.hpp>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

#include "cost/csv.h"
#include "cost/json.h"
#include "cost/page_fixture.h"
#include "cost/page_pictures.h"
#include "cost/page_text.h"
#include "cost/plots.h"
#include "cost/plots_axis.h"
#include "cost/svg.h"

using namespace burnish;
using namespace burnish::cost;

TEST_CASE("Page: text is clean UTF-8 and cannot be markup", "[page]") {
  const std::string mark = "\xEF\xBF\xBD";
  CHECK(cleanText("plain äöü 漢字 🎲") == "plain äöü 漢字 🎲");
  CHECK(cleanText("a\tb\nc\rd") == "a b c d");
  // RFC 3629: stray and missing continuation bytes, overlong forms, surrogates, past U+10FFFF, cut off.
  for (const char* bad : {"\x80", "\xC3(", "\xC0\xAF", "\xE0\x80\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xF8\x88\x80\x80\x80", "\xE2\x82", "\xFF"}) {
    const std::string clean = cleanText(bad);
    INFO(clean);
    CHECK(clean.find(mark) != std::string::npos);
    CHECK(nlohmann::json(clean).dump().size() > 2);  // dump() throws where a text is no UTF-8
  }
  for (const char* hidden : {"\x01", "\x1b", "\x7f", "\u0085", "\u202E", "\u2067", "\u200F", "\uFFFF", "\u2028"}) CHECK(cleanText(hidden) == mark);
  CHECK(escaped("<a href=\"x\" b='y'>&amp;") == "&lt;a href=&quot;x&quot; b=&#39;y&#39;&gt;&amp;amp;");
  CHECK(slug("../../Etc/PASSWD \"x\"") == "etc-passwd-x");
  CHECK(slug("漢字") == "x");
  CHECK(slug(std::string(500, 'a')).size() == 48);
  CHECK(shortened("abcdef", 4) == "abc…");
  CHECK(shortened("äöüß", 4) == "äöüß");
}

TEST_CASE("Page: figures as people read them", "[page]") {
  CHECK(number(0.0123456) == "0.0123");
  CHECK(number(-12.3456, 4) == "−12.35");
  CHECK(number(99.96) == "100.0");  // rounds up into the next power: a digit more
  CHECK(number(0) == "0");
  CHECK(number(std::nan("")) == "n/a");
  CHECK(number(-INFINITY) == "−∞");
  CHECK(percent(0.0819) == "8.19 %");
  CHECK(signedPercent(0.0752) == "+7.52 %");
  CHECK(signedPercent(-0.0752) == "−7.52 %");
  CHECK(signedPercent(0) == "0 %");
  CHECK(duration(3725) == "1 h 2 min");
  CHECK(duration(65) == "1 min 5 s");
  CHECK(duration(-1) == "n/a");
  CHECK(spreadText({1.5, 1.4, 1.6, 7}) == "1.500 (1.400 to 1.600)");
  CHECK(spreadText({}) == "n/a");
}

TEST_CASE("Page: axes keep every value between their ends", "[page]") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::vector<double>> sets = {{}, {0, 0}, {5}, {1e-300, 1e300}, {kNan, INFINITY, -3, 2}, {0, 0.001, 0.2}, {1, 1.001}, {12, 13, 80}};
  for (const auto& values : sets)
    for (const Axis::Scale scale : {Axis::Scale::FromZero, Axis::Scale::Logarithmic, Axis::Scale::Automatic})
      for (const auto& [from, to] : {std::pair{100.0, 500.0}, std::pair{400.0, 50.0}}) {
        const Axis axis(values, scale, from, to, true);
        for (const double v : {kNan, -1e9, -1.0, 0.0, 1e-300, 0.1, 13.0, 1e300, double(INFINITY)}) {
          const double at = axis.at(v);
          CHECK(at >= std::min(from, to));
          CHECK(at <= std::max(from, to));
        }
        CHECK(axis.ticks().size() <= 101);
        double last = from;
        for (const AxisTick& t : axis.ticks()) {
          CHECK((t.at - last) * (to - from) >= -1e-6);  // in the axis's direction
          last = t.at;
        }
      }
  const Axis zero(std::vector<double>{0, 0.01, 0.1}, Axis::Scale::Logarithmic, 0, 300, true);
  CHECK(zero.hasZeroSlot());
  CHECK(zero.at(0) < zero.at(0.01));
  CHECK(zero.at(0.1) - zero.at(0.0316227766) == Approx(zero.at(0.0316227766) - zero.at(0.01)));
  const Axis linear(std::vector<double>{2, 4}, Axis::Scale::FromZero, 0, 300, false);
  CHECK(linear.at(0) == 0);
  CHECK(linear.at(4) == Approx(2 * linear.at(2)));
}

TEST_CASE("Page: texts are never wider than their place", "[page]") {
  for (const char* text : {"environment-specular", "WWWWWWWWWWWWWWWWWWWWWWWWWWWW", "漢字漢字漢字漢字漢字漢字", "short"})
    for (const double width : {20.0, 60.0, 140.0}) CHECK(textWidth(fitted(text, 12, width), 12) <= std::max(width, 13.0));
  CHECK(fitted("short", 12, 100) == "short");
}

TEST_CASE("Page: colours of differences grow lighter, so that they read in grey", "[page]") {
  double last = -1;
  for (int i = 0; i <= 100; ++i) {
    const auto c = differenceColour(i / 100.0);
    const auto linear = [&](int k) { return std::pow((c[k] / 255.0 + 0.055) / 1.055, 2.4); };
    const double y = 0.2126 * linear(0) + 0.7152 * linear(1) + 0.0722 * linear(2);
    CHECK(y >= last - 2e-3);  // bytes round
    last = y;
  }
  CHECK(last > 0.85);
  Image difference = makeImage(3, 1, 1, PixelType::F32);
  const float values[] = {0, 10, std::numeric_limits<float>::quiet_NaN()};
  std::memcpy(difference.data.data(), values, sizeof values);
  const Image shown = differencePicture(difference, 2);
  const auto white = differenceColour(1);
  CHECK(std::equal(white.begin(), white.end(), shown.u8() + 3));
  CHECK(shown.u8()[6] == 0);
  CHECK(shown.u8()[7] == 220);  // not finite: a colour that the scale has not
}

TEST_CASE("Page: base64 by RFC 4648's own examples", "[page]") {
  const auto of = [](std::string_view text) { return base64(std::as_bytes(std::span(text))); };
  CHECK(of("").empty());
  CHECK(of("f") == "Zg==");
  CHECK(of("fo") == "Zm8=");
  CHECK(of("foo") == "Zm9v");
  CHECK(of("foobar") == "Zm9vYmFy");
}

TEST_CASE("Page: cells of the table are RFC 4180's and no formulas", "[page]") {
  CHECK(csvCell("plain") == "plain");
  CHECK(csvCell("a,b") == "\"a,b\"");
  CHECK(csvCell("say \"x\"") == "\"say \"\"x\"\"\"");
  CHECK(csvCell("=1+1") == "'=1+1");
  CHECK(csvCell("  @SUM(A1)").find('\'') != std::string::npos);
  CHECK(csvCell("\t-1") == "' -1");
  CHECK(csvCell(" x") == "\" x\"");
  CHECK(csvCell("two\r\nlines") == "two  lines");
}

TEST_CASE("Page: pictures shrink to the space there is, and are left out where there is none", "[page]") {
  const test::MadeReport made = test::fullReport();
  const Image& large = made.cost.basePicture;
  const Image& small = made.cost.terms[0].rungs[0].picture;
  std::size_t before = 0;
  for (const std::size_t space : {4'000'000u, 400'000u, 60'000u, 100u}) {
    Report report;
    PagePictures pictures(0.25);
    pictures.want(large, true);
    for (const TermCost& t : made.cost.terms)
      for (const RungCost& r : t.rungs) pictures.want(r.picture, false), pictures.want(r.difference, false);
    pictures.want(Image{}, false);
    pictures.encode(space, report);
    const std::size_t size = pictures.definitions().size();
    CHECK(size < space + 120 * 100);  // elements around them
    if (before > 0) CHECK(size < before);
    before = size;
    if (space != 60'000) CHECK(pictures.has(small) == (space > 60'000));
    CHECK(report.empty() == (space > 60'000));
    CHECK(pictures.show(Image{}, "<none>").find("&lt;none&gt;") != std::string::npos);
  }
}

TEST_CASE("Page: JSON has no number that is not finite, whatever the report holds", "[page]") {
  const test::MadeReport made = test::hostileReport();
  const auto document = nlohmann::json::parse(costJson(made.cost, made.budgets));
  CHECK(document.at("seconds").is_null());
  CHECK(document.at("terms").at(3).at("rungs").size() == 60);
  CHECK(document.at("terms").at(1).at("rungs").empty());
  CHECK(document.at("terms").at(0).at("rungs").at(2).at("cpu_ms").is_null());
  CHECK(document.at("contributors").at(0).at("rms").is_null());
  CHECK(document.at("budgets").at(1).at("ms").is_null());
  CostReport gpu;
  gpu.clock = "GPU time";
  gpu.terms.emplace_back().rungs.emplace_back();
  CHECK(nlohmann::json::parse(costJson(gpu, {})).at("terms").at(0).at("rungs").at(0).contains("gpu_ms"));
}
