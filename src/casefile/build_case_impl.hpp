// Implementation of build_case; included by the instantiation files only.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string>

#include "base/errors.hpp"
#include "casefile/build_case.hpp"
#include "casefile/joints.hpp"
#include "casefile/quantity_value.hpp"
#include "casefile/random.hpp"
#include "io/final_state.hpp"

namespace edmill::casefile {

namespace detail {

template <class Real>
Vec3<Real> to_vector(const casefile::QuantityVector& q) {
  return {q[0].to<Real>(), q[1].to<Real>(), q[2].to<Real>()};
}

template <class Real>
model::ContactLaw<Real> to_law(const casefile::ContactSpec& spec) {
  return model::convert_law<Real>(spec, [](const casefile::Quantity& q) { return q.to<Real>(); });
}

template <class Real, template <class> class Part>
Part<Real> to_part(const Part<casefile::Quantity>& part) {
  return model::converted<Part, Real>(part, [](const casefile::Quantity& q) { return q.to<Real>(); });
}

template <class Real>
model::AnyMotion<Real> to_motion(const auto& part, const casefile::CaseSpec& spec) {
  if constexpr (requires { part.joints(); }) {
    const auto to = [](const casefile::Quantity& q) { return q.to<Real>(); };
    auto joints = model::converted_joints<Real>(with_phases(part.joints()), to);
    // Events are predicted some time beyond the end.
    if (spec.end_time) joints.times = {to(spec.initial_time), to(*spec.end_time) + joints.period};
    return model::ChainMotion<Real>(joints);
  } else {
    return to_part<Real>(part).motion();
  }
}

template <class Real>
model::Pistons<Real> to_pistons(const casefile::CaseSpec& spec) {
  const auto to = [](const casefile::Quantity& q) { return q.to<Real>(); };
  const auto& period = period_of(spec.mill);
  std::vector<model::Piston<Real>> pistons;
  for (const auto& p : spec.pistons)
    pistons.push_back({p.wall, to(p.distance), to(p.speed),
                       model::converted_swings<Real>(with_phases(p.swings, period), to)});
  return {std::move(pistons), to(period)};
}

template <class Real>
model::BallProperties<Real> to_ball(const casefile::BallSpec& spec, const Real& diameter) {
  const Real radius = diameter / 2;
  const Real volume = 4 * numerics::pi<Real>() * (radius * radius * radius) / 3;
  return {radius, spec.density.to<Real>() * volume, spec.reduced_inertia.to<Real>(), spec.material};
}

/// The laws of pairs, with a table of which applies where.
template <class Real>
model::PairLaws<Real> to_pairs(const casefile::CaseSpec& spec, int walls) {
  model::PairLaws<Real> pairs;
  if (spec.pairs.empty()) return pairs;
  pairs.materials = spec.materials.size() + 1;
  const auto law_of = [&](int one, int other) {
    for (std::size_t k = 0; k < spec.pairs.size(); ++k)
      if (spec.pairs[k].is_of(one, other)) return static_cast<int>(k);
    return -1;
  };
  for (int one = 0; one < static_cast<int>(pairs.materials); ++one) {
    for (int other = 0; other < static_cast<int>(pairs.materials); ++other)
      pairs.of_balls.push_back(law_of(one, other));
    for (std::size_t wall = 0; wall < static_cast<std::size_t>(walls); ++wall)
      pairs.of_walls.push_back(law_of(one, spec.wall_materials.at(wall)));
  }
  for (const auto& pair : spec.pairs) pairs.laws.push_back(to_law<Real>(pair.law));
  return pairs;
}

/// Placed balls by cells of at least the widest centre distance that matters, in the vessel frame.
template <class Real>
class PlacedBalls {
 public:
  explicit PlacedBalls(double cell) : cell_(cell) {}

  void add(int index, const Vec3<Real>& p) { cells_[key(p, 0, 0, 0)].push_back({index, p}); }

  /// A ball closer to `p` than `least(index)`, or -1.
  template <class Least>
  int conflict(const Vec3<Real>& p, Least&& least) const {
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const auto found = cells_.find(key(p, x, y, z));
          if (found == cells_.end()) continue;
          for (const auto& [index, position] : found->second) {
            const Vec3<Real> between = p - position;
            const Real distance = least(index);
            if (dot<Real>(between, between) < distance * distance) return index;
          }
        }
    return -1;
  }

 private:
  using Key = std::array<double, 3>;  // whole numbers of any size
  Key key(const Vec3<Real>& p, int dx, int dy, int dz) const {
    const auto cell = [&](const Real& c) { return std::floor(static_cast<double>(c) / cell_); };
    return {cell(p[0]) + dx, cell(p[1]) + dy, cell(p[2]) + dz};
  }
  struct Entry {
    int index;
    Vec3<Real> position;
  };
  double cell_;
  std::map<Key, std::vector<Entry>> cells_;
};

template <class Real>
class Filling {
 public:
  Filling(const casefile::CaseSpec& spec, InitialCase<Real>& result)
      : spec_(spec),
        result_(result),
        mill_(result.the_case.mill),
        pose_(mill_.motion.pose(result.start)),
        random_(spec.seed),
        placed_(widest_distance(spec)) {}

  void add_explicit(const casefile::ExplicitBall& spec) {
    const auto ball = to_ball<Real>(spec, spec.diameter.to<Real>());
    const model::BallState<Real> state{to_vector<Real>(spec.position), to_vector<Real>(spec.velocity),
                                       to_vector<Real>(spec.spin)};
    add_checked(ball, state, spec.where);
  }

  /// A ball whose state is given: it must be inside and touch no other, up to rounding.
  void add_checked(const model::BallProperties<Real>& ball, const model::BallState<Real>& state,
                   const std::string& where) {
    const auto local = mill_.motion.to_vessel_frame(pose_, state.position, state.velocity).position;
    const std::string own = std::to_string(result_.states.size());
    const Real tolerance = ball.radius / 1000000000;
    if (!inside(local, ball.radius - tolerance))
      problems_.push_back(where + ": found ball " + own + " outside the vessel, expected it inside");
    const int other = placed_.conflict(
        local, [&](int k) { return ball.radius + result_.the_case.balls[k].radius - tolerance; });
    if (other >= 0)
      problems_.push_back(where + ": found ball " + own + " overlapping ball " + std::to_string(other) +
                          ", expected balls that do not overlap");
    add(ball, local, state);
  }

  void add_batch(const casefile::BallBatch& batch) {
    const Real diameter = batch.diameter.to<Real>(), spread = batch.diameter_spread.to<Real>();
    const Real gap_ball = batch.gap_ball.to<Real>(), gap_wall = batch.gap_wall.to<Real>();
    const Vec3<Real> velocity = to_vector<Real>(batch.velocity);
    for (int k = 0; k < batch.count; ++k) {
      const Real own = spread > 0 ? Real(diameter + spread * random_.symmetric<Real>()) : diameter;
      const auto ball = to_ball<Real>(batch, own);
      const auto local = place(batch, k, ball.radius, gap_ball, gap_wall);
      if (!local) return;  // reported
      model::BallState<Real> state{mill_.motion.to_inertial(pose_, *local), velocity,
                                   Vec3<Real>(Real(0), Real(0), Real(0))};
      if (batch.random_speed) state.velocity = random_velocity(batch.random_speed->to<Real>());
      add(ball, *local, state);
    }
  }

  const std::vector<std::string>& problems() const { return problems_; }

 private:
  static double widest_distance(const casefile::CaseSpec& spec) {
    double diameter = 0, gap = 0;
    for (const auto& b : spec.balls) diameter = std::max(diameter, b.diameter.to<double>());
    for (const auto& b : spec.batches) {
      diameter = std::max(diameter, b.diameter.to<double>() + b.diameter_spread.to<double>());
      gap = std::max(gap, b.gap_ball.to<double>());
    }
    return (diameter + gap) * 1.001;
  }

  bool inside(const Vec3<Real>& local, const Real& radius) const {
    return mill_.vessel.inset(radius).contains(local) && clears_pistons(local, radius);
  }
  bool clears_pistons(const Vec3<Real>& local, const Real& radius) const {
    const auto* pistons = mill_.vessel.pistons();
    for (std::size_t k = 0; pistons && k < pistons->count(); ++k)
      if (mill_.vessel.gap(pistons->wall(k), local) < radius + pistons->at(k, result_.start).value)
        return false;
    return true;
  }

  void add(const model::BallProperties<Real>& ball, const Vec3<Real>& local,
           const model::BallState<Real>& state) {
    placed_.add(static_cast<int>(result_.states.size()), local);
    result_.the_case.balls.push_back(ball);
    result_.states.push_back(state);
  }

  /// A free place in the vessel frame, uniform over those that keep the gaps.
  std::optional<Vec3<Real>> place(const casefile::BallBatch& batch, int k, const Real& radius,
                                  const Real& gap_ball, const Real& gap_wall) {
    const auto room = mill_.vessel.inset(radius).inset(gap_wall);
    if (room.is_empty()) {
      problems_.push_back(
          batch.where +
          ": found balls too large for the vessel, expected a diameter that fits with gap_wall");
      return std::nullopt;
    }
    for (std::uint64_t tries = 0; tries <= batch.max_relocations; ++tries) {
      const Real x = random_.symmetric<Real>(), z = random_.symmetric<Real>(), y = random_.symmetric<Real>();
      const auto local = room.place({x, y, z});
      if (!local || !clears_pistons(*local, radius + gap_wall)) continue;
      if (placed_.conflict(*local, [&](int other) {
            return radius + result_.the_case.balls[other].radius + gap_ball;
          }) < 0)
        return local;
    }
    problems_.push_back(batch.where + ": found no room for ball " + std::to_string(k + 1) + " of " +
                        std::to_string(batch.count) + " after " + std::to_string(batch.max_relocations) +
                        " relocations, expected fewer balls, smaller gaps or a larger max_relocations");
    return std::nullopt;
  }

  /// Uniform direction, and a size uniform up to `largest`.
  Vec3<Real> random_velocity(const Real& largest) {
    for (;;) {
      const Vec3<Real> v{random_.symmetric<Real>(), random_.symmetric<Real>(), random_.symmetric<Real>()};
      const Real size = norm<Real>(v);
      if (size > 1 || !(size > 0)) continue;
      return v * (largest * random_.uniform<Real>() / size);
    }
  }

  const casefile::CaseSpec& spec_;
  InitialCase<Real>& result_;
  const model::Mill<Real>& mill_;
  model::AnyPose<Real> pose_;
  Random random_;
  PlacedBalls<Real> placed_;
  std::vector<std::string> problems_;
};

/// Diameters as the case says, states from a final_state.csv.
template <class Real>
void fill_from_file(const casefile::CaseSpec& spec, InitialCase<Real>& result) {
  const auto saved = io::read_final_state<Real>(spec.initial_state);
  if (saved.states.size() != spec.ball_count())
    throw InputError(spec.initial_state + ": found " + std::to_string(saved.states.size()) +
                     " balls, expected the case's " + std::to_string(spec.ball_count()));
  const DriveClock<Real> clock(result.the_case.mill.motion.period());
  if (saved.time.offset >= clock.period())
    throw InputError(spec.initial_state +
                     ":2: found a drive_offset of a whole drive period or more, expected " +
                     "one below the case's period of " + to_text<Real>(clock.period()) + " s");
  if (spec.end_time && saved.time >= *result.the_case.stop.end_time)
    throw InputError(spec.initial_state + ":2: found a state at " + to_text<Real>(clock.seconds(saved.time)) +
                     " s, expected one before the case's end_time");
  result.start = saved.time;
  Filling<Real> filling(spec, result);
  Random random(spec.seed);
  std::size_t k = 0;
  for (const auto& b : spec.balls) {
    filling.add_checked(to_ball<Real>(b, b.diameter.template to<Real>()), saved.states[k], b.where);
    ++k;
  }
  for (const auto& b : spec.batches) {
    if (b.diameter_spread.positive())
      throw InputError(b.where +
                       ": found diameter_spread with an initial state, expected balls of one diameter");
    for (int n = 0; n < b.count; ++n, ++k)
      filling.add_checked(to_ball<Real>(b, b.diameter.template to<Real>()), saved.states[k], b.where);
  }
  if (!filling.problems().empty()) throw InputError(filling.problems());
}

}  // namespace detail

namespace detail {

/// Refuses what the scalar cannot resolve: balls about as small as the rounding of a position, and a least
/// separation speed whose hops are lower than that.
template <class Real>
void require_resolution(const casefile::CaseSpec& spec, const InitialCase<Real>& built) {
  using std::sqrt;
  const auto& mill = built.the_case.mill;
  const Real reach = mill.motion.reach(mill.vessel.reach()), gravity = norm<Real>(mill.gravity);
  Real fastest = 2 * mill.motion.speed_within(reach) + 4 * sqrt(gravity * reach);
  for (const auto& state : built.states) fastest = std::max(fastest, norm<Real>(state.velocity));
  const Real rounding = epsilon<Real>() / 2 * (24 * reach + 16 * fastest * mill.motion.period());
  const Real least_radius = 8000000 * rounding;  // so that a missed impact is told from rounding
  const auto number = [](const Real& x) { return fmt::format("{:.3g}", static_cast<double>(x)); };
  std::vector<std::string> problems;
  const auto check = [&](const casefile::BallSpec& ball, const Real& diameter) {
    if (diameter / 2 < least_radius)
      problems.push_back(ball.where + ": found a ball of radius " + number(diameter / 2) +
                         " m, expected at least " + number(least_radius) + " m: in this mill " +
                         std::string(ScalarName<Real>::value) + " knows a position to " + number(rounding) +
                         " m; a wider precision knows it better");
  };
  for (const auto& ball : spec.balls) check(ball, ball.diameter.template to<Real>());
  for (const auto& ball : spec.batches)
    check(ball, ball.diameter.template to<Real>() - ball.diameter_spread.template to<Real>());
  const Real least_hop = 4 * sqrt(rounding * (mill.motion.acceleration_within(reach) + gravity));
  const auto check_least = [&](const Real& speed, const std::string& section) {
    if (speed > 0 && speed < least_hop)
      problems.push_back(spec.file + ": key '" + section + ".least_separation': found " + number(speed) +
                         " m/s, expected 0 or at least " + number(least_hop) +
                         " m/s: hops of a slower ball are lost in the rounding of " +
                         std::string(ScalarName<Real>::value));
  };
  check_least(mill.ball_ball.least_separation, "contact.ball_ball");
  check_least(mill.ball_wall.least_separation, "contact.ball_wall");
  for (std::size_t k = 0; k < mill.pairs.laws.size(); ++k)
    check_least(mill.pairs.laws[k].least_separation, "contact.pair." + std::to_string(k));
  if (!problems.empty()) throw InputError(problems);
}

}  // namespace detail

template <class Real>
model::AnyVessel<Real> build_vessel(const VesselSpec& spec) {
  return std::visit([](const auto& v) { return model::AnyVessel<Real>(detail::to_part<Real>(v).vessel()); },
                    spec);
}

template <class Real>
model::Mill<Real> build_mill(const casefile::CaseSpec& spec) {
  auto vessel = build_vessel<Real>(spec.vessel);
  if (!spec.pistons.empty()) vessel.set(detail::to_pistons<Real>(spec));
  const int walls = vessel.wall_count();
  return {std::visit([&](const auto& m) { return detail::to_motion<Real>(m, spec); }, spec.mill),
          std::move(vessel),
          detail::to_vector<Real>(spec.gravity),
          detail::to_law<Real>(spec.ball_ball),
          detail::to_law<Real>(spec.ball_wall),
          detail::to_pairs<Real>(spec, walls)};
}

template <class Real>
InitialCase<Real> build_case(const casefile::CaseSpec& spec, bool resolved) {
  return build_case_in(build_mill<Real>(spec), spec, resolved);
}

template <class Real>
InitialCase<Real> build_case_in(const model::Mill<Real>& mill, const casefile::CaseSpec& spec,
                                bool resolved) {
  InitialCase<Real> result;
  auto& c = result.the_case;
  c.mill = mill;
  const auto instant = [&](const casefile::Quantity& time) {
    return casefile::instant_at<Real>(time, casefile::period_of(spec.mill));
  };
  c.initial_time = instant(spec.initial_time);
  c.statistics_start = instant(spec.statistics_start);
  if (spec.end_time) c.stop.end_time = instant(*spec.end_time);
  if (spec.max_milling_dose) c.stop.max_milling_dose = spec.max_milling_dose->to<Real>();
  if (spec.max_ball_speed) c.stop.max_ball_speed = spec.max_ball_speed->to<Real>();
  c.stop.max_collisions = spec.max_collisions;
  result.start = c.initial_time;
  if (!spec.initial_state.empty()) {
    detail::fill_from_file(spec, result);
    if (resolved) detail::require_resolution(spec, result);
    return result;
  }
  detail::Filling<Real> filling(spec, result);
  for (const auto& ball : spec.balls) filling.add_explicit(ball);
  for (const auto& batch : spec.batches) filling.add_batch(batch);
  if (!filling.problems().empty()) throw InputError(filling.problems());
  if (resolved) detail::require_resolution(spec, result);
  return result;
}

}  // namespace edmill::casefile
