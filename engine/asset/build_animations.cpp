// Skins and animations of the shown nodes (glTF 2.0, sections 3.7.3 and 3.11).
#include <fmt/format.h>

#include "asset/gather.h"

namespace burnish::asset {
namespace {

std::vector<float> readNumbers(Builder& b, int accessor, const std::string& path) {
  std::vector<float> out;
  const Accessor& a = accessorAt(b, accessor);
  const std::uint64_t n = std::uint64_t(a.components());
  if (a.count * n * sizeof(float) > b.bytesLeft) {
    b.check.fail(path, "the animations stand for far more data than the file holds", "share samplers between channels");
    return out;
  }
  b.bytesLeft -= a.count * n * sizeof(float);
  const Elements e(b.doc, a);
  if (!e.available()) return out;
  out.resize(a.count * n);
  e.each([&](std::uint64_t i, const double* v) {
    for (std::uint64_t c = 0; c < n; ++c)
      out[i * n + c] = float(a.normalized ? std::max(v[c] * e.scale(), -1.0) : v[c]);
  });
  return out;
}

AnimationSampler buildSampler(Builder& b, const SamplerSource& source, const std::string& path) {
  AnimationSampler s{source.interpolation, readNumbers(b, source.input, path + "/input"),
                     readNumbers(b, source.output, path + "/output")};
  if (!b.check.ok()) return {};
  if (s.times.empty() || s.values.empty()) {
    b.check.warn(path, "the buffers of this sampler have no data: what it moves stays at rest");
    return {};
  }
  // Accessors without a view are zeros, which the validator does not look at.
  for (std::size_t i = 1; i < s.times.size(); ++i)
    if (!(s.times[i] > s.times[i - 1])) {
      b.check.warn(path + "/input", "the times do not grow: what the sampler moves stays at rest");
      return {};
    }
  return s;
}

std::optional<AnimationChannel::Path> pathOf(const std::string& name) {
  using Path = AnimationChannel::Path;
  constexpr std::pair<std::string_view, Path> kPaths[] = {{"translation", Path::Translation},
                                                          {"rotation", Path::Rotation},
                                                          {"scale", Path::Scale},
                                                          {"weights", Path::Weights}};
  for (const auto& [text, path] : kPaths)
    if (name == text) return path;
  return {};  // the validator warned
}

void buildAnimation(Builder& b, const AnimationSource& source, const std::vector<int>& shown, const std::string& path,
                    Animation& out) {
  out.name = source.name;
  for (const ChannelSource& c : source.channels) {
    const auto kind = pathOf(c.path);
    if (c.node < 0) b.check.warn(path + "/channels", "channels without a node are ignored");
    if (kind && c.node >= 0 && shown[std::size_t(c.node)] >= 0)
      out.channels.push_back({*kind, c.sampler, shown[std::size_t(c.node)]});
  }
  std::vector<bool> used(source.samplers.size());
  for (const AnimationChannel& c : out.channels) used[std::size_t(c.sampler)] = true;
  out.samplers.resize(source.samplers.size());
  for (std::size_t s = 0; b.check.ok() && s < used.size(); ++s)
    if (used[s]) out.samplers[s] = buildSampler(b, source.samplers[s], fmt::format("{}/samplers/{}", path, s));
  std::erase_if(out.channels,
                [&](const AnimationChannel& c) { return out.samplers[std::size_t(c.sampler)].times.empty(); });
}

void buildSkin(Builder& b, const SkinSource& source, const std::vector<int>& shown, const std::string& path, Skin& out) {
  out.name = source.name;
  for (const int joint : source.joints) {
    if (shown[std::size_t(joint)] < 0) return out.joints.clear();
    out.joints.push_back(shown[std::size_t(joint)]);
  }
  if (source.inverseBindMatrices < 0) return;
  const Elements e(b.doc, accessorAt(b, source.inverseBindMatrices));
  if (!e.available()) {
    b.check.warn(path, "the buffers of this skin have no data: its meshes are shown in their bind pose");
    return out.joints.clear();
  }
  double m[16];
  for (std::size_t i = 0; i < out.joints.size(); ++i) {
    e.at(i, m);
    glm::mat4& to = out.inverseBind.emplace_back(1.0f);
    for (int k = 0; k < 16; ++k)
      if (k % 4 != 3) to[k / 4][k % 4] = float(m[k]);
  }
}

}  // namespace

void buildMotion(Check& check, const Document& doc, const std::vector<int>& shown, std::uint64_t sourceBytes, Asset& asset) {
  Builder b{check, doc, outputBudget(sourceBytes)};
  asset.skins.resize(doc.skins.size());
  for (std::size_t i = 0; i < doc.skins.size(); ++i)
    buildSkin(b, doc.skins[i], shown, fmt::format("/skins/{}", i), asset.skins[i]);
  for (Node& n : asset.nodes)
    if (n.skin >= 0 && asset.skins[std::size_t(n.skin)].joints.empty()) n.skin = -1;
  asset.animations.resize(doc.animations.size());
  for (std::size_t i = 0; check.ok() && i < doc.animations.size(); ++i)
    buildAnimation(b, doc.animations[i], shown, fmt::format("/animations/{}", i), asset.animations[i]);
}

}  // namespace burnish::asset
