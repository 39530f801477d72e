// The equations that a log must obey, the residual of each and its tolerance, and the findings of
// an audit. docs/theory.md, sections 1, 2 and 5; docs/audit.md, "Tolerances"
#pragma once

#include <cstdint>
#include <map>
#include <numeric>
#include <string_view>

#include "audit/mechanics.hpp"
#include "base/sums.hpp"
#include "model/mill.hpp"

namespace edmill::audit {

using logs::rounding_of;

#define EDMILL_KIND(name, unit, meaning, check) name,
enum class Kind : std::size_t {
#include "audit/findings.def"
};
#undef EDMILL_KIND
/// Checks, each of which finds one or several kinds. A kind's share is relative to those made.
#define EDMILL_CHECK(id, name, rows, columns) id,
enum class Check : std::size_t {
#include "audit/findings.def"
};
#undef EDMILL_CHECK

struct KindInfo {
  std::string_view name, unit;  ///< unit of its size
  std::string_view meaning;     ///< in a few words
  Check check;                  ///< that finds it
};
#define EDMILL_KIND(name, unit, meaning, check) KindInfo{#name, unit, meaning, Check::check},
inline constexpr std::array kinds{
#include "audit/findings.def"
};
#undef EDMILL_KIND
/// The quantity of a row; rows of one kind share a scale of noise.
enum class RowKind : unsigned char { touch, law, energy, speed, place, velocity };
inline constexpr std::size_t row_kinds = 6;
struct CheckInfo {
  std::string_view name;
  RowKind rows;
  std::string_view columns;  ///< that it needs
};
#define EDMILL_CHECK(id, name, rows, columns) CheckInfo{name, RowKind::rows, columns},
inline constexpr std::array checks{
#include "audit/findings.def"
};
#undef EDMILL_CHECK
inline constexpr std::size_t kind_count = kinds.size(), check_count = checks.size();
constexpr std::size_t at(auto number) { return static_cast<std::size_t>(number); }
inline const KindInfo& info(Kind kind) { return kinds[at(kind)]; }
/// The kind of violation that a check finds. @pre it finds only one kind
constexpr Kind kind_of(Check check) {
  const auto first =
      std::find_if(kinds.begin(), kinds.end(), [=](auto& k) { return k.check == check; });
  return static_cast<Kind>(first - kinds.begin());
}
inline const CheckInfo& info(Check check) { return checks[at(check)]; }
/// The checks for which `wanted` is true or not 0.
std::vector<Check> checks_with(const auto& wanted) {
  std::vector<Check> list;
  for (std::size_t k = 0; k < check_count; ++k)
    if (const auto check = static_cast<Check>(k); wanted(check)) list.push_back(check);
  return list;
}

struct Finding : model::ImpactRecord<double> {
  Kind kind;
  double size;             ///< of the violation, in the unit of the kind
  double found, expected;  ///< nan where they do not apply
  const char* note = "";   ///< a literal: a probable reason
};

struct Tally {
  std::uint64_t count = 0;
  double worst = 0;
  std::vector<Finding> examples;  ///< the worst, largest first
  std::map<std::string_view, std::uint64_t> notes;
};

class Findings {
 public:
  /// @param examples  number of examples kept of each kind
  explicit Findings(std::size_t examples) : examples_(examples) {}

  void add(const Finding& finding) {
    Tally& tally = tallies_[at(finding.kind)];
    ++tally.count;
    if (*finding.note != '\0') ++tally.notes[finding.note];
    keep(tally, finding);
  }
  void judged(Check check) { ++judged_[at(check)]; }
  /// Counts a check that was not made because the tolerance is as large as the checked quantity.
  void unresolved(Check check) { ++unresolved_[at(check)]; }
  const Tally& of(Kind kind) const { return tallies_[at(kind)]; }
  std::uint64_t judged_number(Check check) const { return judged_[at(check)]; }
  std::uint64_t unresolved_number(Check check) const { return unresolved_[at(check)]; }
  std::uint64_t total() const {
    return std::accumulate(tallies_.begin(), tallies_.end(), std::uint64_t{0},
        [](std::uint64_t sum, const Tally& tally) { return sum + tally.count; });
  }
  /// Kinds that were found, the most frequent first.
  std::vector<Kind> ranked() const {
    std::vector<Kind> found;
    for (std::size_t k = 0; k < kind_count; ++k)
      if (tallies_[k].count > 0) found.push_back(static_cast<Kind>(k));
    std::stable_sort(
        found.begin(), found.end(), [&](auto a, auto b) { return of(a).count > of(b).count; });
    return found;
  }
 private:
  void keep(Tally& tally, const Finding& finding) const {
    tally.worst = std::max(tally.worst, finding.size);
    auto& worst = tally.examples;
    if (worst.size() == examples_ && !(examples_ > 0 && finding.size > worst.back().size)) return;
    const auto place = std::upper_bound(worst.begin(), worst.end(), finding,
        [](const Finding& a, const Finding& b) { return a.size > b.size; });
    worst.insert(place, finding);
    if (worst.size() > examples_) worst.pop_back();
  }

  std::size_t examples_;
  std::array<Tally, kind_count> tallies_;
  std::array<std::uint64_t, check_count> judged_{}, unresolved_{};
};

/// Totals over the impacts of a log that have velocities and spins before and after.
struct Energies {
  using Sum = numerics::CompensatedSum<double>;
  std::uint64_t impacts = 0;
  Sum wall_work;                ///< of the logged states [J]
  Sum milling_dose;             ///< as logged, otherwise from the law [J]
  Sum supplied;                 ///< that the case's least separation speed adds [J]
  Sum kinetic_change;           ///< of the logged states [J]
  std::uint64_t supplying = 0;  ///< number of impacts in which it adds energy
  std::uint64_t creating = 0;   ///< number of impacts that create more energy than that
  double created = 0;           ///< energy that those create [J]

  /// 0 up to rounding in a log that obeys the law [J].
  double closure() const {
    return (wall_work.value() - milling_dose.value()) + (supplied.value() - kinetic_change.value());
  }
};

/// True if an assumption explains a violation: what it leaves is allowed, and a tenth at most.
inline bool vanishes(double without, double with, double allowed) {
  return with <= allowed && 10 * with <= without;
}

/// True if a cause explains at least nine tenths of the violations; others may have another.
inline bool accounts_for(std::uint64_t explained, std::uint64_t of) {
  return explained > 0 && 10 * explained >= 9 * of;
}

/// Upper bounds of the speed, acceleration and angular velocity of a mill's walls.
struct WallRates {
  double speed = 0;         ///< of any point of the walls [m/s]
  double acceleration = 0;  ///< of any [m/s^2]
  double turning = 0;       ///< of the vessel [rad/s]

  static WallRates of(const Mill& mill) {
    const auto& motion = mill.motion;
    const double vessel = mill.vessel.reach();
    // Among the points within r of the centre, some move at r times the angular speed or faster.
    constexpr double far = 1e6;
    WallRates rates{motion.wall_speed(vessel), motion.acceleration_within(motion.reach(vessel)),
        motion.wall_speed(far) / far};
    for (const auto& body : mill.bodies) {
      const double size = body.shape.size();
      rates.speed = std::max(rates.speed, body.motion.wall_speed(size));
      rates.acceleration =
          std::max(rates.acceleration, body.motion.acceleration_within(body.motion.reach(size)));
      rates.turning = std::max(rates.turning, body.motion.wall_speed(far) / far);
    }
    if (const auto* pistons = mill.vessel.pistons()) {
      rates.speed += pistons->bound(1);
      rates.acceleration += pistons->bound(2) + 2 * rates.turning * pistons->bound(1);
    }
    return rates;
  }
};

struct Tolerances {
  double relative = 1e-9;
  double gap = 0;      ///< between bodies in contact [m]
  double reach = 0;    ///< largest distance of a ball from the fulcrum [m]
  double gravity = 0;  ///< [m/s^2]
  WallRates walls;

  /// Uncertainty of wall positions due to the rounding of the logged time [m].
  double wall_places(double t) const { return std::min(rounding_of(t) * walls.speed, 2 * reach); }
  double touch(double t, bool with_wall) const { return gap + (with_wall ? wall_places(t) : 0); }
  /// Tolerance of the end of a flight from an impact at an earlier time.
  double position(double t, double path, double speed) const {
    return relative * (reach + path) + 2 * rounding_of(t) * (speed + 2 * rounding_of(t) * gravity);
  }
  double velocity(double t, double speed) const {
    return relative * speed + 2 * rounding_of(t) * gravity;
  }

  /// Contribution of the wall's uncertainty to a difference of relative velocities [m/s].
  /// @param scale  bound of the velocities; relative ones are at most three times as large
  /// @param bend   rotation of the normal per displacement of the ball in the vessel [1/m]
  double of_wall(double t, double scale, double bend, double radius) const {
    const double turned = walls.turning + walls.speed * bend;  // of the normal [rad/s]
    const double moved = walls.acceleration + walls.turning * (walls.speed + radius * turned);
    return 2 *
        (3 * scale * std::min(rounding_of(t) * turned, 2.0) +
            std::min(rounding_of(t) * moved, 2 * walls.speed));
  }
};

/// Whether an impact has friction, or none in a stall (docs/theory.md, 6); `either` if unknown.
enum class Friction { acts, rests, either };

/// Bounds the number of consecutive impacts of each ball without time to move in between.
class StallHistory {
 public:
  StallHistory(const Mill& mill, std::size_t balls)
      : stall_(mill.stall), balls_(balls, Ball{unknown, 0, stall_.impacts}) {}

  void begin(double time) { std::fill(balls_.begin(), balls_.end(), Ball{time, 0, 0}); }
  /// Discards the history of a ball of which events are missing.
  void forget(int ball) { balls_[ball] = {unknown, 0, stall_.impacts}; }

  /// Counts an event and returns its state of friction. @param relative  tolerance of logged times
  Friction take(const LoggedEvent& event, const model::ContactLaw<double>& law, double relative) {
    const Friction one = count(event.ball, event.time, law, relative);
    if (event.with_wall) return one;
    const Friction other = count(event.partner, event.time, law, relative);
    if (one == Friction::rests || other == Friction::rests) return Friction::rests;
    return one == other ? one : Friction::either;
  }
 private:
  struct Ball {
    double time;      ///< of its last impact; unknown at first [s]
    int least, most;  ///< impacts in a row without time to move
  };

  Friction count(int k, double time, const model::ContactLaw<double>& law, double relative) {
    Ball& ball = balls_[k];
    const int enough = stall_.impacts;
    const double flight = time - ball.time, speed = law.least_separation;
    const double off = 2 * rounding_of(time) + relative * std::abs(flight);
    const bool may_have_moved = std::isnan(flight) || stall_.has_moved(flight + off, speed);
    const bool has_moved = !std::isnan(flight) && stall_.has_moved(flight - off, speed);
    const Friction friction = has_moved || ball.most < enough ? Friction::acts
        : !may_have_moved && ball.least >= enough             ? Friction::rests
                                                              : Friction::either;
    ball.time = time;
    ball.most = has_moved ? 0 : std::min(ball.most + 1, enough);
    ball.least = may_have_moved ? 0 : std::min(ball.least + 1, enough);
    return friction;
  }

  const model::StallRule& stall_;
  std::vector<Ball> balls_;
};

/// The residual of an equation at an event of the log.
struct Row {
  Check equation;
  RowKind kind;
  int body;                                    ///< 0 the event's ball, 1 its partner, -1 both
  int count;                                   ///< of components, 1 or 3
  Vec difference;                              ///< a scalar is the first component
  double size;                                 ///< norm of the difference
  double allowed;                              ///< tolerance of the size
  double found = unknown, expected = unknown;  ///< for reports, if more informative

  bool is_violated() const { return size > allowed; }
};

struct Rows : std::vector<Row> {
  void scalar(Check check, double off, double allowed, double found, double due) {
    push_back({check, info(check).rows, -1, 1, {off, 0, 0}, std::abs(off), allowed, found, due});
  }
  Row& vector(Check check, auto body, const Vec& difference, double allowed) {
    const double off = audit::size(difference);
    const int of = static_cast<int>(body);
    return *insert(end(), {check, info(check).rows, of, 3, difference, off, allowed, off, 0});
  }
};

/// A flight between two logged impacts of a ball.
struct LoggedFlight {
  BodyState from, to;
  Available::Body had, has;  ///< columns available at begin and end
  double begin, end;         ///< [s]
  double radius;             ///< of the ball [m]
  int body;                  ///< role in the event at the end: 0 ball, 1 partner
};

struct ImpactTolerance {
  double energy = 0;           ///< [J]
  bool can_be_checked = true;  ///< false if rounded times leave the wall velocity unknown
};

/// Evaluates the equations at events. The set of rows depends only on the columns of the log.
class Equations {
 public:
  /// @param by_body  residuals of each body's velocity and spin, for fits, in which a term may
  /// differ for one; otherwise of the law along and across the normal, momentum and torque
  Equations(const Available& available, const Tolerances& tolerances, const Terms& terms = {},
      bool by_body = false)
      : has_(available), tolerances_(tolerances), terms_(terms), by_body_(by_body) {}

  /// The bodies of an event touch. @param gap  between them [m]
  void of_touch(const LoggedEvent& event, double gap, Rows& rows) const;
  /// The law, conservation, and logged values: by the states, or without them by the logged speeds.
  ImpactTolerance of_impact(const LoggedImpact& impact, Rows& rows) const;
  /// Position, velocity and spin at the end of a flight. @param gravity  of the case [m/s^2]
  void of_flight(const LoggedFlight& flight, const Vec& gravity, Rows& rows) const;
 private:
  void of_states(const LoggedImpact& impact, Speeds speeds, double allowed, Rows& rows) const;
  void of_energies(const LoggedImpact& impact, Speeds speeds, double allowed, Rows& rows) const;
  void of_logged_speeds(const LoggedImpact& impact, Rows& rows) const;

  const Available& has_;
  const Tolerances& tolerances_;
  Terms terms_;
  bool by_body_;
};

}  // namespace edmill::audit
