// Animations: read only to be checked, and to be named in a warning.
#include "asset/document.h"

namespace burnish::asset {
namespace {

void parseSampler(const At& at, Check& check, Animation& a) {
  AnimationSampler& s = a.samplers.emplace_back();
  check.known(at, {"input", "interpolation", "output"});
  s.input = check.reference(at, "input", Table::Accessors, Need::Required);
  s.output = check.reference(at, "output", Table::Accessors, Need::Required);
  if (const std::string* kind = check.string(at, "interpolation")) s.cubic = *kind == "CUBICSPLINE";
}

void parseChannel(const At& at, Check& check, Animation& a) {
  AnimationChannel& c = a.channels.emplace_back();
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
    Animation& a = doc.animations.emplace_back();
    check.known(at, {"channels", "samplers"});
    check.eachObject(
        at, "samplers", [&](const At& s, std::size_t) { parseSampler(s, check, a); }, Need::Required);
    check.eachObject(
        at, "channels", [&](const At& c, std::size_t) { parseChannel(c, check, a); }, Need::Required);
  });
}

}  // namespace burnish::asset
