// Builds a FramePlan out of a situation: passes in the order of the frame, each with the effects that call for it.
#pragma once
#include "plan/situation.h"

namespace burnish::plan {

class Builder {
 public:
  explicit Builder(const Situation& situation) : s(situation) {}
  const Situation& s;

  /// A pass that these effects call for (the ones that are on are kept). The reference holds until the next pass is added.
  PassPlan& pass(std::string_view name, std::initializer_list<std::string_view> effects, std::vector<std::string> reads, std::vector<std::string> writes);
  /// Puts a program on the pass, and on the plan unless it is there.
  void use(PassPlan& pass, const ProgramPlan& program);
  /// A program of post/screen.vert's triangle.
  void useScreen(PassPlan& pass, std::string name, std::string fragment, std::vector<std::string> defines);
  /// A target of the size at which pixels are shaded, or of one given. A second call with the same name adds its effects to the first's.
  void target(std::string_view name, std::string_view format, std::initializer_list<std::string_view> effects, glm::ivec2 size = {0, 0}, int levels = 1, int layers = 0);
  /// The plan, with every effect's passes, programs, targets and bytes filled in.
  FramePlan finish();

 private:
  [[nodiscard]] std::vector<std::string> thoseOn(std::initializer_list<std::string_view> effects) const;
  FramePlan plan_;
};

/// One step of the frame: adds its passes and targets when the situation has them.
using Step = void (*)(Builder&);
/// In the order of the frame.
std::span<const Step> steps();

// Steps, by file.
// passes_geometry.cpp
void addHostDepth(Builder& b);
void addDeformation(Builder& b);
void addShadowMaps(Builder& b);
void addGBuffer(Builder& b);
void addForward(Builder& b);
void addEmissive(Builder& b);
void addMotionVectors(Builder& b);
// passes_lighting.cpp
void addTiles(Builder& b);
void addLightClear(Builder& b);
void addOcclusion(Builder& b);
void addLighting(Builder& b);
void addBackground(Builder& b);
// passes_transparent.cpp
void addTransparent(Builder& b);
// passes_post.cpp
void addHostDraw(Builder& b);
void addTemporalAntialiasing(Builder& b);
void addExposure(Builder& b);
void addNonfiniteCount(Builder& b);
void addBloom(Builder& b);
void addToneMapping(Builder& b);
void addEdgeAntialiasing(Builder& b);
void addDebugView(Builder& b);
void addDepthOut(Builder& b);

/// What a pass reads that lights by the sky or by captured places.
void readSurroundings(const Situation& s, PassPlan& pass);

/// "NAME value", as shaders take it.
std::string define(std::string_view name, int value);
/// For programs that write or read the G-buffer's normals (interface/stored_normal.glsl).
std::string defineNormals(const Quality& quality);

}  // namespace burnish::plan
