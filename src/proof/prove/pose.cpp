#include "prove/pose.hpp"

namespace edmill::prove {

namespace {

/// Rotation about the unit vector e: E_kk = e_k^2 + cos (1 - e_k^2), E_kl = e_k e_l (1 - cos) -/+ e_m sin.
Matrix rotation(const Vector& e, const SinCos& angle) {
  Matrix result;
  const Enclosure rest = 1 - angle.cos;
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3, m = (k + 2) % 3;
    const Enclosure square = e[k] * e[k], product = e[k] * e[l] * rest, along = e[m] * angle.sin;
    result(k, k) = square + angle.cos * (1 - square);
    result(k, l) = product - along;
    result(l, k) = product + along;
  }
  return result;
}

Vector turned(const Matrix& m, const Vector& v) {
  const auto row = [&](int k) { return m(k, 0) * v[0] + m(k, 1) * v[1] + m(k, 2) * v[2]; };
  return {row(0), row(1), row(2)};
}
Vector turned_back(const Matrix& m, const Vector& v) {
  const auto column = [&](int k) { return m(0, k) * v[0] + m(1, k) * v[1] + m(2, k) * v[2]; };
  return {column(0), column(1), column(2)};
}
Matrix product(const Matrix& a, const Matrix& b) {
  Matrix result;
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l) result(k, l) = a(k, 0) * b(0, l) + a(k, 1) * b(1, l) + a(k, 2) * b(2, l);
  return result;
}

/// About an axis of the frame so far. @param angle  [turns]
/// @param speed, acceleration  [rad/s], [rad/s^2]
void rotate(Pose& pose, const Vector& about, const Enclosure& angle, const Enclosure& speed,
            const Enclosure& acceleration) {
  const Vector axis = turned(pose.axes, about);
  const Vector relative = axis * speed;
  pose.omega_rate += axis * acceleration + cross<Enclosure>(pose.omega, relative);
  pose.omega += relative;
  pose.axes = product(pose.axes, rotation(about, sin_cos_turns(angle)));
}

/// By a vector of the frame so far, which has these derivatives in it.
void shift(Pose& pose, const Vector& by, const Vector& by_rate, const Vector& by_second) {
  const Vector d = turned(pose.axes, by), rate = turned(pose.axes, by_rate),
               second = turned(pose.axes, by_second);
  const Vector carried = cross<Enclosure>(pose.omega, d);
  pose.acceleration += second + cross<Enclosure>(pose.omega, Vector(rate * Enclosure(2))) +
                       cross<Enclosure>(pose.omega_rate, d) + cross<Enclosure>(pose.omega, carried);
  pose.velocity += rate + carried;
  pose.centre += d;
}

}  // namespace

Motion::Motion(const ExactCase& exact) : start_(enclosure_of(exact.start)) {
  arb_const_pi(turn_.arb(), Precision::bits());
  turn_ = turn_ + turn_;
  const auto to_enclosure = [](const Quantity& exact) { return enclosure_of(exact); };
  for (const auto& given : exact.joints) {
    Joint joint{given.rotates,
                enclosure_of(given.axis),
                enclosure_of(given.shift),
                enclosure_of(given.angle),
                enclosure_of(given.speed),
                model::converted_swings<Enclosure>(given.swings, to_enclosure)};
    joint.axis = joint.axis / norm<Enclosure>(joint.axis);
    joints_.push_back(std::move(joint));
  }
}

Pose Motion::pose(const Enclosure& time) const {
  Pose pose;
  pose.axes = Matrix::Identity();
  const Enclosure clock = start_ + time;
  for (const auto& joint : joints_) {
    // [turns] or [m]
    Enclosure value = joint.angle + joint.speed * clock, rate = joint.speed, second;
    for (const auto& swing : joint.swings) {
      const auto phase = sin_cos_turns(swing.frequency * clock + swing.phase);
      const Enclosure speed = turn_ * swing.frequency, fastest = swing.amplitude * speed;
      value += swing.amplitude * phase.sin;
      rate += fastest * phase.cos;
      second -= fastest * speed * phase.sin;
    }
    if (joint.rotates)
      rotate(pose, joint.axis, value, rate * turn_, second * turn_);
    else
      shift(pose, joint.shift + joint.axis * value, joint.axis * rate, joint.axis * second);
  }
  return pose;
}

InVessel Motion::in_vessel(const Pose& p, const Vector& position, const Vector& velocity,
                           const Vector& gravity) {
  const Vector d = position - p.centre, carried = cross<Enclosure>(p.omega, d);
  const Vector u = velocity - (p.velocity + carried);
  const Vector frame = p.acceleration + cross<Enclosure>(p.omega_rate, d) +
                       cross<Enclosure>(p.omega, carried) +
                       cross<Enclosure>(p.omega, Vector(u * Enclosure(2)));
  return {turned_back(p.axes, d), turned_back(p.axes, u), turned_back(p.axes, gravity - frame)};
}

Vector Motion::place_in_vessel(const Pose& pose, const Vector& position) {
  return turned_back(pose.axes, position - pose.centre);
}

Vector Motion::direction_to_inertial(const Pose& pose, const Vector& direction) {
  return turned(pose.axes, direction);
}

}  // namespace edmill::prove
