// Animations: their samplers and channels as they stand in the file.
#include "asset/document.h"

namespace burnish::asset {
namespace {

void parseSampler(const At& at, Check& check, AnimationSource& a) {
  SamplerSource& s = a.samplers.emplace_back();
  check.known(at, {"input", "interpolation", "output"});
  s.input = check.reference(at, "input", Table::Accessors, Need::Required);
  s.output = check.reference(at, "output", Table::Accessors, Need::Required);
  const std::string* kind = check.string(at, "interpolation");
  if (!kind || *kind == "LINEAR") return;
  if (*kind == "STEP")
    s.interpolation = Interpolation::Step;
  else if (*kind == "CUBICSPLINE")
    s.interpolation = Interpolation::CubicSpline;
  else
    check.warn(at.path() + "/interpolation", "an unknown interpolation is taken for LINEAR");
}

void parseChannel(const At& at, Check& check, AnimationSource& a) {
  ChannelSource& c = a.channels.emplace_back();
  check.known(at, {"sampler", "target"});
  const std::uint64_t sampler = check.integer(at, "sampler", 0, 0, Check::kMaxInteger, Need::Required);
  if (check.ok() && sampler >= a.samplers.size())
    check.fail(at.path() + "/sampler", "sampler " + std::to_string(sampler) + " does not exist");
  c.sampler = check.ok() ? int(sampler) : -1;
  check.withObject(
      at, "target",
      [&](const At& target) {
        check.known(target, {"node", "path"});
        c.node = check.reference(target, "node", Table::Nodes);
        if (const std::string* path = check.string(target, "path", Need::Required)) c.path = *path;
      },
      Need::Required);
}

}  // namespace

void parseAnimations(const At& root, Check& check, Document& doc) {
  check.eachObject(root, "animations", [&](const At& at, std::size_t) {
    AnimationSource& a = doc.animations.emplace_back();
    check.known(at, {"channels", "samplers"});
    if (const std::string* name = check.string(at, "name")) a.name = *name;
    check.eachObject(
        at, "samplers", [&](const At& s, std::size_t) { parseSampler(s, check, a); }, Need::Required);
    check.eachObject(
        at, "channels", [&](const At& c, std::size_t) { parseChannel(c, check, a); }, Need::Required);
  });
}

}  // namespace burnish::asset
