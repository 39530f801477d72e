// How long a ball cannot reach bodies that move together. A broad phase in double, whose margins
// are far above its rounding: contacts that it excludes need no search in any scalar.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "model/mill.hpp"

namespace edmill::dynamics {

/// Bodies whose joints move alike, such as the arms of a rotor, differ by a constant
/// transformation: one pose of the joints that move is enough. theory.md, section 2
class BodyGroups {
 public:
  static constexpr std::size_t most = 64;  ///< bodies
  using Times = std::array<double, most>;

  BodyGroups() = default;
  explicit BodyGroups(const std::vector<model::Body<double>>& bodies);

  /// For how long a ball cannot reach each body, whatever its path [s]; negative where it is near.
  /// @param position, speed  of its centre at `when`, inertial; its largest [m/s]
  Times clear_times(
      const Instant<double>& when, const Vec3<double>& position, double radius, double speed) const;
 private:
  struct Member {
    std::size_t body;
    model::ChainPose<double> place;  ///< in the frame of the group
    model::RoundedBody<double> shape;
    double speed;   ///< no point of it is faster [m/s]
    double margin;  ///< above the rounding of its distance, and of the time [m]
  };
  struct Group {
    model::ChainMotion<double> motion;
    std::vector<Member> members;
  };
  std::vector<Group> groups_;
};

}  // namespace edmill::dynamics
