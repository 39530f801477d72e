#include "dynamics/body_groups.hpp"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

#include "base/errors.hpp"

namespace edmill::dynamics {

namespace {

using Joint = model::Joint<double>;
using List = std::vector<Joint>;

bool moves(const Joint& joint) { return joint.speed != 0 || !joint.swings.empty(); }

/// Whether a constant joint may as well follow a rotation: both are about or along one axis.
bool commutes(const Joint& constant, const Joint& rotation) {
  if (!rotation.rotates) return false;
  const auto direction = model::ChainBounds<double>::direction(constant);
  const Vec3<double> along = constant.rotates
      ? direction
      : Vec3<double>(constant.shift[0], constant.shift[1], constant.shift[2]);
  return norm<double>(cross<double>(along, model::ChainBounds<double>::direction(rotation))) <=
      1e-15 * norm<double>(along);
}

/// The joints up to the last one that moves, and the constant ones after it.
std::pair<List, List> split(List joints) {
  const auto last = std::find_if(joints.rbegin(), joints.rend(), moves);
  auto rest = last.base();  // the first joint behind the last one that moves
  for (bool swapped = true; swapped && rest - joints.begin() > 1;) {
    const auto before = rest - 2, moving = rest - 1;
    swapped = !moves(*before) && commutes(*before, *moving);
    if (!swapped) continue;
    std::iter_swap(before, moving);
    --rest;
  }
  return {List(joints.begin(), rest), List(rest, joints.end())};
}

bool same(const List& one, const List& other) {
  const auto same_swing = [](const auto& a, const auto& b) {
    return a.amplitude == b.amplitude && a.frequency == b.frequency && a.phase == b.phase;
  };
  const auto same_joint = [&](const Joint& a, const Joint& b) {
    const auto constants = [](const Joint& j) {
      return std::tie(j.rotates, j.axis, j.shift, j.angle, j.speed);
    };
    return constants(a) == constants(b) &&
        std::equal(a.swings.begin(), a.swings.end(), b.swings.begin(), b.swings.end(), same_swing);
  };
  return std::equal(one.begin(), one.end(), other.begin(), other.end(), same_joint);
}

}  // namespace

BodyGroups::BodyGroups(const std::vector<model::Body<double>>& bodies) {
  EDMILL_REQUIRE(bodies.size() <= most, "too many bodies");
  std::vector<List> moving;  // joints by group
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const auto& [motion, shape, name, on_vessel] = bodies[k];
    auto joints = motion.joints();
    auto [first, rest] = split(std::move(joints.list));
    const auto found = std::find_if(moving.begin(), moving.end(),
        [&, &own = first](const List& other) { return same(other, own); });
    const auto group = static_cast<std::size_t>(found - moving.begin());
    if (found == moving.end()) {
      moving.push_back(first);
      groups_.push_back({model::ChainMotion<double>({first, joints.period, joints.times}), {}});
    }
    const model::ChainMotion<double> constant({rest, joints.period, joints.times});
    const double speed = motion.wall_speed(shape.size());
    groups_[group].members.push_back({.body = k,
        .place = constant.pose({0, 0.0}),
        .shape = shape,
        .speed = speed * (1 + 1e-9),
        .margin = 1e-9 * shape.reach() + 1e-13 * motion.period() * speed});
  }
}

auto BodyGroups::clear_times(const Instant<double>& when, const Vec3<double>& position,
    double radius, double speed) const -> Times {
  using Motion = model::ChainMotion<double>;
  Times times;
  for (const auto& group : groups_) {
    const auto seen = Motion::position_in_vessel(group.motion.place(when), position);
    for (const auto& member : group.members) {
      const auto local = Motion::position_in_vessel(member.place, seen);
      times[member.body] = (member.shape.clearance(local) - radius - member.margin) /
          (speed * (1 + 1e-9) + member.speed);
    }
  }
  return times;
}

}  // namespace edmill::dynamics
