// Filters a cube on the GPU while a program runs: what a probe is refreshed with after its surroundings were drawn. Nothing else needs it: pictures are filtered on the CPU
// (prefilter::prefilterCubemap), whose definition of a level this keeps, L_k(R) = Σ L w ω / Σ w ω over the source's texels as points, to a looser bound (docs/prefilter_gpu.md).
#pragma once
#include <burnish/image.h>

#include <array>
#include <vector>

#include "gl/objects.h"
#include "gl/program.h"
#include "gpu_scene/cube_filter_parts.h"

namespace burnish::gpu_scene {

struct CubeFilterOptions {
  ReflectionLobe lobe = ReflectionLobe::BlinnPhong;
  CubeFilterEffort effort;
  /// Work of one slice at most, in points summed for a texel times texels, about; a slice draws at least one row of a face.
  double sliceWork = 8e6;
};

/// The method is that of multilevel summation (Brandt and Lubrecht 1990): the source's points are brought onto grids of half as many points an axis, one after another, by the adjoint of Lagrange's
/// interpolation, and each lobe is summed over the grids that are fine enough for it. Everything is drawn with the state that gl::setDefaults leaves; what is bound meanwhile is unbound again, and
/// viewport and scissor test are put back. Textures are made in the first begin() and kept. The context must be current in every call; device and cache must outlive the filter.
class CubeFilter {
 public:
  CubeFilter(gl::Device& device, gl::ProgramCache& programs, const CubeFilterOptions& options = {});

  /// source: a cube, a power of two from 16 texels along an edge on; level 0 is read, with what is no number taken for black, and infinite or negative values held. target: a GL_RGBA16F cube, as wide
  /// or a smaller power of two; level 0 becomes the source (its mean over solid angle where smaller), level k of `levels` what roughness shading::environmentRoughness(k, levels - 1) makes of it.
  /// Both must live until the last slice. Nothing is drawn yet; what an earlier begin() left undone is forgotten.
  Result<void> begin(const gl::Texture& source, const gl::Texture& target);
  /// The next piece of the work; true: that was the last. The bytes do not depend on what is drawn between slices or on their size; until the last one levels hold new and old faces side by side.
  Result<bool> filterSlice();
  /// All slices.
  Result<void> filter(const gl::Texture& source, const gl::Texture& target);

  /// Of the current begin().
  [[nodiscard]] int slices() const { return int(slices_.size()); }
  [[nodiscard]] int slicesDone() const { return next_; }
  /// The level that slice i draws into; -1: grids and irradiance.
  [[nodiscard]] int levelOf(int slice) const { return slices_[std::size_t(slice)].level; }
  /// Points that are summed for a texel of a level, about.
  [[nodiscard]] double pointsOf(int level) const { return pointsSummed(levels_[std::size_t(level)]); }

  /// Irradiance / π of the source as GL_RGBA32F pixels (k, 0), k = 0 to 8: coefficients as prefilter::EnvironmentLight::irradiance. There after the second slice. It stays on the GPU, so that a refresh
  /// waits for nothing: shaders fetch it, or it is copied into the buffer that they read.
  [[nodiscard]] const gl::Texture& irradiance() const { return irradiance_; }
  /// The same on the CPU; waits for the GPU.
  [[nodiscard]] std::array<glm::vec3, 9> readIrradiance() const;

 private:
  enum class Step : std::uint8_t { Gather, Coarsen, LevelZero, Level };
  struct Slice {
    Step step = Step::Gather;
    int level = -1, face = 0, row = 0, rows = 0;
  };
  struct Drawing;  // state of a slice, put back at its end
  Result<void> prepare(int sourceSize);
  void listSlices();
  Result<void> draw(const Slice& slice, Drawing& drawing);
  Result<void> gather(Drawing& drawing);
  Result<void> coarsen(Drawing& drawing);
  Result<void> drawFace(const Slice& slice, Drawing& drawing);

  gl::Device& device_;
  gl::ProgramCache& programs_;
  CubeFilterOptions options_;
  std::vector<CubeGrid> grids_;  // of sources of this size, the finest first
  gl::Texture atlas_, scratch_, irradiance_;
  gl::Framebuffer atlasTarget_, scratchTarget_, irradianceTarget_;
  gl::VertexArray none_;
  gl::Sampler nearest_;
  gl::Buffer parts_;
  std::size_t partsStride_ = 0;
  GLuint source_ = 0;
  gl::Attachment target_;
  int targetSize_ = 0;
  std::vector<std::vector<CubeLobePart>> levels_;  // of the target
  std::vector<Slice> slices_;
  int next_ = 0;
};

}  // namespace burnish::gpu_scene
