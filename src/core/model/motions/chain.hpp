// A vessel on a chain of joints: turns and shifts, constant, at constant speed or swinging.
// docs/theory.md, section 1.
#pragma once

#include <cmath>
#include <optional>
#include <tuple>

#include "model/motions/joints.hpp"
#include "model/parts/vessel_frame.hpp"

namespace edmill::model {

/// Rotates a vector about an axis. (Rodrigues)
template <class Real>
Vec3<Real> turned_about(
    const Vec3<Real>& v, const Vec3<Real>& axis, const numerics::SinCos<Real>& angle) {
  return v * angle.cos + cross<Real>(axis, v) * angle.sin +
      axis * Real(dot<Real>(axis, v) * (1 - angle.cos));
}

/// Bounds on a chain's motion that are valid at all times (docs/theory.md, section 3): on the
/// norms, as observed in the moving frame, of the angular velocity and the acceleration of the
/// origin, and of their derivatives.
template <class Real> struct ChainBounds {
  std::array<Real, 4> turning{};       ///< [rad/s], [rad/s^2], ...
  std::array<Real, 3> acceleration{};  ///< [m/s^2], ...
  Real speed{0};                       ///< of the origin [m/s]
  Real distance{0};                    ///< of the origin from that of the ground [m]
  Real errors{20};  ///< bound on the relative rounding errors of all of these [u]

  /// @param apart  the magnitudes of constant speeds are added, as rounding errors require;
  /// otherwise those
  ///               about parallel axes count with their signs: a jar may turn against its disc
  ChainBounds(const Joints<Real>& joints, bool apart) {
    std::optional<Vec3<Real>> common;  // direction of all axes so far, in the present frame
    bool parallel = true;
    Real sum(0), sizes(0);  // of the constant speeds about it
    for (const auto& joint : joints.list) {
      const auto rates = rates_of(joint, joints.times);
      errors += error_of(joint, joints.period);
      const Vec3<Real> axis = direction(joint);
      if (!joint.rotates) {
        shift(rates);
      } else if (!(rates[1] > 0)) {
        if (common)
          *common = turned_about<Real>(*common, axis, numerics::sin_cos_turns<Real>(-joint.angle));
      } else {
        parallel = parallel && (!common || are_parallel(*common, axis));
        if (common && dot<Real>(*common, axis) < 0) sum = -sum;
        common = axis;
        rotate(rates, parallel);
        if (!parallel || apart) continue;
        const Real own = 2 * numerics::pi<Real>() * joint.speed;
        const Real sum_of_sizes = magnitude(sum) + magnitude(own);
        sum += own;
        sizes += magnitude(own);
        turning[0] += (magnitude(sum) - sum_of_sizes) + 8 * epsilon<Real>() * sizes;
      }
    }
    const Real up = 1 + rounding_margin<Real>();  // over the rounding of all this
    speed *= up;
    distance *= up;
    for (auto& bound : turning) bound *= up;
    for (auto& bound : acceleration) bound *= up;
  }

  /// Bounds on a ball in the frame, as in the concept Motion.
  Real speed_in_vessel(const FlightBounds<Real>& f) const {
    return f.speed + speed + turning[0] * f.reach;
  }
  Real acceleration_in_vessel(const FlightBounds<Real>& f) const {
    return f.gravity + acceleration[0] + 2 * turning[0] * speed_in_vessel(f) + bend() * f.reach;
  }
  Real bend() const { return turning[1] + turning[0] * turning[0]; }

  static Vec3<Real> direction(const Joint<Real>& joint) {
    const Vec3<Real> axis(joint.axis.data());
    const Real size = norm<Real>(axis);
    return size > 0 ? Vec3<Real>(axis / size) : axis;
  }
 private:
  /// Bounds on the joint's angle [rad] or shift [m] and its first four derivatives.
  static Majorant<Real> rates_of(const Joint<Real>& joint, const std::array<Real, 2>& times) {
    const Real turn = 2 * numerics::pi<Real>();
    const Real unit = joint.rotates ? turn : Real(1);
    Majorant<Real> rates{
        norm<Real>(Vec3<Real>(joint.shift.data())), magnitude<Real>(unit * joint.speed)};
    if (!joint.rotates) {
      const Real first = magnitude(times[0]), last = magnitude(times[1]);
      rates[0] += rates[1] * (first > last ? first : last);
    }
    for (const auto& swing : joint.swings) {
      Real size = magnitude<Real>(swing.amplitude * unit);
      for (auto& rate : rates) {
        rate += size;
        size *= magnitude<Real>(turn * swing.frequency);
      }
    }
    return rates;
  }
  /// Rounding errors of a joint in units of u: of a phase, a few roundings of its number of turns,
  /// 2 pi times as large in radians; then of a sine, and of products with a matrix and the vectors
  /// of the following frames.
  static Real error_of(const Joint<Real>& joint, const Real& period) {
    const auto of_phase = [&](const Real& frequency) {
      return Real(7 * (4 + 3 * magnitude<Real>(frequency * period)));
    };
    // Constant angles and phases count, too, if they exceed the one turn that is included above.
    const auto of_turns = [](const Real& turns) {
      return magnitude(turns) > 1 ? Real(14 * magnitude(turns)) : Real(0);
    };
    Real most = of_turns(joint.angle);
    if (!(joint.speed == 0)) most += joint.rotates ? of_phase(joint.speed) : Real(8);
    for (const auto& swing : joint.swings) {
      const Real size = joint.rotates ? Real(7 * magnitude<Real>(swing.amplitude)) : Real(1);
      most += (size > 1 ? size : Real(1)) * (of_phase(swing.frequency) + of_turns(swing.phase));
    }
    return most + 10;
  }
  static bool are_parallel(const Vec3<Real>& a, const Vec3<Real>& b) {
    return squared_norm<Real>(cross<Real>(a, b)) < 64 * epsilon<Real>() * epsilon<Real>();
  }

  /// The frame behind the joint turns about an axis: its angular velocity is E w + axis angle', E b
  /// the acceleration; the derivatives of the matrix E follow from those of the angle. (Faa di
  /// Bruno)
  void rotate(const Majorant<Real>& angle, bool parallel) {
    const Real &a = angle[1], &b = angle[2], &c = angle[3];
    const std::array<Real, 4> matrix{Real(1), a, a * a + b, a * a * a + 3 * a * b + c};
    const auto w = turning;
    const auto old = acceleration;
    for (int k = 0; k < 4; ++k)
      turning[k] = (parallel ? w[k] : product_bound(matrix, 0, w, k)) + angle[k + 1];
    for (int k = 0; k < 3; ++k) acceleration[k] = product_bound(matrix, 0, old, k);
  }
  /// (d + C)'' with C = shift in a frame that turns: d'' + 2 w x d' + w' x d + w x (w x d).
  void shift(const Majorant<Real>& d) {
    std::array<Real, 3> square;
    for (int k = 0; k < 3; ++k) square[k] = product_bound(turning, 0, turning, k);
    for (int k = 0; k < 3; ++k)
      acceleration[k] += d[k + 2] + 2 * product_bound(turning, 0, d, k, 1) +
          product_bound(turning, 1, d, k) + product_bound(square, 0, d, k);
    speed += d[1] + turning[0] * d[0];
    distance += d[0];
  }
};

/// The box that a vessel of these half sizes sweeps: from the vessel to the ground, each joint
/// turns or shifts the bounding box of the later joints.
template <class Real>
SweptBox<Real> swept_box(const Joints<Real>& joints, const Vec3<Real>& sizes) {
  using std::sqrt;
  SweptBox<Real> box{-sizes, sizes};
  for (auto joint = joints.list.rbegin(); joint != joints.list.rend(); ++joint) {
    const Vec3<Real> axis = ChainBounds<Real>::direction(*joint);
    Real swing(0);
    for (const auto& s : joint->swings) swing += magnitude<Real>(s.amplitude);
    if (!joint->rotates) {
      const Vec3<Real> shift(joint->shift.data()), way = axis.cwiseAbs() * swing;
      const Vec3<Real> first = axis * Real(joint->speed * joints.times[0]),
                       last = axis * Real(joint->speed * joints.times[1]);
      box = {box.low + shift - way + first.cwiseMin(last),
          box.high + shift + way + first.cwiseMax(last)};
      continue;
    }
    const Vec3<Real> middle = (box.low + box.high) / Real(2), half = (box.high - box.low) / Real(2);
    const Real farthest = norm<Real>(Vec3<Real>(middle.cwiseAbs() + half));
    // Rotated by the constant angle, and by at most the sum of the swings; or by a full turn.
    const auto angle = numerics::sin_cos_turns<Real>(joint->angle);
    const Real more =
        joint->speed == 0 ? Real(2 * numerics::pi<Real>() * swing * farthest) : 2 * farthest;
    Vec3<Real> reach = Vec3<Real>::Constant(more);
    for (int k = 0; k < 3; ++k)
      reach += turned_about<Real>(Vec3<Real>::Unit(k), axis, angle).cwiseAbs() * half[k];
    const Vec3<Real> centre = turned_about<Real>(middle, axis, angle);
    // A rotation preserves the coordinate along its axis and the distance from it.
    const Real along = magnitude<Real>(dot<Real>(axis, middle)) + dot<Real>(axis.cwiseAbs(), half);
    Real across(0);
    for (int corner = 0; corner < 8; ++corner) {
      Vec3<Real> p = middle;
      for (int k = 0; k < 3; ++k) p[k] += (corner >> k) % 2 ? half[k] : Real(-half[k]);
      const Real size = norm<Real>(cross<Real>(axis, p));
      across = size > across ? size : across;
    }
    for (int k = 0; k < 3; ++k) {
      const Real away = sqrt(magnitude<Real>(1 - axis[k] * axis[k])) * across;
      const Real around = magnitude<Real>(axis[k]) * along + away;
      const Real low = centre[k] - reach[k], high = centre[k] + reach[k];
      box.low[k] = low < -around ? Real(-around) : low;
      box.high[k] = high > around ? around : high;
    }
  }
  const Real up = rounding_margin<Real>();
  const Vec3<Real> margin = (box.high - box.low) * up;
  return {box.low - margin, box.high + margin};
}

/// Position, orientation and motion of the vessel frame, in inertial coordinates.
template <class Real> struct ChainPose {
  Vec3<Real> x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};  ///< axes of the vessel frame
  /// Position [m], velocity [m/s] and acceleration [m/s^2] of its origin.
  Vec3<Real> centre{0, 0, 0}, velocity{0, 0, 0}, acceleration{0, 0, 0};
  Vec3<Real> omega{0, 0, 0},
      omega_rate{0, 0, 0};  ///< angular velocity and its rate [rad/s], [rad/s^2]

  void archive(Archive& a) { a(x, y, z, centre, velocity, acceleration, omega, omega_rate); }
};

/// Motion of a vessel on a chain of joints, from the ground to the vessel; each joint moves all
/// frames that follow it. The speeds of joints need not have a common period: whole drive periods
/// of the clock are subtracted from each phase exactly.
template <class Real> class ChainMotion {
 public:
  using Scalar = Real;
  using Pose = ChainPose<Real>;

  ChainMotion() : ChainMotion(Joints<Real>{{}, Real(1)}) {}
  explicit ChainMotion(const Joints<Real>& joints)
      : joints_(with_frequencies(joints)), bounds_(joints_, false), terms_(joints_, true) {
    // State of the chain up to each joint, by which terms that vanish in every pose are omitted.
    bool level = true, turned = false, uneven = false;
    int common = -1;  // the one axis that all rotations are about
    for (const auto& joint : joints_.list) {
      const Real turning = joint.rotates ? joint.speed : Real(0);
      const int axis = joint.rotates ? aligned(joint.axis) : -1;
      const Swings<Real> swings(joint.swings);
      const Step& step = steps_.emplace_back(Step{.rotates = joint.rotates,
          .axis = ChainBounds<Real>::direction(joint),
          .aligned = axis,
          .shift = Vec3<Real>(joint.shift.data()),
          .angle = joint.angle,
          .drive = {turning, 2 * numerics::pi<Real>() * turning, joint.per_period},
          .slide = joint.speed,
          .swings = swings,
          .fixed = numerics::sin_cos_turns<Real>(joint.angle),
          .moves = joint.speed != 0 || !swings.empty(),
          .level = level,
          .turned = turned,
          .parallel = axis >= 0 && axis == common,
          .uneven = uneven});
      if (!step.rotates) continue;
      level = false;
      if (step.moves) uneven = uneven || !swings.empty() || (turned && !step.parallel);
      common = turned || common >= 0 ? (step.parallel ? common : -2) : axis;
      turned = turned || step.moves;
    }
    moment_ = moment();
  }
  template <class To> ChainMotion<To> cast() const {
    return ChainMotion<To>(
        converted_joints<To>(joints_, [](const Real& x) { return static_cast<To>(x); }));
  }

  const Joints<Real>& joints() const { return joints_; }
  const Real& period() const { return joints_.period; }  ///< of the clock [s]

  Pose pose(const Instant<Real>& when) const { return made<true>(when); }
  /// The pose without its rates.
  Pose place(const Instant<Real>& when) const { return made<false>(when); }
  /// Computed without the known pose, whose rates would need derivatives beyond those that it has.
  Pose pose_nearby(const Instant<Real>& when, const Pose&, const Instant<Real>&) const {
    return pose(when);
  }
  /// In the period of `known`. With R and C the orientation and the centre, R' = [w] R and R'' =
  /// [w'] R + [w]^2 R: for at most `moment_` their Taylor polynomials are as accurate as the
  /// scalar.
  Vec3<Real> position_nearby(const Instant<Real>& when, const Pose& pose,
      const Instant<Real>& known, const Vec3<Real>& position) const {
    const Real dt = when.offset - known.offset;
    const auto short_dt = static_cast<Hint<Real>>(dt);
    if (!(short_dt <= moment_ && short_dt >= -moment_)) [[unlikely]]
      return position_in_vessel(made<false>(when), position);
    const Real half = dt / 2;
    const Vec3<Real> turn = (pose.omega + pose.omega_rate * half) * dt;
    const Vec3<Real> centre = pose.centre + (pose.velocity + pose.acceleration * half) * dt;
    const Vec3<Real> d = position - centre;
    const Vec3<Real> first = cross<Real>(turn, d);
    return to_vessel(pose, d - (first - cross<Real>(turn, first) / Real(2)));
  }

  static const Vec3<Real>& axis_x(const Pose& p) { return p.x; }
  static const Vec3<Real>& axis_y(const Pose& p) { return p.y; }
  static const Vec3<Real>& axis_z(const Pose& p) { return p.z; }
  static Vec3<Real> direction_to_inertial(const Pose& p, const Vec3<Real>& n) {
    const auto along = [&](int k) { return Real(p.x[k] * n[0] + p.y[k] * n[1] + p.z[k] * n[2]); };
    return {along(0), along(1), along(2)};
  }
  static Vec3<Real> to_inertial(const Pose& pose, const Vec3<Real>& p) {
    return pose.centre + direction_to_inertial(pose, p);
  }
  static Vec3<Real> position_in_vessel(const Pose& pose, const Vec3<Real>& position) {
    return to_vessel(pose, position - pose.centre);
  }
  static VesselFrameState<Real> to_vessel_frame(
      const Pose& p, const Vec3<Real>& position, const Vec3<Real>& velocity) {
    const Vec3<Real> d = position - p.centre;
    return {to_vessel(p, d), to_vessel(p, velocity - (p.velocity + cross<Real>(p.omega, d)))};
  }
  static Vec3<Real> vessel_frame_acceleration(const Pose& p, const VesselFrameState<Real>& state,
      const Vec3<Real>&, const Vec3<Real>& gravity) {
    const Vec3<Real> d = direction_to_inertial(p, state.position);
    const Vec3<Real> v = direction_to_inertial(p, state.velocity);
    return to_vessel(p, gravity - (acceleration_at(p, d) + cross<Real>(p.omega, v) * Real(2)));
  }
  static Vec3<Real> angular_velocity(const Pose& pose) { return pose.omega; }
  static Vec3<Real> wall_velocity(const Pose& pose, const Vec3<Real>& point) {
    return pose.velocity + cross<Real>(pose.omega, Vec3<Real>(point - pose.centre));
  }
  static Vec3<Real> wall_acceleration(const Pose& pose, const Vec3<Real>& point) {
    return acceleration_at(pose, point - pose.centre);
  }

  Vec3<Real> middle() const {
    const auto box = swept_box<Real>(joints_, Vec3<Real>::Zero());
    return (box.low + box.high) / Real(2);
  }
  Real reach(const Real& vessel_reach) const { return bounds_.distance + vessel_reach; }
  Real wall_speed(const Real& vessel_reach) const {
    return bounds_.speed + bounds_.turning[0] * vessel_reach;
  }
  Real speed_within(const Real& distance) const { return wall_speed(distance + bounds_.distance); }
  Real acceleration_within(const Real& distance) const {
    return bounds_.acceleration[0] + bounds_.bend() * (distance + bounds_.distance);
  }
  Real longest_window() const { return window_of(period(), bounds_.turning[0]); }
  SweptBox<Real> swept(const Vec3<Real>& sizes, const Real&) const {
    return swept_box<Real>(joints_, sizes);
  }

  /// With p the place in the frame, R its rotation, b the acceleration of its origin: p'' = R g - b
  /// - 2 w x p' - w' x p - w x (w x p), and its derivatives by Leibniz' rule.
  CoordinateBounds<Real> coordinate_bounds(const Vec3<Real>& sizes, const Real& vessel_reach,
      const Real& gravity, const Real& speed, const Real& length) const {
    const auto& w = bounds_.turning;
    const auto& b = bounds_.acceleration;
    const Real p0 = vessel_reach + (speed + bounds_.speed) * length;
    const Real p1 = speed + bounds_.speed + w[0] * p0;
    const Real square = w[0] * w[0], square1 = 2 * w[0] * w[1],
               square2 = 2 * (w[1] * w[1] + w[0] * w[2]);
    const Real p2 = gravity + b[0] + 2 * w[0] * p1 + (w[1] + square) * p0;
    const Real p3 =
        gravity * w[0] + b[1] + 2 * w[0] * p2 + (3 * w[1] + square) * p1 + (w[2] + square1) * p0;
    const Real p4 = gravity * (w[1] + square) + b[2] + 2 * w[0] * p3 + (5 * w[1] + square) * p2 +
        (4 * w[2] + 2 * square1) * p1 + (w[3] + square2) * p0;
    const auto along = [&](int axis) {
      return Majorant<Real>{sizes[axis] + p1 * length, p1, p2, p3, p4};
    };
    return {along(0), along(1), along(2)};
  }

  Real speed_in_vessel(const FlightBounds<Real>& f) const { return bounds_.speed_in_vessel(f); }
  Real acceleration_in_vessel(const FlightBounds<Real>& f) const {
    return bounds_.acceleration_in_vessel(f);
  }
  /// Errors of the flight and, by ChainBounds::errors, of all parts of the pose.
  ErrorBounds<Real> coordinate_errors(const Real& u, const FlightBounds<Real>& f) const {
    const Real fallen = f.gravity * f.elapsed;
    const Real position =
        12 * f.reach + 8 * (fallen * f.elapsed) + 2 * (f.speed * (f.elapsed + 3 * f.lag));
    return through_pose(u, f, position, 8 * f.speed + 4 * fallen);
  }
  ErrorBounds<Real> state_errors(const Real& u, const FlightBounds<Real>& f) const {
    const Real time = period() + f.lag;
    const Real position =
        3 * f.reach + f.speed * (f.elapsed + time) + 2 * (f.gravity * f.elapsed * f.elapsed);
    return through_pose(u, f, position, 2 * f.speed + f.gravity * (2 * f.elapsed + time));
  }
 private:
  struct Step {
    bool rotates;
    Vec3<Real> axis;    ///< unit
    int aligned;        ///< axis along +x, +y, +z: 0, 1, 2; else -1
    Vec3<Real> shift;   ///< [m]
    Real angle;         ///< [turns]
    Drive<Real> drive;  ///< of a rotation at constant speed; frequency 0 for none
    Real slide;         ///< constant speed of a translation [m/s]
    Swings<Real> swings;
    numerics::SinCos<Real> fixed;  ///< of the constant angle
    bool moves;
    // Effect of the preceding joints:
    bool level;     ///< none of them rotates: the axes are those of the ground
    bool turned;    ///< the frame has an angular velocity
    bool parallel;  ///< the angular velocity is along this axis
    bool uneven;    ///< the angular velocity varies
  };

  template <bool with_rates> Pose made(const Instant<Real>& when) const {
    Pose p;
    for (const auto& step : steps_) {
      if (step.rotates)
        rotate<with_rates>(p, step, when);
      else
        shift<with_rates>(p, step, when);
    }
    return p;
  }
  /// Frequencies from the turns per drive period, which are exact: the pose at the end of a period
  /// is that at the begin of the next in every scalar.
  static Joints<Real> with_frequencies(Joints<Real> joints) {
    for (auto& joint : joints.list) {
      if (joint.rotates) joint.speed = joint.per_period.template value<Real>() / joints.period;
      for (auto& swing : joint.swings)
        swing.frequency = swing.per_period.template value<Real>() / joints.period;
    }
    return joints;
  }
  static int aligned(const std::array<Real, 3>& axis) {
    for (int k = 0; k < 3; ++k)
      if (axis[k] > 0 && axis[(k + 1) % 3] == 0 && axis[(k + 2) % 3] == 0) return k;
    return -1;
  }
  static Vec3<Real> to_vessel(const Pose& p, const Vec3<Real>& d) {
    return {dot<Real>(p.x, d), dot<Real>(p.y, d), dot<Real>(p.z, d)};
  }
  static Vec3<Real> acceleration_at(const Pose& p, const Vec3<Real>& d) {
    return p.acceleration + cross<Real>(p.omega_rate, d) +
        cross<Real>(p.omega, cross<Real>(p.omega, d));
  }

  template <bool with_rates>
  static void rotate(Pose& p, const Step& step, const Instant<Real>& when) {
    auto turned = step.fixed;
    if (step.moves) {
      const Real turn = 2 * numerics::pi<Real>();
      const auto moved = step.swings.at(when);
      Real turns = step.angle + moved.value, rate = moved.rate * turn;
      if (step.drive.frequency != 0) {
        turns += step.drive.turns(when);
        rate += step.drive.speed;
      }
      turned = numerics::sin_cos_turns<Real>(turns);
      if constexpr (with_rates) {
        const Vec3<Real> axis =
            step.aligned >= 0 ? column(p, step.aligned) : direction_to_inertial(p, step.axis);
        const Vec3<Real> relative = axis * rate;
        if (!step.swings.empty()) p.omega_rate += axis * Real(moved.second * turn);
        if (step.turned && !step.parallel) p.omega_rate += cross<Real>(p.omega, relative);
        p.omega += relative;
      }
    }
    if (step.aligned >= 0) {
      Vec3<Real>&a = column(p, (step.aligned + 1) % 3), &b = column(p, (step.aligned + 2) % 3);
      const Vec3<Real> old = a;
      a = old * turned.cos + b * turned.sin;
      b = b * turned.cos - old * turned.sin;
      return;
    }
    const auto made = [&](int k) {
      const Vec3<Real> unit = Vec3<Real>::Unit(k),
                       along = step.axis * Real(step.axis[k] * (1 - turned.cos));
      return direction_to_inertial(
          p, unit * turned.cos + cross<Real>(step.axis, unit) * turned.sin + along);
    };
    std::tie(p.x, p.y, p.z) = std::tuple(made(0), made(1), made(2));
  }
  template <bool with_rates>
  void shift(Pose& p, const Step& step, const Instant<Real>& when) const {
    const auto outside = [&](const Vec3<Real>& v) {
      return step.level ? v : direction_to_inertial(p, v);
    };
    Vec3<Real> d = outside(step.shift), acceleration = Vec3<Real>::Zero();
    if (step.moves) {
      auto moved = step.swings.at(when);
      if (step.slide != 0) {
        moved.value += step.slide * DriveClock<Real>(period()).seconds(when);
        moved.rate += step.slide;
      }
      const Vec3<Real> axis = outside(step.axis);
      d += axis * moved.value;
      if constexpr (with_rates) {
        const Vec3<Real> rate = axis * moved.rate;
        acceleration = axis * moved.second;
        if (step.turned) acceleration += cross<Real>(p.omega, rate) * Real(2);
        p.velocity += rate;
      }
    }
    if constexpr (with_rates) {
      if (step.uneven) acceleration += cross<Real>(p.omega_rate, d);
      if (step.turned) {
        const Vec3<Real> velocity = cross<Real>(p.omega, d);
        acceleration += cross<Real>(p.omega, velocity);
        p.velocity += velocity;
      }
      p.acceleration += acceleration;
    }
    p.centre += d;
  }
  static Vec3<Real>& column(Pose& p, int k) { return k == 0 ? p.x : k == 1 ? p.y : p.z; }

  /// Longest interval [s] for which the Taylor polynomials of second order have an error below u/4
  /// of a turn and of the centre's distance: the period over a power of two, the same on every
  /// machine.
  Hint<Real> moment() const {
    const auto& w = bounds_.turning;
    const auto& b = bounds_.acceleration;
    const auto third_of_turn = static_cast<double>(w[2] + 6 * w[0] * w[1] + w[0] * w[0] * w[0]);
    const auto third_of_centre = static_cast<double>(b[1] + w[0] * b[0]);
    const auto u = static_cast<Hint<Real>>(epsilon<Real>() / 2);
    const double distance = static_cast<double>(bounds_.distance);
    auto t = static_cast<Hint<Real>>(period());
    while (4 * third_of_turn * (t * t * t) > u || 4 * third_of_centre * (t * t * t) > u * distance)
      t /= 2;
    return t;
  }

  /// @param position, velocity  errors of the flight's, in units of u
  ErrorBounds<Real> through_pose(const Real& u, const FlightBounds<Real>& f, const Real& position,
      const Real& velocity) const {
    const Real& w = terms_.turning[0];
    const Real of_pose = terms_.errors * terms_.acceleration_in_vessel(f);
    return {u * (position + terms_.errors * f.reach),
        u * (velocity + w * position + terms_.errors * terms_.speed_in_vessel(f)),
        u * (2 * w * velocity + terms_.bend() * position + of_pose)};
  }

  Joints<Real> joints_;
  ChainBounds<Real> bounds_;  ///< on the motion
  ChainBounds<Real> terms_;   ///< on the terms of which its vectors are sums, for their rounding
  std::vector<Step> steps_;
  Hint<Real> moment_{0};  ///< [s]
};

}  // namespace edmill::model
