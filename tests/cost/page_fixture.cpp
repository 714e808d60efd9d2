#include "cost/page_fixture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace burnish::test {
namespace {

constexpr int kWidth = 320, kHeight = 180;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();

/// A ball with a highlight in front of a wall, linear luminance; `gloss` and `gain` change the highlight.
double luminance(double x, double y, double gloss, double gain) {
  const double cx = (x - kWidth * 0.5) / 62, cy = (y - kHeight * 0.52) / 62, r2 = cx * cx + cy * cy;
  if (r2 > 1) return 0.10 + 0.25 * y / kHeight + 0.03 * std::sin(x * 0.35) * std::sin(y * 0.35);
  const double nz = std::sqrt(1 - r2), toLight = std::max(0.0, (-0.5 * cx - 0.6 * cy + 0.62 * nz)), half = std::max(0.0, (-0.27 * cx - 0.33 * cy + 0.90 * nz));
  return 0.03 + 0.45 * toLight + gain * std::pow(half, gloss);
}

Image picture(double gloss, double gain) {
  Image out = makeImage(kWidth, kHeight, 3, PixelType::U8);
  for (int i = 0; i < kWidth * kHeight; ++i) {
    const double v = luminance(i % kWidth, i / kWidth, gloss, gain);
    const double tint[] = {1.0, 0.86, 0.70};
    for (int c = 0; c < 3; ++c) out.u8()[3 * i + c] = static_cast<std::uint8_t>(std::lround(255 * std::pow(std::clamp(v * tint[c], 0.0, 1.0), 1 / 2.2)));
  }
  return out;
}

Image difference(double gloss, double gain, double otherGloss, double otherGain) {
  Image out = makeImage(kWidth, kHeight, 1, PixelType::F32);
  for (int i = 0; i < kWidth * kHeight; ++i)
    out.f32()[i] = static_cast<float>(std::abs(luminance(i % kWidth, i / kWidth, gloss, gain) - luminance(i % kWidth, i / kWidth, otherGloss, otherGain)));
  return out;
}

Spread spread(double median, double part = 0.012) { return {median, median * (1 - part), median * (1 + part * 1.3), 7}; }

PictureError error(double rms, double rmsSpread = 0) {
  PictureError e;
  e.rms = rms, e.rmsSpread = rmsSpread;
  e.psnr = rms > 0 ? -20 * std::log10(rms) + 6 : kInfinity;
  e.perceptual = rms * 22, e.p999 = rms * 9, e.energy = -rms * 0.4;
  return e;
}

TermCost term(const char* name, std::initializer_list<const char*> rungs, std::size_t base, double scale, double slow = 1) {
  TermCost t;
  t.name = name, t.what = fmt::format("what {} is", name), t.calledBy = "12 instances with such materials";
  const double gloss = 30 + 20 * std::sqrt(scale) * 5;  // other pictures for each term
  t.exactRung = *(rungs.end() - 1), t.exactPicture = picture(gloss, 0.5);
  std::size_t i = 0;
  for (const char* rung : rungs) {
    RungCost r;
    const double left = static_cast<double>(rungs.size() - 1 - i);
    const bool last = left == 0;
    r.name = rung, r.inForce = i == base, r.dominated = i == 1 && rungs.size() > 3;
    const double ms = 4.1 + 0.35 * static_cast<double>(i) + (r.dominated ? 1.2 : 0), rms = last ? 0 : scale * std::pow(left, 1.7);
    r.passMs = spread(last ? ms * slow : ms), r.frameMs = spread(r.passMs.median + 9), r.exactPassMs = spread(r.passMs.median * 1.8);
    r.exact = error(rms), r.exactRest = error(rms * 0.8), r.truth = error(std::hypot(rms, 0.06), 0.002);
    r.picture = picture(gloss - 6 * left, 0.5 - 0.04 * left), r.difference = difference(gloss - 6 * left, 0.5 - 0.04 * left, gloss, 0.5);
    if (r.dominated) r.note = "slower than the next one, which is more exact";
    t.rungs.push_back(r);
    ++i;
  }
  return t;
}

FrontPoint point(std::initializer_list<std::pair<const char*, const char*>> rungs, double ms, double rms) {
  FrontPoint p;
  for (const auto& [name, rung] : rungs) {
    static_cast<void>(setRung(p.quality, name, rung));
    p.settings.push_back(fmt::format("{}={}", name, rung));
  }
  p.ms = spread(ms), p.error = error(rms, 0.002);
  return p;
}

/// 40 qualities over a curve; every one that another beats is dominated.
std::vector<FrontPoint> front() {
  std::vector<FrontPoint> points;
  for (int i = 0; i < 40; ++i) {
    FrontPoint p;
    // Each another quality: the digits of i choose rungs.
    for (int d = 0, rest = i; d < 3; ++d, rest /= 4) {
      const std::size_t t[] = {2, 5, 6};
      setRung(p.quality, t[d], static_cast<std::size_t>(rest % 4));
      p.settings.push_back(fmt::format("{}={}", terms()[t[d]].name, terms()[t[d]].rungs[static_cast<std::size_t>(rest % 4)].name));
    }
    if (p.quality == Quality{}) continue;  // the base, which follows
    const double x = i / 39.0, off = std::abs(std::sin(i * 2.4)) * (i % 3 ? 1 : 0);
    p.ms = spread(7 + 11 * x + 2 * off), p.error = error(0.05 + 0.25 * std::pow(1 - x, 2.2) + 0.07 * off, 0.002);
    points.push_back(p);
  }
  return points;
}

void judge(std::vector<FrontPoint>& points) {
  for (FrontPoint& p : points)
    p.dominated = std::any_of(points.begin(), points.end(), [&](const FrontPoint& o) { return o.ms.median < p.ms.median && o.error.rms < p.error.rms; });
}

}  // namespace

MadeReport fullReport() {
  MadeReport out;
  CostReport& c = out.cost;
  c.scene = "fps", c.camera = "hero", c.command = "burnish cost fps --camera hero --size 640x360 --reference fps.exr -o cost";
  c.size = {640, 360}, c.machine.renderer = "llvmpipe (LLVM 15.0.6, 256 bits)", c.machine.version = "4.5 (Core Profile) Mesa 22.3.6", c.machine.software = true;
  c.backend = "egl", c.cpu = "A processor of two cores at 2.1 GHz", c.clock = "CPU time", c.against = "ground truth", c.referenceSamples = 512, c.referenceNoise = 0.013, c.seconds = 634;
  c.terms = {term("geometry", {"void", "kelemen", "schlick-smith", "smith", "v-cavity"}, 1, 0.03), term("fresnel", {"none", "schlick", "spherical-gaussian", "dielectric"}, 1, 0.022),
             term("diffuse", {"lambert", "lambert-fresnel", "coupled-fit", "coupled", "oren-nayar-energy"}, 2, 0.018), term("environment-specular", {"none", "schlick", "rough-schlick", "dfg", "sampled"}, 3, 0.05, 60),
             term("compensation", {"none", "multiple-scattering"}, 0, 0.01), term("lobe", {"pow", "exp2", "stable"}, 2, 1e-6)};
  c.terms.push_back(term("shadow-resolution", {"256", "512", "1024", "2048", "4096"}, 2, 0.006));
  c.terms.back().choice = true;
  c.front = front();
  Quality seed, exact;
  static_cast<void>(setPreset(seed, "seed")), static_cast<void>(setPreset(exact, "exact"));
  FrontPoint p = point({}, 6.6, 0.34);
  p.quality = seed, p.settings = {"geometry=void", "normalization=plus-8", "diffuse=lambert"};
  c.front.insert(c.front.begin(), p);
  c.base = point({}, 12.4, 0.118);
  c.exact = point({}, 96, 0.041);
  c.exact.quality = exact, c.exact.settings = {"fresnel=dielectric", "diffuse=oren-nayar-energy", "environment-specular=sampled"};
  c.front.push_back(c.base), c.front.push_back(c.exact);
  judge(c.front);
  c.contributors = {{"ambient (sh-l2)", 0.021}, {"environment-specular (dfg)", 0.0124}, {"shadow (pcf)", 0.0081}, {"geometry (kelemen)", 0.0032}, {"diffuse (coupled-fit)", 0.0009}, {"lobe (stable)", -0.0002}};
  c.truthPicture = picture(44, 0.52), c.basePicture = picture(34, 0.46), c.exactPicture = picture(40, 0.5);
  c.baseDifference = difference(34, 0.46, 44, 0.52), c.exactDifference = difference(40, 0.5, 44, 0.52);
  c.differenceScale = 0.25;
  c.idle = {{"anisotropy", "no material in view is brushed"}, {"occlusion", "no material in view brings baked occlusion, and the screen's rungs are off"}, {"reflection", "the scene has no probes"}};
  c.warnings = {"fresnel=conductor needs the forward path: left out", "the reference's noise is over a tenth of the error of 3 rungs"};
  std::vector<FrontPoint> line = c.front;
  std::erase_if(line, [](const FrontPoint& f) { return f.dominated; });
  std::sort(line.begin(), line.end(), [](const FrontPoint& a, const FrontPoint& o) { return a.ms.median < o.ms.median; });
  const auto after = std::find_if(line.begin(), line.end(), [](const FrontPoint& f) { return f.ms.median > 9.3; });
  BudgetResult b;
  b.ms = 9.3, b.met = true, b.best = after[-1], b.next = *after, b.measured = 64;
  out.budgets.push_back(b);
  b.ms = 6.2, b.met = false, b.best = line[0], b.next = line[1], b.measured = 31;
  out.budgets.push_back(b);
  const auto exactEnough = std::find_if(line.begin(), line.end(), [](const FrontPoint& f) { return f.error.rms < 0.06; });
  b.ms = 0, b.targetError = 0.06, b.met = true, b.best = *exactEnough, b.next.reset(), b.measured = 48;
  out.budgets.push_back(b);
  return out;
}

MadeReport hostileReport() {
  MadeReport out = fullReport();
  CostReport& c = out.cost;
  const std::string script = "</script></style></title><script>document.title='owned';throw new Error('owned')</script><img src=x onerror=\"throw 1\">";
  c.scene = script, c.camera = "=HYPERLINK(\"http://example.invalid\")&amp;<b>", c.command = "\" onmouseover=\"alert(1)\" x='" + std::string(600, 'w') + "'";
  c.cpu = std::string("nul ") + '\0' + " bell \a escape \x1b[31m", c.backend = "broken \xff\xfe\xc3( \xed\xa0\x80 utf-8", c.machine.renderer = "turned \u202Etxet\u202C", c.clock = "CPU time ]]>";
  c.warnings = {"@SUM(1+1)*cmd|' /C calc'!A0", script, std::string(3000, 'x'), ""};
  c.idle = {{script, "javascript:alert(1)"}, {"-1+1", "<svg onload=alert(1)>"}};
  c.contributors = {{script, kNan}, {"<i>", kInfinity}, {std::string(200, 'M'), 0.01}, {"&", -0.004}};
  TermCost& first = c.terms[0];
  first.name = "../../etc/passwd\"><script>throw 2</script>", first.what = script, first.calledBy = script, first.rungs[0].name = "=1+1,\"quoted\"\r\nline", first.rungs[0].note = "+cmd|'x'";
  first.rungs[1].name = std::string(300, 'W');
  first.rungs[2].exact.rms = kNan, first.rungs[2].passMs = {kNan, kNan, kNan, 5}, first.rungs[3].exact.rms = kInfinity, first.rungs[3].passMs = {kInfinity, 0, kInfinity, 5};
  first.rungs[3].difference.f32()[0] = static_cast<float>(kNan), first.rungs[3].difference.f32()[1] = static_cast<float>(kInfinity);
  c.terms[1].name = first.name;  // two of one name
  c.terms[1].rungs.clear();
  c.terms[2].rungs.resize(1);
  const RungCost one = c.terms[3].rungs[0];
  c.terms[3].rungs.assign(60, one);
  for (std::size_t i = 0; i < 60; ++i) {
    RungCost& r = c.terms[3].rungs[i];
    r.name = fmt::format("rung {}", i), r.passMs = spread(1e-7 * std::pow(3.0, static_cast<double>(i) * 0.6)), r.exact = error(i == 59 ? 0 : 1e-30 * std::pow(10.0, static_cast<double>(i)));
    r.inForce = i == 20;
  }
  c.terms[4].rungs[0].picture.data.resize(10);  // says more pixels than there are
  c.terms[4].rungs[1].picture = Image{};
  c.front[3].settings = {script, "=1"}, c.front[4].error.rms = kNan, c.front[5].ms = {kInfinity, 0, 0, 3}, c.front[6].ms.median = -1, c.front[7].error.rms = 0;
  c.base.error.psnr = kNan, c.base.error.perceptual = kInfinity, c.seconds = kNan, c.referenceNoise = kInfinity, c.differenceScale = kNan;
  out.budgets[0].best.settings = {script}, out.budgets[0].ms = 1e300, out.budgets[1].ms = kInfinity, out.budgets[2].targetError = 1e-300;
  return out;
}

}  // namespace burnish::test
