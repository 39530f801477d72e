#include "prove/pose.hpp"

#include "prove/exact_text.hpp"

namespace edmill::prove {

Vector enclosure_of(const QuantityVector& exact) {
  return {enclosure_of(exact[0]), enclosure_of(exact[1]), enclosure_of(exact[2])};
}

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

}  // namespace

Motion::Motion(const ExactCase& exact) : start_(enclosure_of(exact.start)) {
  arb_const_pi(turn_.arb(), Precision::bits());
  turn_ = turn_ + turn_;
  for (const auto& given : exact.joints) {
    Joint joint{given.rotates,
                enclosure_of(given.axis),
                enclosure_of(given.shift),
                enclosure_of(given.angle),
                enclosure_of(given.speed),
                {}};
    joint.axis = joint.axis / norm<Enclosure>(joint.axis);
    for (const auto& s : given.swings)
      joint.swings.push_back({enclosure_of(s.amplitude), enclosure_of(s.frequency), enclosure_of(s.phase)});
    joints_.push_back(std::move(joint));
  }
}

auto Motion::moved(const Joint& joint, const Enclosure& clock) const -> Moved {
  Moved result{joint.angle + joint.speed * clock, joint.speed, Enclosure()};
  for (const auto& swing : joint.swings) {
    const auto phase = sin_cos_turns(swing.frequency * clock + swing.phase);
    const Enclosure speed = turn_ * swing.frequency, rate = swing.amplitude * speed;
    result.value += swing.amplitude * phase.sin;
    result.rate += rate * phase.cos;
    result.second -= rate * speed * phase.sin;
  }
  return result;
}

void Motion::rotate(Pose& pose, const Joint& joint, const Moved& moved, const Enclosure& turn) {
  const Vector axis = turned(pose.axes, joint.axis);
  const Vector relative = axis * Enclosure(moved.rate * turn);
  pose.omega_rate += axis * Enclosure(moved.second * turn) + cross<Enclosure>(pose.omega, relative);
  pose.omega += relative;
  pose.axes = product(pose.axes, rotation(joint.axis, sin_cos_turns(moved.value)));
}

void Motion::shift(Pose& pose, const Joint& joint, const Moved& moved) {
  const Vector d = turned(pose.axes, joint.shift + joint.axis * moved.value);
  const Vector rate = turned(pose.axes, joint.axis * moved.rate),
               second = turned(pose.axes, joint.axis * moved.second);
  const Vector carried = cross<Enclosure>(pose.omega, d);
  pose.acceleration += second + cross<Enclosure>(pose.omega, Vector(rate * Enclosure(2))) +
                       cross<Enclosure>(pose.omega_rate, d) + cross<Enclosure>(pose.omega, carried);
  pose.velocity += rate + carried;
  pose.centre += d;
}

Pose Motion::pose(const Enclosure& time) const {
  Pose pose{Matrix::Identity(), zero_vector(), zero_vector(), zero_vector(), zero_vector(), zero_vector()};
  const Enclosure clock = start_ + time;
  for (const auto& joint : joints_) {
    if (joint.rotates)
      rotate(pose, joint, moved(joint, clock), turn_);
    else
      shift(pose, joint, moved(joint, clock));
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
