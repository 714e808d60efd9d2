// Names as the command line spells them.
#include <burnish/plan.h>

#include <array>

namespace burnish {
namespace {
constexpr std::array<std::string_view, 4> kToneMaps{"none", "neutral", "agx", "aces"};
constexpr std::array<std::string_view, 12> kDebugViews{"final", "albedo", "substance", "normal", "roughness", "depth", "position", "occlusion", "lights", "nonfinite", "anisotropy", "diffuse-roughness"};
}  // namespace

std::span<const std::string_view> toneMapNames() { return kToneMaps; }
std::span<const std::string_view> debugViewNames() { return kDebugViews; }

}  // namespace burnish
