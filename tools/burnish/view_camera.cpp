#include "view_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cli::viewer {
namespace {

constexpr double kFast = 4;             // with Shift
constexpr double kCrossing = 8;         // seconds from one end of the scene to the other
constexpr double kSteepest = 1.5533;    // radians, 89 degrees

std::string vectorText(glm::dvec3 v) { return fmt::format("{:.6g},{:.6g},{:.6g}", v.x, v.y, v.z); }

}  // namespace

FlyCamera::FlyCamera(const burnish::View& view, const burnish::Bounds& bounds) : view_(view) {
  const double size = bounds.empty() ? 10 : double(glm::length(bounds.max - bounds.min));
  speed_ = std::clamp(size / kCrossing, 0.05, 1000.0);
}

void FlyCamera::move(glm::dvec3 direction, double seconds, bool fast) {
  const double step = speed_ * seconds * (fast ? kFast : 1);
  const glm::dvec3 forward = -view_.axes[2];
  view_.eye += (view_.axes[0] * direction.x + glm::dvec3(0, direction.y, 0)) * step;
  if (view_.orthographic)
    view_.height = float(double(view_.height) * std::exp(-direction.z * step / std::max(double(view_.height), 1e-3)));
  else
    view_.eye += forward * (direction.z * step);
}

void FlyCamera::turn(double left, double up) {
  const glm::dvec3 forward = -view_.axes[2];
  const double yaw = std::atan2(-forward.x, -forward.z) + left;
  const double pitch = std::clamp(std::asin(std::clamp(forward.y, -1.0, 1.0)) + up, -kSteepest, kSteepest);
  const glm::dvec3 to(-std::sin(yaw) * std::cos(pitch), std::sin(pitch), -std::cos(yaw) * std::cos(pitch));
  view_.axes = burnish::lookAt(glm::dvec3(0), to).axes;
}

void FlyCamera::faster(double steps) { speed_ = std::clamp(speed_ * std::pow(1.25, steps), 1e-3, 1e5); }

std::string FlyCamera::options() const {
  if (view_.orthographic) return {};
  const glm::dvec3 target = view_.eye - view_.axes[2];
  std::string text = fmt::format("--eye {} --target {}", vectorText(view_.eye), vectorText(target));
  const burnish::View upright = burnish::lookAt(view_.eye, target);
  if (glm::dot(upright.axes[1], view_.axes[1]) < 1 - 1e-9) text += " --up " + vectorText(view_.axes[1]);
  const double degrees = double(view_.fovY) * 180 / M_PI;
  if (std::abs(degrees - 50) > 1e-3) text += fmt::format(" --fov {:.6g}", degrees);
  return text;
}

bool sameView(const burnish::View& a, const burnish::View& b) {
  return a.eye == b.eye && a.axes == b.axes && a.orthographic == b.orthographic && a.fovY == b.fovY && a.height == b.height && a.near == b.near && a.far == b.far && a.viewport == b.viewport;
}

}  // namespace cli::viewer
