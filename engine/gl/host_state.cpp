// Saving, restoring and resetting; the rows are in host_state_bindings.cpp and host_state_fixed.cpp.
#include "gl/host_state.h"

#include "gl/host_state_rows.h"

namespace burnish::gl {

const std::vector<StateEntry>& stateTable() {
  static const std::vector<StateEntry> table = [] {
    rows::Table t;
    rows::bindings(t);
    rows::fixedFunction(t);
    return t;
  }();
  return table;
}

StateSnapshot captureState(const Device& device) {
  const auto& table = stateTable();
  StateSnapshot snapshot;
  snapshot.reserve(table.size());
  for (const StateEntry& e : table) snapshot.push_back(e.get(device.gl));
  // Reading the units moves the active one; the table's first entry is it.
  table.front().set(device.gl, snapshot.front());
  return snapshot;
}

void restoreState(const Device& device, const StateSnapshot& snapshot) {
  const auto& table = stateTable();
  for (std::size_t i = table.size(); i-- > 0;) {
    if (!table[i].lossy || table[i].get(device.gl) != snapshot[i]) table[i].set(device.gl, snapshot[i]);
  }
}

void setDefaults(const Device& device, bool keepLossy) {
  const GladGLContext& gl = device.gl;
  gl.BindTextures(0, kStateUnits, nullptr);
  gl.BindSamplers(0, kStateUnits, nullptr);
  gl.BindImageTextures(0, kStateImages, nullptr);
  gl.BindBuffersBase(GL_UNIFORM_BUFFER, 0, kStateBufferBindings, nullptr);
  gl.BindBuffersBase(GL_SHADER_STORAGE_BUFFER, 0, kStateStorageBindings, nullptr);
  const auto& table = stateTable();
  for (std::size_t i = table.size(); i-- > 0;)
    if (table[i].initial && !table[i].bulk && !(keepLossy && table[i].lossy)) table[i].set(gl, *table[i].initial);
}

HostStateGuard::HostStateGuard(const Device& device) : device_(device), saved_(captureState(device)) {
  setDefaults(device, true);
}
HostStateGuard::~HostStateGuard() { restoreState(device_, saved_); }

}  // namespace burnish::gl
