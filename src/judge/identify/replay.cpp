#include <numbers>

#include "base/errors.hpp"
#include "identify/identify.hpp"
#include "run/event_source.hpp"

namespace edmill::identify {

namespace {

constexpr std::size_t most_impacts = 1000;
constexpr double same_time = 1e-6;  ///< [drive periods]: impacts that differ by more are different

using Impact = model::ImpactRecord<double>;

class Replay {
 public:
  Replay(const Assumed& nominal, const EventsAtHand& log) {
    const auto initial = casefile::build_case<double>(nominal.spec);
    states_ = initial.states;
    const auto& mill = initial.the_case.mill;
    period_ = mill.motion.period();
    const DriveClock<double> clock(period_);
    start_ = clock.elapsed({0, 0.0}, initial.start);
    const auto pose = mill.motion.pose(initial.start);
    for (const auto& state : states_)
      places_.push_back(mill.motion.position_in_vessel(pose, state.position));
    for (const auto& e : log.events) {
      if (!e.problem.empty() || log_.size() == most_impacts) break;
      log_.push_back(e);
      log_.back().put_in_order();
    }
  }

  std::size_t count() const { return log_.size(); }

  /// The first impacts of the case with these values, from the initial state of the nominal one.
  std::vector<Impact> impacts(const Assumed& assumed, std::size_t count) const {
    CaseSpec spec = assumed.case_file();
    spec.batches.clear();
    spec.balls.clear();
    if (!spec.initial_state.empty()) spec.initial_time = exactly(start_);
    spec.initial_state.clear();
    if (!log_.empty()) {  // a mill whose balls come to rest has no more impacts
      const double last = log_[std::min(count, log_.size()) - 1].time;
      spec.end_time = exactly(start_ + 1.5 * std::max(last - start_, 0.0) + period_);
    }
    const auto built = assumed.built();
    if (!built) return {};
    const auto& mill = built->mill;
    const auto pose = mill.motion.pose(DriveClock<double>(mill.motion.period()).at(start_));
    const double volume = 4.0 / 3 * std::numbers::pi;
    for (std::size_t k = 0; k < states_.size(); ++k) {
      casefile::ExplicitBall ball;
      const auto& own = assumed.balls[k];
      ball.diameter = exactly(2 * own.radius);
      ball.density = exactly(own.mass / (volume * own.radius * own.radius * own.radius));
      ball.reduced_inertia = exactly(own.reduced_inertia);
      ball.material = own.material;
      const Vec place = in_vessel ? mill.motion.to_inertial(pose, places_[k]) : states_[k].position;
      for (int axis = 0; axis < 3; ++axis) {
        ball.position[axis] = exactly(place[axis]);
        ball.velocity[axis] = exactly(states_[k].velocity[axis]);
        ball.spin[axis] = exactly(states_[k].spin[axis]);
      }
      spec.balls.push_back(std::move(ball));
    }
    std::vector<Impact> list;
    try {
      const auto source = run::make_source("double", spec, true);
      for (const auto& e : source->next(count))
        list.push_back({.ball = e.ball,
            .with_wall = e.with_wall,
            .partner = e.partner,
            .time = static_cast<double>(e.time) / assumed.log.time - assumed.log.delay});
    } catch (const InputError&) {  // balls that do not fit into this vessel
    } catch (const UndecidedError&) {
    }
    return list;
  }

  /// Number of leading impacts that two lists have in common.
  std::size_t common(const std::vector<Impact>& one, const std::vector<Impact>& two) const {
    const auto same = [&](const Impact& a, const Impact& b) {
      return a.same_bodies(b) && std::abs(a.time - b.time) < same_time * period_;
    };
    const auto differing = std::mismatch(one.begin(), one.end(), two.begin(), two.end(), same);
    return differing.first - one.begin();
  }
  std::size_t follows(const std::vector<Impact>& list) const { return common(list, log_); }

  /// Differences in time between the impacts of a run and those of the log [s]. Each ball
  /// contributes its first impacts, `depth` at most, up to the first one whose partner differs.
  std::vector<double> differences(
      const std::vector<Impact>& list, std::size_t depth, std::vector<std::size_t>& places) const {
    std::vector<double> off;
    std::vector<std::size_t> next(states_.size(), 0), seen(states_.size(), 0);
    std::vector<std::vector<std::size_t>> of_ball(states_.size());
    for (std::size_t k = 0; k < log_.size(); ++k) {
      of_ball[log_[k].ball].push_back(k);
      if (!log_[k].with_wall) of_ball[log_[k].partner].push_back(k);
    }
    for (const auto& impact : list) {
      const std::size_t ball = impact.ball;
      if (seen[ball] >= depth || next[ball] >= of_ball[ball].size()) continue;
      const std::size_t k = of_ball[ball][next[ball]];
      if (!log_[k].same_bodies(impact)) {  // the partner differs: skip its later impacts
        seen[ball] = depth;
        continue;
      }
      ++next[ball];
      ++seen[ball];
      if (!impact.with_wall) ++next[impact.partner];
      off.push_back(impact.time - log_[k].time);
      places.push_back(k);
    }
    return off;
  }

  double period() const { return period_; }
  /// Whether the balls start at their positions in the vessel frame or in the inertial one.
  bool in_vessel = false;
 private:
  std::vector<model::BallState<double>> states_;
  std::vector<Vec> places_;  ///< in the vessel [m]
  std::vector<Impact> log_;
  double period_, start_;
};

double weighted_median(std::vector<std::pair<double, double>> values) {
  std::sort(values.begin(), values.end());
  double total = 0, sum = 0;
  for (const auto& [value, weight] : values) total += weight;
  for (const auto& [value, weight] : values)
    if ((sum += weight) >= total / 2) return value;
  return 0;
}

/// Fits a number to the times of the first impacts of the log: least absolute deviations, with
/// times linear in the number, over an increasing number of impacts of each ball.
/// @return the value, and its uncertainty from the scatter of the last impacts
std::pair<double, double> fit_value(const Replay& runs, const Assumed& base, const Assumption& p) {
  double value = p.value, open = std::abs(p.change);
  for (const std::size_t depth : {1, 1, 2, 2, 3, 4, 6, 8, 8}) {
    const std::size_t count = std::min(runs.count(), 2 * depth * base.balls.size() + 20);
    const double step = 1e-7 * p.change;
    std::vector<std::size_t> places, places_there;
    const auto off = runs.differences(runs.impacts(p.on(base, value), count), depth, places);
    const auto off_there =
        runs.differences(runs.impacts(p.on(base, value + step), count), depth, places_there);
    if (places != places_there || off.empty()) continue;
    std::vector<std::pair<double, double>> steps;
    for (std::size_t k = 0; k < off.size(); ++k) {
      const double slope = (off_there[k] - off[k]) / step;
      if (std::abs(slope) * p.change > 1e-9 * runs.period())
        steps.emplace_back(-off[k] / slope, std::abs(slope));
    }
    if (steps.empty()) continue;
    const double move = std::clamp(weighted_median(steps), -0.3 * p.change, 0.3 * p.change);
    // Values far from the case's are not tried: such mills may run forever.
    value = std::clamp(value + move, p.value - p.change / 2, p.value + p.change / 2);
    std::vector<std::pair<double, double>> scatter;
    for (const auto& [by, weight] : steps) scatter.emplace_back(std::abs(by - move), weight);
    // The last term accounts for the rounding of times in two runs of the case.
    open = 10 * weighted_median(scatter) + std::abs(move) * 1e-3 +
        1e-12 * std::max(std::abs(value), p.change);
  }
  return {value, open};
}

}  // namespace

Identification replay(const Assumed& nominal, const Assumptions& assumptions,
    const EventsAtHand& log, const std::function<bool()>& is_interrupted) {
  Replay runs(nominal, log);
  Identification result;
  if (runs.count() < 20) {
    result.too_few = true;
    return result;
  }
  const auto case_itself = runs.impacts(nominal, runs.count());
  const std::size_t without = runs.follows(case_itself);
  result.follows = without;
  // Number of impacts over which two runs agree that differ only by rounding.
  const auto horizon = [&](const Assumed& assumed, const std::vector<Impact>& list) {
    Assumed other = assumed;
    for (auto& ball : other.balls) ball.radius *= 1 + 1e-15;
    return std::max<std::size_t>(1, runs.common(list, runs.impacts(other, runs.count())));
  };
  const auto enough = [&](std::size_t follows, std::size_t could) {
    return 10 * follows >= 9 * could;
  };
  result.follows_all = enough(without, horizon(nominal, case_itself));
  if (result.follows_all) return result;

  auto& best = result.causes;  // one at most
  const auto consider = [&](Cause found, const Assumed& assumed) {
    const auto list = runs.impacts(assumed, runs.count());
    found.follows = runs.follows(list);
    if (found.follows < without + 10 || (!best.empty() && found.follows <= best[0].follows)) return;
    found.could_follow = horizon(assumed, list);
    if (enough(found.follows, found.could_follow)) best = {std::move(found)};
  };
  for (const bool in_vessel : {false, true}) {
    runs.in_vessel = in_vessel;
    for (const auto& a : assumptions) {
      if (is_interrupted()) return result;
      if (a.by_factor) continue;  // running a mill a thousand times as fast takes too long
      if (a.is_fitted()) {
        const auto [value, open] = fit_value(runs, nominal, a);
        if (std::abs(value - a.value) > open)
          consider({.found = {{a, value, open}}}, a.on(nominal, value));
      } else if (const Assumed assumed = a.on(nominal, 1);
                 runs.follows(runs.impacts(assumed, 30)) >=
                 std::min<std::size_t>(20, runs.count())) {
        consider({.found = {{a}}}, assumed);
      }
    }
  }
  return result;
}

}  // namespace edmill::identify
