// The vessel: a closed cylinder about the y axis of the vessel frame.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/vector.hpp"
#include "model/surface.hpp"

namespace edmill::model {

/// Wall ids follow the thesis: 0 is the cap at y = -h/2, 1 the cap at y = +h/2, 2 the cylinder.
inline constexpr int wall_count = 3;

/// What a ball can collide with, as tables count it: the walls by id, then other balls.
inline constexpr int partner_kinds = wall_count + 1;
inline constexpr int ball_ball = wall_count;

/// The name of a partner, everywhere.
struct PartnerInfo {
  const char* key;      ///< in files
  const char* label;    ///< for readers
  const char* meaning;  ///< of what counts its impacts
};
/// By place: the walls by id, then other balls.
inline constexpr std::array<PartnerInfo, partner_kinds> partners = {{
    {"wall_0", "cap -y", "with wall 0, the cap at -y"},
    {"wall_1", "cap +y", "with wall 1, the cap at +y"},
    {"wall_2", "cylinder", "with wall 2, the cylinder"},
    {"ball_ball", "ball-ball", "between balls"},
}};

/// A wall for readers: "cap -y", "the cap at -y".
struct WallInfo {
  std::string label, meaning;
};

/// Bounds on what rounding does to a function of time and to its first two derivatives.
template <class Real>
struct ErrorBounds {
  Real value, rate, second;
};

/// A closed cylinder about the y axis of the vessel frame. Everything that depends on the shape of its walls
/// is here; a search asks for gaps as smooth functions of the place of a ball's centre: for the caps a length
/// [m], for the cylinder q = (R_v-R)^2 - x^2 - z^2 [m^2], which is smooth on the axis and has the sign of the
/// gap. (2.19'), (2.21'), (2.22')
template <class Real>
struct CylinderVessel {
  template <class Value>
  using PerWall = std::array<Value, wall_count>;

  Real radius;       ///< inner radius R_v [m]
  Real half_height;  ///< h/2 [m]

  /// By id.
  static std::vector<WallInfo> walls() {
    return {{"cap -y", "the cap at -y"}, {"cap +y", "the cap at +y"}, {"cylinder", "the cylinder"}};
  }

  /// Largest distance of a point of the vessel from its centre [m].
  Real reach() const {
    using std::sqrt;
    return sqrt(radius * radius + half_height * half_height);
  }
  /// No less than `reach`, without a root [m].
  Real extent() const { return radius + half_height; }
  /// Bounds on the coordinates of a place inside [m].
  Vec3<Real> half_sizes() const { return {radius, half_height, radius}; }
  Real volume_over_2_pi() const { return radius * radius * half_height; }
  /// Largest sum of two radii of balls that fit [m].
  Real widest_ball() const { return 2 * (radius < half_height ? radius : half_height); }

  /// What the vessel leaves to the centre of a ball: the half height and the radius, less the ball's [m].
  struct Room {
    Real cap, side;
  };
  Room room(const Real& ball_radius) const { return {half_height - ball_radius, radius - ball_radius}; }
  /// The same at a distance from the walls.
  Room room(const Real& ball_radius, const Real& gap) const {
    return {half_height - ball_radius - gap, radius - ball_radius - gap};
  }
  static bool holds(const Room& room) { return room.side >= 0 && room.cap >= 0; }
  static bool contains(const Room& room, const Vec3<Real>& p) {
    return holds(room) && p[0] * p[0] + p[2] * p[2] <= room.side * room.side && p[1] <= room.cap &&
           p[1] >= -room.cap;
  }
  /// A place that is uniform in the room, from three numbers that are uniform in [-1, 1]; nothing when these
  /// must be drawn again.
  static std::optional<Vec3<Real>> place(const Room& room, const Vec3<Real>& drawn) {
    if (drawn[0] * drawn[0] + drawn[2] * drawn[2] > 1) return std::nullopt;
    return Vec3<Real>{drawn[0] * room.side, drawn[1] * room.cap, drawn[2] * room.side};
  }

  static PerWall<Real> gaps(const Room& room, const Vec3<Real>& p) {
    return {room.cap + p[1], room.cap - p[1], room.side * room.side - (p[0] * p[0] + p[2] * p[2])};
  }
  static Real gap(const Room& room, int wall, const Vec3<Real>& p) {
    if (wall == 2) return room.side * room.side - (p[0] * p[0] + p[2] * p[2]);
    return wall == 0 ? Real(room.cap + p[1]) : Real(room.cap - p[1]);
  }
  /// Time derivatives of the gaps; `u` is that of `p`, `a` that of `u`.
  static PerWall<Real> rates(const Vec3<Real>& p, const Vec3<Real>& u) {
    return {u[1], -u[1], -2 * (p[0] * u[0] + p[2] * u[2])};
  }
  static PerWall<Real> curvatures(const Vec3<Real>& p, const Vec3<Real>& u, const Vec3<Real>& a) {
    return {a[1], -a[1], -2 * ((u[0] * u[0] + p[0] * a[0]) + (u[2] * u[2] + p[2] * a[2]))};
  }
  /// Whether a ball at `p` may be within `way` [m] of each wall, with `way` beyond all rounding.
  static PerWall<bool> within(const Room& room, const Vec3<Real>& p, const Real& way) {
    const Real cap = room.cap - way, side = room.side - way;
    const Real &x = p[0], &y = p[1], &z = p[2];
    return {!(-y < cap), !(y < cap), !((side > 0) & (x * x + z * z < side * side))};
  }

  /// Walls whose gaps have the same bounds on their derivatives: 0 the caps, 1 the cylinder.
  static constexpr int wall_kinds = 2;
  static constexpr int kind_of(int wall) { return wall == 2; }
  /// Bounds on the k-th derivatives of the gaps by kind of wall, from those on the coordinates.
  /// @param y       of the coordinate along the axis
  /// @param square  of x^2 + z^2
  static std::array<Real, wall_kinds> derivative_bounds(const Real& y, const Real& square) {
    return {y, square};
  }

  /// Whether the gap to a wall is a coordinate up to sign and offset: then it is as sharp as one.
  static constexpr bool is_flat(int wall) { return kind_of(wall) == 0; }
  /// Rounding of the gap to a curved wall.
  /// @param coordinate    of a coordinate in the vessel frame
  /// @param u             half the distance from 1 to the next number
  /// @param frame_speed   bound on the ball's speed in the vessel frame [m/s]
  /// @param acceleration  on the acceleration there [m/s^2]
  /// @param beyond        how far outside of the vessel the ball may be [m]
  ErrorBounds<Real> curved_errors(const ErrorBounds<Real>& coordinate, const Real& u, const Real& frame_speed,
                                  const Real& acceleration, const Real& beyond) const {
    const auto& y = coordinate;
    const Real R = radius + beyond;
    return {3 * R * y.value + 4 * u * R * R,
            3 * R * y.rate + 3 * frame_speed * y.value + 6 * u * R * frame_speed,
            6 * frame_speed * y.rate + 4 * R * y.second + 4 * acceleration * y.value +
                12 * u * (frame_speed * frame_speed + R * acceleration)};
  }

  /// Contact normal of a ball at `p`: unit, into the vessel, in the vessel frame.
  Vec3<Real> normal(int wall, const Vec3<Real>& p) const {
    if (wall != 2) return {Real(0), Real(wall == 0 ? 1 : -1), Real(0)};
    using std::sqrt;
    const Real rho = sqrt(p[0] * p[0] + p[2] * p[2]);
    return {-p[0] / rho, Real(0), -p[2] / rho};
  }
  /// How deep a ball at `p` overlaps a wall [m]; negative for a gap.
  Real overlap(int wall, const Vec3<Real>& p, const Real& ball_radius) const {
    if (wall == 2) {
      using std::sqrt;
      return sqrt(p[0] * p[0] + p[2] * p[2]) - (radius - ball_radius);
    }
    const Real side(wall == 0 ? 1 : -1);
    return -side * p[1] - (half_height - ball_radius);
  }

  /// By wall id.
  std::vector<WallSurface<Real>> surfaces() const {
    const Vec3<Real> up{Real(0), half_height, Real(0)};
    return {Disc<Real>{frame_at<Real>(-up), radius}, Disc<Real>{frame_at<Real>(up), radius},
            Tube<Real>{frame_at<Real>(Vec3<Real>::Zero()), radius, half_height}};
  }
};

}  // namespace edmill::model
