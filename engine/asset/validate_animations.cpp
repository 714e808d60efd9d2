// Animations against the nodes and accessors that they name (glTF 2.0, section 3.11).
#include <fmt/format.h>

#include "asset/document.h"

namespace burnish::asset {
namespace {

void checkSamplerInput(Check& check, Document& doc, const SamplerSource& s, const std::string& path) {
  const Accessor& a = doc.accessors[std::size_t(s.input)];
  if (a.shape != Shape::Scalar || a.component != Component::F32)
    return check.fail(path, fmt::format("accessor {} is {}, not SCALAR of FLOAT", s.input,
                                        formatName(a.shape, a.component, a.normalized)));
  if (a.min.empty() || a.max.empty())
    return check.fail(path, fmt::format("accessor {} has no min and max, which times need", s.input));
  if (s.cubic() && a.count < 2) return check.fail(path, "a cubic spline needs two key frames at least");
  useView(check, doc, a.view, Usage::Animation, path);
}

bool outputFits(const Accessor& a, const std::string& path) {
  const bool packed = a.component == Component::F32 || (a.normalized && a.component != Component::U32);
  if (path == "rotation") return a.shape == Shape::Vec4 && packed;
  if (path == "weights") return a.shape == Shape::Scalar && packed;
  return a.shape == Shape::Vec3 && a.component == Component::F32;
}

void checkChannel(Check& check, Document& doc, const AnimationSource& animation, const ChannelSource& c,
                  const std::string& path) {
  if (c.path != "translation" && c.path != "rotation" && c.path != "scale" && c.path != "weights")
    return check.warn(path + "/target/path", fmt::format("unknown animation path '{}'", c.path.substr(0, 40)));
  std::uint64_t width = 1;
  if (c.node >= 0) {
    const NodeSource& n = doc.nodes[std::size_t(c.node)];
    if (n.hasMatrix && c.path != "weights")
      return check.fail(path + "/target",
                        fmt::format("node {} has a matrix, so its {} cannot be animated", c.node, c.path));
    const std::size_t targets = n.mesh < 0 ? 0 : doc.meshes[std::size_t(n.mesh)].primitives[0].targets.size();
    if (c.path == "weights" && targets == 0)
      return check.fail(path + "/target", fmt::format("node {} has no morph targets to weigh", c.node));
    if (c.path == "weights") width = targets;
  }
  const SamplerSource& s = animation.samplers[std::size_t(c.sampler)];
  const Accessor& a = doc.accessors[std::size_t(s.output)];
  if (!outputFits(a, c.path))
    return check.fail(path + "/sampler", fmt::format("output accessor {} is {}, which {} cannot be", s.output,
                                                     formatName(a.shape, a.component, a.normalized), c.path));
  const std::uint64_t expected = doc.accessors[std::size_t(s.input)].count * (s.cubic() ? 3 : 1) * width;
  if (a.count != expected && (c.node >= 0 || c.path != "weights"))
    check.fail(path + "/sampler",
               fmt::format("output accessor {} has {} elements, {} are expected", s.output, a.count, expected));
}

void checkDuplicates(Check& check, const AnimationSource& animation, const std::string& path) {
  std::map<std::pair<int, std::string_view>, std::size_t> seen;
  for (std::size_t i = 0; check.ok() && i < animation.channels.size(); ++i) {
    const ChannelSource& c = animation.channels[i];
    if (c.node < 0) continue;
    const auto [first, fresh] = seen.try_emplace({c.node, c.path}, i);
    if (!fresh)
      check.fail(fmt::format("{}/channels/{}/target", path, i),
                 fmt::format("channel {} has the same target", first->second));
  }
}

}  // namespace

void validateAnimations(Check& check, Document& doc) {
  for (std::size_t i = 0; check.ok() && i < doc.animations.size(); ++i) {
    const AnimationSource& animation = doc.animations[i];
    const std::string path = fmt::format("/animations/{}", i);
    for (std::size_t s = 0; check.ok() && s < animation.samplers.size(); ++s) {
      const std::string place = fmt::format("{}/samplers/{}", path, s);
      checkSamplerInput(check, doc, animation.samplers[s], place + "/input");
      useView(check, doc, doc.accessors[std::size_t(animation.samplers[s].output)].view, Usage::Animation,
              place + "/output");
    }
    for (std::size_t c = 0; check.ok() && c < animation.channels.size(); ++c)
      checkChannel(check, doc, animation, animation.channels[c], fmt::format("{}/channels/{}", path, c));
    checkDuplicates(check, animation, path);
  }
}

}  // namespace burnish::asset
