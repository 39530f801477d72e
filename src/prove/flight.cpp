#include "prove/flight.hpp"

#include "prove/exact_text.hpp"

namespace edmill::prove {

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

namespace {

/// Takes off what a round wall does not see: the component along a cylinder's axis, y.
Vector across(ExactWall::Kind kind, Vector v) {
  if (kind == ExactWall::cylinder) v[1] = Enclosure();
  return v;
}

}  // namespace

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

}  // namespace edmill::prove
