// Finds the number of the mill or vessel with which the walls are where balls left their flights.
#include <fmt/format.h>

#include "dem/contact_rates.hpp"
#include "identify/assumed.hpp"

namespace edmill::dem {

namespace {

using identify::Assumed;
using identify::Assumption;

/// A ball that leaves its flight at a wall.
struct Meeting {
  int ball, wall;
  double time;  ///< in the middle between the frames [s]
  Vector position;
};

struct Candidate : Assumption {
  int wall = -1;  ///< wall that the value moves outward [m], if `set` is empty
};

class Geometry {
 public:
  Geometry(const CaseSpec& spec, const std::vector<Contact>& contacts, const ContactLogFacts& log)
      : nominal_(identify::assumed_of(spec)), facets_(log.facets) {
    const auto& frames = log.statistics;
    const auto built = nominal_.built();
    if (!built) return;
    const MovingVessel vessel(built->mill, built->balls, facets_);
    reaches_of_walls_.resize(nominal_.walls);
    std::vector<double> reaches;
    for (const auto& c : contacts) {
      const double t = c.free_until + frames.interval / 2;
      const bool single = c.kind == ContactClass::wall;
      const auto state = flown(c.before, frames.gravity, t - (single ? c.begin : c.free_until));
      const double lasted = single ? c.end - c.begin : c.free_from - c.free_until;
      const Vector impulse = c.after.velocity - c.before.velocity - frames.gravity * lasted;
      const auto pose = vessel.at(t);
      double best = 0.5 * norm(impulse);
      int wall = -1;
      for (int w = 0; w < vessel.walls(); ++w) {
        // A body has faces along the walls, too: those that are far away are not meant.
        const auto& at = state.position;
        if (vessel.has_bodies() && vessel.gap(pose, c.ball, w, at) > vessel.ball(c.ball).radius)
          continue;
        if (const double along = dot(vessel.normal(pose, c.ball, w, at), impulse); along > best) {
          best = along;
          wall = w;
        }
      }
      if (wall < 0) continue;
      meetings_.push_back({c.ball, wall, t, state.position});
      reaches.push_back(norm(impulse) / 1.5 * frames.interval / 2);
      reaches_of_walls_[wall].push_back(reaches.back());
    }
    resolution = median_of(reaches).value;
    distance = of(gaps(nominal_));
  }

  bool known() const { return meetings_.size() >= 20; }
  const Assumed& nominal() const { return nominal_; }
  double distance = 0, resolution = 0;

  /// Gaps from the walls where balls left their flights [m]; empty if such a mill cannot be built.
  std::vector<double> gaps(const Assumed& assumed, int moved = -1, double outward = 0) const {
    std::vector<double> gaps;
    const auto built = assumed.built();
    if (!built) return gaps;
    const MovingVessel vessel(built->mill, built->balls, facets_);
    for (const auto& m : meetings_)
      gaps.push_back(vessel.gap(vessel.at(m.time + assumed.log.delay), m.ball, m.wall, m.position) +
          (m.wall == moved ? outward : 0));
    return gaps;
  }
  /// Deviation of the walls [m]: the largest of the medians of single walls, of which a mistake may
  /// move one. Frames blur positions symmetrically: the median of signed gaps is known better.
  double of(const std::vector<double>& gaps) const {
    if (gaps.empty()) return INFINITY;
    std::vector<std::vector<double>> by_wall(nominal_.walls);
    for (std::size_t k = 0; k < gaps.size(); ++k) by_wall[meetings_[k].wall].push_back(gaps[k]);
    double largest = 0;
    for (std::size_t wall = 0; wall < by_wall.size(); ++wall) {
      auto& own = by_wall[wall];
      if (own.size() < 10) continue;
      const auto signed_gap = median_of(own);
      for (double& gap : own) gap = std::abs(gap);
      const double known = std::abs(signed_gap.value) - signed_gap.half_width();
      // The faster the balls, the less sharply frames show their positions.
      const double off = std::max(3 * known, median_of(std::move(own)).value);
      largest = std::max(largest, off * resolution / median_of(reaches_of_walls_[wall]).value);
    }
    return largest;
  }
  std::vector<double> gaps_with(const Candidate& c, double value) const {
    Assumed assumed = nominal_;
    if (c.set) c.set(assumed, value);
    return gaps(assumed, c.wall, value);
  }

  std::optional<GeometryCause> fit(const Candidate& c) const {
    double best = c.value, left = distance;
    for (const double start : c.first_values)
      if (const double found = of(gaps_with(c, start)); found < left) {
        left = found;
        best = start;
      }
    double curvature = 0;
    for (int round = 0; round < 12; ++round) {
      const auto here = gaps_with(c, best), there = gaps_with(c, best + 1e-4 * c.change);
      if (here.empty() || there.empty()) return std::nullopt;
      double slope = 0;
      curvature = 0;
      const double limit = 3 * of(here) + 1e-12;
      for (std::size_t k = 0; k < here.size(); ++k) {
        const double rate = (there[k] - here[k]) / (1e-4 * c.change),
                     weight = std::abs(here[k]) > limit ? 0 : 1;
        slope += weight * rate * here[k];
        curvature += weight * rate * rate;
      }
      if (!(curvature > 0)) return std::nullopt;
      double step = -slope / curvature;
      for (int half = 0; half < 6; ++half, step /= 2)
        if (const double found = of(gaps_with(c, best + step)); found < left) {
          best += step;
          left = found;
          break;
        }
      if (std::abs(step) < 1e-7 * c.change) break;
    }
    const double half_width = 1.96 * 1.4826 * left / std::sqrt(curvature);
    return GeometryCause{.key = c.key,
        .text =
            fmt::format("{}, the case has {}", identify::value_text(c.dimension, best, half_width),
                identify::value_text(c.dimension, c.value)),
        .value = best,
        .half_width = half_width,
        .expected = c.value,
        .left = left};
  }
 private:
  Assumed nominal_;
  int facets_;
  std::vector<Meeting> meetings_;
  std::vector<std::vector<double>> reaches_of_walls_;  ///< ways of balls in half an interval [m]
};

void add_numbers(const Assumed& nominal, std::vector<Candidate>& list) {
  for (const auto& p : identify::numbers_of(nominal)) {
    if (!(p.key.starts_with("mill.") || p.key.starts_with("vessel.") ||
            p.key.starts_with("body.") || p.is_diameter))
      continue;
    auto& starts = list.emplace_back(Candidate{p}).first_values;
    for (const double share : {0.001, 0.003, 0.01, 0.03, 0.05, 0.1, 0.2, 0.5})
      for (const double sign : {-1.0, 1.0}) starts.push_back(p.value * (1 + sign * share));
    starts.push_back(2 * p.value);
  }
}

void add_phases(const Assumed& nominal, std::vector<Candidate>& list) {
  const double turn = 2 * numerics::pi<double>();
  std::vector<double> starts;
  for (int k = 1; k < 16; ++k) starts.push_back(turn * (k <= 8 ? k : k - 16) / 16);
  const double period = casefile::period_of(nominal.spec.mill).to<double>();
  const auto add = [&](const std::string& key, const std::function<void(Assumed&, double)>& set) {
    list.push_back(
        {{.key = key, .dimension = Dimension::angle, .set = set, .first_values = starts}});
  };
  add("phase of the drive", [=](Assumed& a, double x) { a.log.delay = x / turn * period; });
  const auto* vibratory = std::get_if<model::Vibratory<casefile::Quantity>>(&nominal.spec.mill);
  if (vibratory)
    list.push_back({{.key = "factor of mill.amplitude",
        .value = 1,
        .change = 1e-3,
        .set =
            [](Assumed& a, double x) {
              auto& mill = std::get<model::Vibratory<casefile::Quantity>>(a.spec.mill);
              for (auto* vector : {&mill.amplitude, &mill.quarter})
                for (auto& q : *vector) q = identify::exactly(x * q.template to<double>());
            },
        .first_values = {0.5, 0.9, 0.95, 1.05, 1.1, 1.5, 2}}});
  for (std::size_t axis = 0; vibratory && axis < 3; ++axis) {
    if (vibratory->amplitude[axis].zero() && vibratory->quarter[axis].zero()) continue;
    add(fmt::format("phase of mill.amplitude along {}", "xyz"[axis]), [axis](Assumed& a, double x) {
      auto& mill = std::get<model::Vibratory<casefile::Quantity>>(a.spec.mill);
      const double s = mill.amplitude[axis].to<double>(), q = mill.quarter[axis].to<double>();
      mill.amplitude[axis] = identify::exactly(s * std::cos(x) - q * std::sin(x));
      mill.quarter[axis] = identify::exactly(s * std::sin(x) + q * std::cos(x));
    });
  }
}

void add_walls(const CaseSpec& spec, std::vector<Candidate>& list) {
  const auto partners = casefile::partners_of(spec);
  const std::vector<double> starts{-1e-3, -3e-4, -1e-4, 1e-4, 3e-4, 1e-3};
  for (int wall = 0; wall < partners.walls(); ++wall)
    list.push_back({{.key = "place of " + partners[wall].label,
                        .dimension = Dimension::length,
                        .change = 1e-3,
                        .set = {},
                        .first_values = starts},
        wall});
}

}  // namespace

void judge_places(const CaseSpec& spec, const std::vector<Contact>& contacts,
    const std::atomic<bool>* interrupt, ContactAudit& audit) {
  const Geometry geometry(spec, contacts, audit.facts);
  if (!geometry.known()) return;
  audit.wall_distance = geometry.distance;
  audit.wall_resolution = geometry.resolution;
  const bool met = audit.walls_met();
  const auto agrees = [](const Judged& j) { return j.of != Judged::Of::walls || j.agrees(); };
  if (met && std::all_of(audit.judged.begin(), audit.judged.end(), agrees)) return;
  std::vector<Candidate> candidates;
  add_numbers(geometry.nominal(), candidates);
  add_phases(geometry.nominal(), candidates);
  add_walls(spec, candidates);
  for (const auto& candidate : candidates) {
    if (interrupt && *interrupt) break;
    const auto cause = geometry.fit(candidate);
    if (!cause || cause->left > 2 * geometry.resolution) continue;
    // A deviation that frames barely resolve counts only if a number clearly differs from the
    // case's. A wrong velocity of the walls moves the places where balls leave their flights, too.
    const double half_widths = audit.wall_velocity_differs() ? 8 : 3;
    const bool is_clear = 2 * cause->left <= geometry.distance &&
        std::abs(cause->value - cause->expected) > half_widths * cause->half_width;
    if (!met || is_clear) audit.causes.push_back(*cause);
  }
  std::sort(
      audit.causes.begin(), audit.causes.end(), [](auto& a, auto& b) { return a.left < b.left; });
}

}  // namespace edmill::dem
