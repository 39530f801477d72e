// Numbers of the joints of a mill that are not keys of its type.
#include <fmt/format.h>

#include <array>
#include <numbers>

#include "identify/parameters.hpp"

namespace edmill::identify {

using casefile::Quantity;

using std::numbers::pi;

void add_joints(const Assumptions& nominal, std::vector<Parameter>& list) {
  const auto& joints = std::get<model::Chain<Quantity>>(nominal.spec.mill).given.list;
  const auto add = [&](const std::string& key, Dimension dimension, double unit, const Quantity& value,
                       auto member) {
    if (value.zero()) return;
    list.push_back(
        number(key, "", dimension, unit * value.to<double>(), [member, unit](Assumptions& a, double x) {
          member(std::get<model::Chain<Quantity>>(a.spec.mill).given.list) = exactly(x / unit);
        }));
  };
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const std::string key = fmt::format("mill.joint.{}", j);
    for (std::size_t axis = 0; axis < 3; ++axis)
      add(
          with_axis(key + ".translate", static_cast<int>(axis)), Dimension::length, 1,
          joints[j].shift[axis], [=](auto& l) -> auto& { return l[j].shift[axis]; });
    add(
        key + ".angle", Dimension::angle, 2 * pi,
        joints[j].angle, [=](auto& l) -> auto& { return l[j].angle; });
    add(
        key + ".speed", joints[j].rotates ? Dimension::angular_speed : Dimension::speed,
        joints[j].rotates ? 2 * pi : 1, joints[j].speed, [=](auto& l) -> auto& { return l[j].speed; });
    if (joints[j].rotates && !joints[j].speed.zero()) list.back().is_speed = true;
    for (std::size_t s = 0; s < joints[j].swings.size(); ++s) {
      const std::string swing = fmt::format("{}.swing.{}", key, s);
      const auto& own = joints[j].swings[s];
      add(
          swing + ".amplitude", joints[j].rotates ? Dimension::angle : Dimension::length,
          joints[j].rotates ? 2 * pi : 1,
          own.amplitude, [=](auto& l) -> auto& { return l[j].swings[s].amplitude; });
      add(
          swing + ".speed", Dimension::angular_speed, 2 * pi,
          own.frequency, [=](auto& l) -> auto& { return l[j].swings[s].frequency; });
      list.back().is_speed = true;
    }
  }
}

namespace {

using Joint = model::Joint<Quantity>;

/// "x", or the direction, of which the joint's axis is one.
std::string axis_text(const Joint& joint) {
  std::array<double, 3> a{};
  for (std::size_t k = 0; k < 3; ++k) a[k] = joint.axis[k].to<double>();
  for (std::size_t k = 0; k < 3; ++k)
    if (a[k] != 0 && a[(k + 1) % 3] == 0 && a[(k + 2) % 3] == 0) return {"xyz"[k]};
  return fmt::format("({:g}, {:g}, {:g})", a[0], a[1], a[2]);
}

}  // namespace

void add_phases(const Assumptions& nominal, std::vector<Parameter>& list) {
  const bool chain = std::holds_alternative<model::Chain<Quantity>>(nominal.spec.mill);
  const auto joints = casefile::joints_of(nominal.spec.mill);
  std::vector<Parameter> phases;
  const auto add = [&](std::size_t j, std::size_t place, std::string key, const Quantity& turns) {
    const double value = chain ? 2 * pi * turns.to<double>() : 0;
    auto p = number(std::move(key), "", Dimension::angle, value, [=](Assumptions& a, double x) {
      a.phases[{j, place}] = x - value;
    });
    p.change = 0.1, p.cycle = 2 * pi, p.has_unit = false;
    p.prior = 1;  // of two that fit alike, the phase of the drive comes first
    phases.push_back(std::move(p));
  };
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto& swings = joints[j].swings;
    const auto name = [&](const std::string& in_file, const char* moves) {
      if (chain) return fmt::format("mill.joint.{}.{}", j, in_file);
      return fmt::format("mill, phase of joint {}, {} {}", j, moves, axis_text(joints[j]));
    };
    for (std::size_t s = 0; s < swings.size(); ++s)
      add(j, s, name(fmt::format("swing.{}.phase", s), joints[j].rotates ? "a swing about" : "a swing along"),
          swings[s].phase);
    const bool listed = chain && !joints[j].angle.zero();
    if (joints[j].rotates && !joints[j].speed.zero() && !listed)
      add(j, swings.size(), name("angle", "turning about"), joints[j].angle);
  }
  if (phases.size() < 2) return;  // it is that of the drive
  for (auto& p : phases) list.push_back(std::move(p));
}

}  // namespace edmill::identify
