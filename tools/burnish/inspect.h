// The parts of `burnish inspect`. Each prints what it finds on standard output.
#pragma once
#include <burnish/probe.h>

namespace cli {

inline constexpr float kMostHalf = 65504;  ///< the largest half float

void printScene(const burnish::Scene& scene, const burnish::Report& report, const std::string& name);
void printPicture(const burnish::Image& image, const std::string& name);
/// `cube` with its values as stored.
void printCubemap(const burnish::EnvironmentFile& cube, const burnish::Report& report, const std::string& name);
void printProbes(const burnish::ProbeFolder& folder, const std::string& name);
void printSubstance(const burnish::Substance& substance);

/// What a range of substance codes means: "dielectric, F0 0.040 (IOR 1.50)", "metal 100 %", "dielectric of F0 0.040 (IOR 1.50) to metal 80 %".
std::string describeCodes(float least, float most);

}  // namespace cli
