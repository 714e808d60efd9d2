// The GL state that the engine may touch, as one table: what HostState::Save puts back, what HostState::Declared leaves
// at GL's defaults, and what the tests perturb.
#pragma once
#include <array>
#include <functional>
#include <optional>

#include "gl/device.h"

namespace burnish::gl {

/// How many of each indexed piece the table covers: what the engine may use.
constexpr GLuint kStateUnits = 32, kStateImages = 8, kStateBufferBindings = 16, kStateStorageBindings = 8,
                 kStateDrawBuffers = 8, kStateViewports = 16;

/// Up to six numbers; doubles hold names, enums, offsets and floats exactly.
using StateValue = std::array<double, 6>;

/// What kind of object value[0] names; None for plain values.
enum class StateObject : std::uint8_t {
  None,
  Texture2D,
  TextureCube,
  TextureBuffer,
  Texture2DArray,
  TextureCubeArray,
  Sampler,
  Buffer,
  VertexArray,
  Program,
  Pipeline,
  Framebuffer,
  Renderbuffer,
  Image
};

/// One piece of state.
struct StateEntry {
  std::string name;  ///< "blend equation 3", "texture 2D unit 17"
  StateObject object = StateObject::None;
  std::optional<StateValue> initial;  ///< GL's default; empty: depends on the window (viewport, scissor box) or on the
                                      ///< host (debug groups) and is left alone by setDefaults
  StateValue other{};  ///< another legal value, for tests; with an object, value[0] is to be replaced by a name
  std::function<StateValue(const GladGLContext&)> get;  ///< may change the active texture unit, nothing else
  std::function<void(const GladGLContext&, const StateValue&)> set;  ///< the same
  bool bulk = false;                                                 ///< setDefaults covers it with a multi-bind call
  bool lossy = false;  ///< reading may lose information, so the guard leaves it alone and puts it back only where it
                       ///< reads differently; the engine does not use it
};

/// Every piece, in an order in which it can be read; restore in reverse ("active texture" is first). Immutable, built
/// on first use.
const std::vector<StateEntry>& stateTable();

using StateSnapshot = std::vector<StateValue>;  ///< in the order of stateTable()
StateSnapshot captureState(const Device& device);
void restoreState(const Device& device, const StateSnapshot& snapshot);
/// Everything at GL's defaults with no engine object bound (HostState::Declared, and the state every frame starts
/// from). About 250 calls. keepLossy: rows marked `lossy` stay as they are (for the guard).
void setDefaults(const Device& device, bool keepLossy = false);

/// Saves on construction and then calls setDefaults; restores on destruction. Not covered, because GL gives no way to
/// put it back: a query, conditional rendering or transform feedback that the host left active, and a program that the
/// host deleted while it was in use.
class HostStateGuard {
 public:
  explicit HostStateGuard(const Device& device);
  ~HostStateGuard();
  HostStateGuard(const HostStateGuard&) = delete;
  HostStateGuard& operator=(const HostStateGuard&) = delete;

 private:
  const Device& device_;
  StateSnapshot saved_;
};

}  // namespace burnish::gl
