#include "motion.hpp"

#include "pose.hpp"

namespace checker {

Vec Motion::relative_velocity(Index i, Index j, const Real& t) const {
  return velocity(i, middle(t)) - velocity(j, middle(t));
}

Vec Motion::separation(Index i, Index j, const Real& t) const {
  const Real m = middle(t);
  return position(i, m) - position(j, m) + relative_velocity(i, j, t) * (t - m);
}

Real Motion::gap(const Contact& contact, const Real& t) const {
  if (contact.with_wall) {
    const Wall& wall = mill.walls[contact.other];
    const Vec place = pose_of(mill, wall, t).place(position(contact.ball, t));
    return checker::gap(wall, mill.balls[contact.ball], place);
  }
  const Vec x = separation(contact.ball, contact.other, t);
  const Real distance = reach(contact.ball, contact.other);
  return dot(x, x) - distance * distance;
}

Real Motion::gap_rate(const Contact& contact, const Real& t) const {
  if (contact.with_wall) {
    const Wall& wall = mill.walls[contact.other];
    const Pose pose = pose_of(mill, wall, t);
    const Vec r = position(contact.ball, t);
    return checker::gap_rate(wall, pose.place(r), pose.velocity(r, velocity(contact.ball, t)));
  }
  return dot(separation(contact.ball, contact.other, t),
      relative_velocity(contact.ball, contact.other, t));
}

}  // namespace checker
