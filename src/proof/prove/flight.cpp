#include "prove/flight.hpp"

namespace edmill::prove {

Vector turned(const Matrix& m, const Vector& v) {
  const auto row = [&](int k) { return m(k, 0) * v[0] + m(k, 1) * v[1] + m(k, 2) * v[2]; };
  return {row(0), row(1), row(2)};
}

Vector turned_back(const Matrix& m, const Vector& v) {
  const auto column = [&](int k) { return m(0, k) * v[0] + m(1, k) * v[1] + m(2, k) * v[2]; };
  return {column(0), column(1), column(2)};
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

/// Takes off what a round wall does not see: the component along a cylinder's axis, y.
Vector across(ExactWall::Kind kind, Vector v) {
  if (kind == ExactWall::cylinder) v[1] = Enclosure();
  return v;
}

/// The gap of two flights at a time. @param reach  R_i + R_j
PairGap pair_gap(const Flight& one, const Flight& two, const Enclosure& reach, const Vector& gravity,
                 const Enclosure& time) {
  return {one.position_at(time, gravity) - two.position_at(time, gravity),
          one.velocity_at(time, gravity) - two.velocity_at(time, gravity), reach * reach};
}

}  // namespace

Motion::Motion(const ExactCase& exact) : start_(enclosure_of(exact.start)) {
  arb_const_pi(turn_.arb(), Precision::bits());
  turn_ = turn_ + turn_;
  const auto to_enclosure = [](const Quantity& exact) { return enclosure_of(exact); };
  for (const auto& given : exact.joints) {
    Joint joint{.rotates = given.rotates,
                .axis = enclosure_of(given.axis),
                .shift = enclosure_of(given.shift),
                .angle = enclosure_of(given.angle),
                .speed = enclosure_of(given.speed),
                .swings = model::converted_swings<Enclosure>(given.swings, to_enclosure)};
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

Flight rounded(const Flight& flight, slong bits) {
  Flight result = flight;
  for (auto* vector : {&result.position, &result.velocity, &result.spin})
    for (int k = 0; k < 3; ++k) arb_set_round((*vector)[k].arb(), (*vector)[k].arb(), bits);
  return result;
}

Walls::Walls(const ExactCase& exact, const ExactBall& ball) {
  const Enclosure radius = enclosure_of(ball.radius);
  for (const auto& given : exact.walls) {
    Wall wall{given.kind, enclosure_of(given.normal), Enclosure(), Enclosure(), Enclosure()};
    const Enclosure size = enclosure_of(given.size);
    if (given.kind == ExactWall::plane) {
      wall.length = norm<Enclosure>(wall.outward);
      wall.offset = wall.length * (size - radius) + dot<Enclosure>(wall.outward, enclosure_of(given.point));
    } else {
      wall.room = size - radius;
      wall.offset = wall.room * wall.room;
    }
    walls_.push_back(std::move(wall));
  }
}

Enclosure Walls::value(std::size_t wall, const Vector& place) const {
  const Wall& w = walls_[wall];
  if (w.kind == ExactWall::plane) return w.offset - dot<Enclosure>(w.outward, place);
  return w.offset - squared_norm<Enclosure>(across(w.kind, place));
}

Gap Walls::gap(std::size_t wall, const InVessel& ball) const {
  const Wall& w = walls_[wall];
  if (w.kind == ExactWall::plane)
    return {value(wall, ball.place), -dot<Enclosure>(w.outward, ball.velocity),
            -dot<Enclosure>(w.outward, ball.acceleration)};
  const Vector p = across(w.kind, ball.place), u = across(w.kind, ball.velocity),
               a = across(w.kind, ball.acceleration);
  return {value(wall, ball.place), -2 * dot<Enclosure>(p, u),
          -2 * (squared_norm<Enclosure>(u) + dot<Enclosure>(p, a))};
}

Vector Walls::normal(std::size_t wall, const Vector& place) const {
  const Wall& w = walls_[wall];
  if (w.kind == ExactWall::plane) return -w.outward / w.length;
  return -across(w.kind, place) / w.room;
}

auto WallExclusion::window(int depth, long index) -> const Window& {
  const auto found = windows_.find({depth, index});
  if (found != windows_.end()) return found->second;
  const auto at = [&](long k) {
    Enclosure share(static_cast<double>(k));
    arb_mul_2exp_si(share.arb(), share.arb(), -depth);
    return span_.begin + (span_.end - span_.begin) * share;
  };
  const Enclosure from = at(index), to = at(index + 1), middle = (from + to) / 2;
  Enclosure all;
  arb_union(all.arb(), from.arb(), to.arb(), Precision::bits());
  const auto seen = [&](const Enclosure& time) {
    return Motion::in_vessel(motion_.pose(time), span_.flight.position_at(time, gravity_),
                             span_.flight.velocity_at(time, gravity_), gravity_);
  };
  return windows_.emplace(std::pair(depth, index), Window{all - middle, seen(middle), seen(all)})
      .first->second;
}

bool WallExclusion::bisect(std::size_t wall, int depth, long index, std::string& text) {
  const Window& w = window(depth, index);
  const Gap middle = walls_.gap(wall, w.middle);
  const Enclosure second = walls_.gap(wall, w.all).second, &s = w.length_from_middle;
  Enclosure square;
  arb_sqr(square.arb(), s.arb(), Precision::bits());
  const Enclosure value = middle.value + middle.rate * s + second * square / 2,
                  rate = middle.rate + second * s;
  const bool first = index == 0, last = index + 1 == 1L << depth;
  const auto leaf = [&](char kind) {
    text += kind + std::to_string(depth);
    return true;
  };
  if (value.is_positive()) return leaf('p');
  if (first && span_.begin_wall == static_cast<int>(wall) && rate.is_positive()) return leaf('r');
  if (last && span_.end_wall == static_cast<int>(wall) && rate.is_negative()) return leaf('f');
  if (depth == deepest) return false;
  return bisect(wall, depth + 1, 2 * index, text) && bisect(wall, depth + 1, 2 * index + 1, text);
}

std::string WallExclusion::windows(std::size_t wall) {
  std::string text;
  return bisect(wall, 0, 0, text) ? text : "";
}

bool apart(const Flight& one, const Flight& two, const Enclosure& reach, const Vector& gravity,
           const Enclosure& begin, const Enclosure& end) {
  const auto at_begin = pair_gap(one, two, reach, gravity, begin),
             at_end = pair_gap(one, two, reach, gravity, end);
  const Enclosure value = at_begin.value(), half_rate = at_begin.half_rate();
  if (value.is_positive() && half_rate.is_not_negative()) return true;
  if (at_end.value().is_positive() && at_end.half_rate().is_not_positive()) return true;
  // The tangent of a convex function lies below it.
  if (value.is_positive() && (value + 2 * half_rate * (end - begin)).is_positive()) return true;
  return less(half_rate * half_rate, squared_norm<Enclosure>(at_begin.relative) * value);
}

}  // namespace edmill::prove
