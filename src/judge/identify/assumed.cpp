#include "identify/assumed.hpp"

#include <fmt/format.h>

#include <numbers>

namespace edmill::identify {

Vec Axes::of(const Vec& v) const {
  Vec turned;
  for (std::size_t k = 0; k < 3; ++k) turned[k] = sign[k] * v[from[k]];
  return turned;
}

namespace {

/// Transforms the vectors of an event from another frame to that of the laboratory.
void to_laboratory(LoggedEvent& event, LogFrame from, const Mill& mill) {
  const auto frame = audit::vessel_at(mill, event.time, false);
  const auto turned = [&](const Vec& v) { return Vec(frame.x * v[0] + frame.y * v[1] + frame.z * v[2]); };
  const bool moves = from == LogFrame::vessel;
  for (auto& body : event.body) {
    body.position = turned(body.position);
    if (moves) body.position += frame.centre;
    const Vec of_vessel =
        moves ? audit::wall_velocities[0].at({frame, frame, body.position, body.position}) : Vec(0, 0, 0);
    for (auto* v : {&body.velocity_before, &body.velocity_after}) *v = turned(*v) + of_vessel;
    for (auto* w : {&body.spin_before, &body.spin_after}) {
      *w = turned(*w);
      if (moves) *w += frame.angular_velocity;
    }
  }
}

/// True if a ball with a number in [first, end) takes part in an impact.
bool takes_part(const LoggedEvent& event, std::size_t first, std::size_t end) {
  const auto is_one = [&](int ball) {
    return ball >= static_cast<int>(first) && ball < static_cast<int>(end);
  };
  return is_one(event.ball) || (!event.with_wall && is_one(event.partner));
}

}  // namespace

void LogChange::apply(LoggedEvent& event, const Mill& mill) const {
  event.time = event.time * time + delay;
  event.milling_dose *= energies;
  event.wall_work *= energies;
  event.approach_speed *= speeds;
  event.slip_speed *= speeds;
  for (auto& body : event.body) {
    body.position = axes_of_positions.of(body.position * positions);
    for (auto* v : {&body.velocity_before, &body.velocity_after}) *v = axes_of_velocities.of(*v * velocities);
    for (auto* w : {&body.spin_before, &body.spin_after}) *w = axes_of_spins.of(*w * spins);
    if (reversed_in_time) {
      std::swap(body.velocity_before, body.velocity_after);
      std::swap(body.spin_before, body.spin_after);
    }
  }
  if (frame != LogFrame::laboratory) to_laboratory(event, frame, mill);
  if (states_exchanged && !event.with_wall) std::swap(event.body[0], event.body[1]);
  if (exchanged[0] < 0) return;
  const auto renamed = [&](int& ball) {
    if (ball == exchanged[0])
      ball = exchanged[1];
    else if (ball == exchanged[1])
      ball = exchanged[0];
  };
  renamed(event.ball);
  if (!event.with_wall) renamed(event.partner);
}

CaseSpec Assumed::case_file() const {
  if (phases.empty() || !casefile::problems_of(spec).empty()) return spec;
  auto joints = casefile::joints_of(spec.mill);
  if (joints.size() != this->joints) return spec;  // a mistake has replaced the mill
  for (const auto& [place, more] : phases) {
    auto& joint = joints.at(place[0]);
    auto& angle = place[1] < joint.swings.size() ? joint.swings[place[1]].phase : joint.angle;
    angle = exactly(angle.to<double>() + more / (2 * std::numbers::pi));
  }
  CaseSpec changed = spec;
  changed.mill = model::Chain<Quantity>{{std::move(joints), casefile::period_of(spec.mill)}};
  return changed;
}

std::optional<Case> Assumed::built() const {
  const auto file = case_file();
  if (!casefile::problems_of(file).empty()) return std::nullopt;
  Case result;
  result.mill = casefile::build_mill<double>(file);
  result.balls = balls;
  const auto& vessel = result.mill.vessel;
  const bool room = std::none_of(balls.begin(), balls.end(),
                                 [&](const auto& ball) { return vessel.inset(ball.radius).is_empty(); });
  if (!room || result.mill.wall_count() != walls) return std::nullopt;
  return result;
}

Assumed assumed_of(const CaseSpec& spec) {
  const auto built = casefile::build_case<double>(spec).the_case;
  return {spec, built.balls, {}, built.mill.wall_count(), casefile::joints_of(spec.mill).size()};
}

Quantity exactly(double value) {
  // A case cannot contain nan or infinity. 0 is used instead: it is refused or fits as badly.
  return Quantity::exactly(std::isfinite(value) ? value : 0.0);
}

std::vector<BallGroup> ball_groups(const CaseSpec& spec) {
  std::vector<BallGroup> groups;
  std::size_t next = 0;
  for (std::size_t k = 0; k < spec.balls.size(); ++k, ++next)
    groups.push_back({"ball." + std::to_string(k), next, next + 1, &spec.balls[k]});
  for (std::size_t k = 0; k < spec.batches.size(); ++k) {
    const std::size_t count = spec.batches[k].count;
    groups.push_back({"balls." + std::to_string(k), next, next + count, &spec.batches[k]});
    next += count;
  }
  return groups;
}

std::vector<SharedSubset> subsets_of(const CaseSpec& spec, const Case& the_case,
                                     const std::vector<LoggedEvent>& events,
                                     const std::vector<Branches>& branches) {
  std::vector<SharedSubset> list;
  const auto add = [&](std::string name, bool of_flights, auto contains) {
    list.push_back(std::make_shared<Subset>(Subset{std::move(name), contains, of_flights}));
  };
  const auto of_impacts = [&](std::string name, auto holds) {
    add(std::move(name), false,
        [&events, holds](const RowPlace& at) { return !at.of_flight && holds(events[at.event], at.event); });
  };
  of_impacts("with walls", [](auto& e, std::size_t) { return e.with_wall; });
  of_impacts("between balls", [](auto& e, std::size_t) { return !e.with_wall; });
  const auto walls = the_case.mill.walls();
  for (int wall = 0; wall < static_cast<int>(walls.size()); ++wall)
    of_impacts("at " + walls[wall].meaning,
               [wall](auto& e, std::size_t) { return e.with_wall && e.partner == wall; });
  /// Adds the impacts at the walls that satisfy `is_one`, if these are several but not all.
  const auto at_walls = [&](const std::string& name, const auto& is_one) {
    std::vector<bool> at;
    for (int wall = 0; wall < static_cast<int>(walls.size()); ++wall) at.push_back(is_one(wall));
    const std::size_t number = std::count(at.begin(), at.end(), true);
    if (number > 1 && number < at.size())
      of_impacts("at " + name, [at](auto& e, std::size_t) { return e.with_wall && at[e.partner]; });
  };
  const auto& mill = the_case.mill;
  at_walls("flat walls", [&](int k) { return !mill.body_of(k) && mill.vessel.is_flat(k); });
  at_walls("round walls", [&](int k) { return !mill.body_of(k) && !mill.vessel.is_flat(k); });
  at_walls("bodies in the vessel", [&](int k) { return mill.body_of(k) != nullptr; });
  for (std::size_t k = 0; k < spec.materials.size() && !spec.wall_materials.empty(); ++k)
    at_walls("walls of " + spec.materials[k].name,
             [&](int wall) { return spec.wall_materials[wall] == static_cast<int>(k) + 1; });
  const auto groups = ball_groups(spec);
  for (const auto& group : groups)
    if (groups.size() > 1 && group.last - group.first > 1)
      of_impacts("in impacts of " + group.key,
                 [group](auto& e, std::size_t) { return takes_part(e, group.first, group.last); });
  const auto of_branch = [&](const char* name, bool Branches::*member, bool value) {
    of_impacts(name, [=, &branches](const LoggedEvent&, std::size_t k) {
      return branches[k].known && branches[k].*member == value;
    });
  };
  of_branch("where contacts stick", &Branches::sticks, true);
  of_branch("where contacts slide", &Branches::sticks, false);
  of_branch("where the least separation speed applies", &Branches::at_least_separation, true);
  of_branch("where the restitution applies", &Branches::at_least_separation, false);
  const auto& balls = the_case.balls;
  of_impacts("between balls that are not alike",
             [&balls](auto& e, std::size_t) { return !e.with_wall && !(balls[e.ball] == balls[e.partner]); });
  // Rows of both bodies, those of the energy, are affected by a change of either body.
  add("on the partner", false,
      [&events](const RowPlace& at) { return !at.of_flight && at.body != 0 && !events[at.event].with_wall; });
  add("on the ball, not its partner", false,
      [&events](const RowPlace& at) { return !at.of_flight && at.body != 1 && !events[at.event].with_wall; });
  constexpr int most_balls = 40;
  const int count = static_cast<int>(balls.size());
  for (int ball = 0; ball < count && count <= most_balls && count > 1; ++ball) {
    of_impacts(fmt::format("in impacts of ball {}", ball),
               [ball](auto& e, std::size_t) { return takes_part(e, ball, ball + 1); });
    add(fmt::format("on ball {}", ball), true, [&events, ball](const RowPlace& at) {
      const auto& event = events[at.event];
      return at.body < 0 ? takes_part(event, ball, ball + 1) : event.ball_at(at.body) == ball;
    });
  }
  return list;
}

}  // namespace edmill::identify
