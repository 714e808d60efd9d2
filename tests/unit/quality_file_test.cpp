// Quality files: what is written is read again, and what nobody vouches for is one clear error.
#include <burnish/quality.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "file_sandbox.h"
#include "plan/quality_file.h"

using namespace burnish;
using file_test::bytesOf;

namespace {

/// A text that reads as something else, or an error with its three parts.
void fails(const std::string& text, const std::string& where, const std::string& what) {
  INFO(text.substr(0, 200));
  const auto read = plan::parseQuality(bytesOf(text), "q.json");
  REQUIRE_FALSE(read);
  INFO(read.error().message());
  CHECK(read.error().place == (where.empty() ? std::string("q.json") : "q.json: " + where));
  CHECK(read.error().what.find(what) != std::string::npos);
  CHECK_FALSE(read.error().remedy.empty());
}
std::string with(const std::string& members) { return R"({"schema_version": 1)" + (members.empty() ? "" : ", " + members) + "}"; }

Quality randomQuality(std::mt19937& random) {
  Quality q;
  for (std::size_t t = 0; t < terms().size(); ++t) setRung(q, t, random() % terms()[t].rungs.size());
  for (const plan::QualityNumber& n : plan::qualityNumbers()) {
    // Over all orders of magnitude of the range; now and then one of its ends.
    const double low = std::max(n.least, 1e-12), share = random() % 8 == 0 ? double(random() % 2) : double(random()) / 4294967295.0;
    const double value = low * std::pow(n.most / low, share);
    if (n.whole) q.*n.whole = std::clamp(int(std::lround(value)), int(n.least), int(n.most));
    else q.*n.number = std::clamp(float(value), float(n.least), float(n.most));
  }
  q.toneMap = ToneMap(random() % toneMapNames().size());
  return q;
}

/// All numbers are in range, whatever was read.
bool sound(const Result<Quality>& read) {
  if (!read) return read.error().place.rfind("q.json", 0) == 0 && !read.error().what.empty() && !read.error().remedy.empty();
  for (std::size_t t = 0; t < terms().size(); ++t)
    if (rungOf(*read, t) >= terms()[t].rungs.size()) return false;
  const auto numbers = plan::qualityNumbers();
  return std::all_of(numbers.begin(), numbers.end(), [&](const plan::QualityNumber& n) { return n.of(*read) >= float(n.least) && n.of(*read) <= float(n.most); });
}

}  // namespace

TEST_CASE("A quality that is written is read again to the last bit", "[quality]") {
  file_test::Sandbox box;
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    const Quality q = randomQuality(random);
    const std::filesystem::path file = box.root / "q.json";
    REQUIRE(writeQuality(file, q, round % 2 ? "a \"line\"\nof \xc3\xa4 text" : ""));
    const auto read = readQuality(file);
    INFO(file_test::Sandbox::get(file));
    REQUIRE(read);
    REQUIRE(*read == q);
  }
  CHECK(box.filesIn(box.root) == 3);  // the sandbox's two and the one file: nothing temporary stays
}

TEST_CASE("A quality file is for people: numbers are short, every term has a line, the exposure has none", "[quality]") {
  Quality q;
  q.exposureEv = 3.0f;
  q.bloomShare = 0.08f;
  const auto text = plan::qualityText(q, "for a laptop", "q.json");
  REQUIRE(text);
  CHECK(text->find("\"bloom_share\": 0.08,") != std::string::npos);
  const auto json = nlohmann::json::parse(*text);
  CHECK(json["schema_version"] == 1);
  CHECK(json["comment"] == "for a laptop");
  CHECK(json["terms"].size() == terms().size());
  CHECK(json["terms"]["fresnel"] == "schlick");
  CHECK(json["numbers"].size() == plan::qualityNumbers().size());
  CHECK(text->find("exposure") == std::string::npos);
  CHECK_FALSE(readQuality("/dev/null"));
  const auto read = plan::parseQuality(bytesOf(*text), "q.json");
  REQUIRE(read);
  CHECK_FALSE(read->exposureEv);
}

TEST_CASE("The base of a quality file is the nearest preset, and what the file leaves out is as in it", "[quality]") {
  for (const std::string_view name : presetNames()) {
    Quality preset;
    REQUIRE(setPreset(preset, name));
    CHECK(nlohmann::json::parse(plan::qualityText(preset, "", "q.json").value())["base"] == name);
    const auto read = plan::parseQuality(bytesOf(with("\"base\": \"" + std::string(name) + "\"")), "q.json");
    REQUIRE(read);
    CHECK(*read == preset);
    const auto changed = plan::parseQuality(bytesOf(with(R"("terms": {"bloom": "scatter"}, "numbers": {"shadow_maps": 3}, "base": ")" + std::string(name) + "\"")), "q.json");
    REQUIRE(changed);
    preset.bloom = Bloom::Scatter;
    preset.shadowMaps = 3;
    CHECK(*changed == preset);
  }
  CHECK(plan::parseQuality(bytesOf(with("")), "q.json").value() == Quality{});
}

TEST_CASE("Every fault of a quality file is one error that names its place and what there is", "[quality]") {
  fails("", "", "empty");
  fails("\n{x", "line 2, column 2", "not JSON");
  fails("[]", "/", "is array where an object is expected");
  fails("{}", "/", "'schema_version' is missing");
  fails(R"({"schema_version": 2})", "/schema_version", "2 is no version");
  fails(R"({"schema_version": 1.5})", "/schema_version", "1.5 is no version");
  fails(R"({"schema_version": "1"})", "/schema_version", "string is no version");
  fails(with(R"("schema_version": 1)"), "/schema_version", "given twice");
  fails(with(R"("term": {})"), "/term", "did you mean 'terms'?");
  fails(with(R"("exposure": 3)"), "/exposure", "is no part of a quality file");
  fails(with(R"("comment": 3)"), "/comment", "is number where a text");
  fails(with(R"("base": "defualt")"), "/base", "'defualt' is no preset (did you mean 'default'?)");
  fails(with(R"("base": 0)"), "/base", "is number where the name of preset");
  fails(with(R"("terms": [])"), "/terms", "is array where an object");
  fails(with(R"("terms": {"fresnl": "none"})"), "/terms/fresnl", "is no term (did you mean 'fresnel'?)");
  fails(with(R"("terms": {"fresnel": "schlik"})"), "/terms/fresnel", "'schlik' is no rung of fresnel (did you mean 'schlick'?)");
  fails(with(R"("terms": {"fresnel": 1})"), "/terms/fresnel", "is number where the name");
  fails(with(R"("terms": {"fresnel": "none", "fresnel": "none"})"), "/terms/fresnel", "given twice");
  fails(with(R"("numbers": 1)"), "/numbers", "is number where an object");
  fails(with(R"("numbers": {"shadow_map": 1})"), "/numbers/shadow_map", "is no number (did you mean 'shadow_maps'?)");
  fails(with(R"("numbers": {"shadow_maps": "3"})"), "/numbers/shadow_maps", "is string where a number");
  fails(with(R"("numbers": {"shadow_maps": 3.5})"), "/numbers/shadow_maps", "3.5 is not whole");
  fails(with(R"("numbers": {"shadow_maps": 1e999})"), "/numbers/shadow_maps", "not finite");
  fails(with(R"("tone_map": "filmic")"), "/tone_map", "'filmic' is no tone map");
  for (const plan::QualityNumber& n : plan::qualityNumbers()) {
    const std::string name(n.name);
    fails(with("\"numbers\": {\"" + name + "\": -1}"), "/numbers/" + name, "-1 is out of range");
    fails(with("\"numbers\": {\"" + name + "\": 1e30}"), "/numbers/" + name, "1e+30 is out of range");
    fails(with("\"numbers\": {\"" + name + "\": null}"), "/numbers/" + name, "is null where a number");
  }
  fails(std::string(100, '[') + std::string(100, ']'), "", "nested deeper");
  fails(with("\"comment\": [" + [] {
          std::string many;
          for (int i = 0; i < 10000; ++i) many += "0,";
          return many + "0";
        }() + "]"), "", "more than");
  // What the file calls things does not reach a terminal as it is.
  const auto odd = plan::parseQuality(bytesOf(with("\"terms\": {\"\\u001b[2J\": \"x\"}")), "q.json");
  REQUIRE_FALSE(odd);
  CHECK(odd.error().message().find('\x1b') == std::string::npos);
  const auto oddRung = plan::parseQuality(bytesOf(with("\"terms\": {\"bloom\": \"\\u001b[2J\"}")), "q.json");
  REQUIRE_FALSE(oddRung);
  CHECK(oddRung.error().message().find('\x1b') == std::string::npos);
}

TEST_CASE("A quality that no file could bring back is not written", "[quality]") {
  file_test::Sandbox box;
  const std::filesystem::path file = box.root / "q.json";
  for (const plan::QualityNumber& n : plan::qualityNumbers()) {
    Quality q;
    if (n.whole) q.*n.whole = int(n.most) + 1;
    else q.*n.number = std::numeric_limits<float>::quiet_NaN();
    const auto written = writeQuality(file, q);
    REQUIRE_FALSE(written);
    CHECK(written.error().what.find(std::string(n.name)) != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(file));
  }
}

TEST_CASE("A quality file is bounded before it is read, and must be a file", "[quality]") {
  file_test::Sandbox box;
  const std::filesystem::path big = box.root / "big.json";
  box.put(big, std::string(plan::kMostQualityBytes + 1, ' '));
  const auto read = readQuality(big);
  REQUIRE_FALSE(read);
  CHECK(read.error().place.find("big.json") != std::string::npos);
  CHECK_FALSE(readQuality(box.root));
  CHECK_FALSE(readQuality(box.root / "none.json"));
}

TEST_CASE("A damaged quality file is an error or a sound quality", "[quality][hostile]") {
  const std::string good = plan::qualityText(Quality{}, "x", "q.json").value();
  for (std::size_t n = 0; n + 2 < good.size(); ++n) {  // without its last brace and line end
    INFO("cut at " << n);
    const std::string cut = good.substr(0, n);
    const auto read = plan::parseQuality(bytesOf(cut), "q.json");
    REQUIRE_FALSE(read);
    REQUIRE(sound(read));
  }
  std::mt19937 random(20261129);
  int kept = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string changed = good;
    for (unsigned flips = 1 + random() % 5; flips > 0; --flips) {
      char& c = changed[random() % changed.size()];
      c = random() % 2 ? char(c ^ char(1u << random() % 8)) : "{}[]\",:0123456789.-e \\"[random() % 22];
    }
    if (round % 7 == 0) changed.erase(random() % changed.size(), random() % 40);
    if (round % 11 == 0) changed.insert(random() % changed.size(), good.substr(random() % good.size(), 60));
    const auto read = plan::parseQuality(bytesOf(changed), "q.json");
    INFO(changed);
    REQUIRE(sound(read));
    kept += read ? 1 : 0;
  }
  CHECK(kept > 10);  // some damage is none: the numbers and the comment may say something else
}
