// The camera that flies: keys move it, the mouse turns it.
#pragma once
#include <burnish/plan.h>

#include <string>

namespace cli::viewer {

class FlyCamera {
 public:
  /// `bounds`: of the scene; they decide how fast it flies at first.
  FlyCamera(const burnish::View& view, const burnish::Bounds& bounds);
  /// Goes to a view, tilt and all; the tilt is kept until it turns.
  void set(const burnish::View& view) { view_ = view; }
  [[nodiscard]] const burnish::View& view() const { return view_; }
  /// Moves for some seconds: right, up (the world's) and forward, each -1 to 1. An orthographic camera gets closer by showing less.
  void move(glm::dvec3 direction, double seconds, bool fast);
  /// Turns by radians, to the left and up. Straight up and down are the limits.
  void turn(double left, double up);
  void faster(double steps);               ///< 25 % a step; negative: slower
  [[nodiscard]] double speed() const { return speed_; }  ///< metres a second
  /// "--eye X,Y,Z --target X,Y,Z ...": what makes `burnish render` show this view. Empty for an orthographic one, which these options cannot say.
  [[nodiscard]] std::string options() const;

 private:
  burnish::View view_;
  double speed_;
};

/// The same picture, but for `cut`.
bool sameView(const burnish::View& a, const burnish::View& b);

}  // namespace cli::viewer
