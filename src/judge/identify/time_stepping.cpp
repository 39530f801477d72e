#include <numbers>

#include "base/statistics.hpp"
#include "identify/identify.hpp"

namespace edmill::identify {

namespace {

using numerics::quantile;

constexpr std::size_t least_number = 20;

/// The finite values, if they are nine tenths of all and at least `least_number`; else none.
std::vector<double> mostly_known(std::vector<double> values) {
  const auto all = values.size();
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  const bool enough = values.size() >= least_number && audit::accounts_for(values.size(), all);
  return enough ? values : std::vector<double>{};
}

/// Whether the values agree within a factor: their quartiles are within half of the median.
bool agree(const std::vector<double>& values) {
  const double middle = quantile(values, 0.5);
  return std::abs(quantile(values, 0.75) - quantile(values, 0.25)) < std::abs(middle);
}

/// The common step of two durations, by the continued fraction of their ratio. @param rounding  of
/// a time [s]
std::optional<double> step_of(double one, double two, double rounding) {
  double p = 1, q = 0, p_before = 0, q_before = 1, rest = one / two;
  const double most = 0.1 *
      std::sqrt(std::min(one, two) / rounding);  // beyond this, every ratio has such a fraction
  for (int term = 0; term < 40; ++term) {
    const double whole = std::floor(rest);
    std::swap(p, p_before);
    std::swap(q, q_before);
    p += whole * p_before;
    q += whole * q_before;
    if (p + q > most) return std::nullopt;
    if (std::abs(one * q - two * p) <= rounding * (p + q)) return (one + two) / (p + q);
    rest = 1 / (rest - whole);
  }
  return std::nullopt;
}

/// The largest step of which all times are multiples.
std::optional<double> common_step(const std::vector<LoggedEvent>& events) {
  if (events.size() < least_number) return std::nullopt;
  const double begin = events.front().time, span = events.back().time - begin;
  const double rounding = 2 * std::numeric_limits<double>::epsilon() *
      std::max(std::abs(begin), std::abs(begin + span));
  const auto holds = [&](double step) {
    if (span / step < static_cast<double>(events.size())) return false;
    return std::all_of(events.begin(), events.end(), [&](const LoggedEvent& event) {
      const double steps = (event.time - begin) / step;
      return std::abs(steps - std::round(steps)) < 0.02;
    });
  };
  std::optional<double> best;
  for (std::size_t k = 2; k < std::min<std::size_t>(events.size(), 100); ++k) {
    const double one = events[k - 1].time - events[k - 2].time,
                 two = events[k].time - events[k - 1].time;
    if (!(one > 100 * rounding) || !(two > 100 * rounding)) continue;
    const auto step = step_of(one, two, rounding);
    if (step && *step > 100 * rounding && (!best || *step > *best) && holds(*step)) best = step;
  }
  if (best) best = span / std::round(span / *best);  // more precise than any single difference
  return best;
}

/// True if delays are even up to a step, by a Kolmogorov-Smirnov test at 1 %, with a limit 0.1
/// larger for impacts within a step.
bool are_even(std::vector<double> delays, double step) {
  std::sort(delays.begin(), delays.end());
  const auto all = static_cast<double>(delays.size());
  double worst = 0;
  for (std::size_t k = 0; k < delays.size(); ++k) {
    const double due = std::min(1.0, delays[k] / step), below = static_cast<double>(k) / all;
    worst = std::max({worst, std::abs(below - due), std::abs(below + 1 / all - due)});
  }
  return worst <= 1.63 / std::sqrt(all) + 0.1;
}

/// Delays of events [s], by the number of the wall, -1 for balls.
using Delays = std::map<int, std::vector<double>>;

/// The time step of a code that detects contacts at the first step after them; 0 without a sign of
/// one. It delays all contacts alike; a misplaced wall or a wrong ball delays its own only.
double late_step(const Delays& delays) {
  std::vector<double> all;
  for (const auto& [partner, own] : delays) all.insert(all.end(), own.begin(), own.end());
  if (all.size() < least_number) return 0;
  const double step = quantile(all, 0.98) / 0.98;
  if (!(step > 0) || !are_even(all, step)) return 0;
  const bool alike = std::all_of(delays.begin(), delays.end(),
      [&](const auto& of) { return of.second.size() < least_number || are_even(of.second, step); });
  return alike ? step : 0;
}

/// Sentinel: the flight deviates, but not as a contact that lasts would make it.
constexpr double no_duration = -1;

/// An impact with its geometry, and the durations that the flights before and after it indicate.
struct LoggedContact {
  Vec normal{0, 0, 0}, carrier{0, 0, 0};  ///< velocity of the wall or centre of mass [m/s]
  double duration_from_begin = unknown, duration_from_end = unknown;
  double approach = unknown, effective_mass = 0, effective_radius = 0;
};

class Measurements {
 public:
  Measurements(const EventsAtHand& log, const Case& the_case, const audit::Tolerances& tolerances)
      : contacts(log.events.size()), log_(log), case_(the_case), tolerances_(tolerances) {
    std::vector<long> last(the_case.balls.size(), -1);
    for (std::size_t k = 0; k < log.events.size(); ++k) {
      const auto& event = log.events[k];
      if (!event.problem.empty()) continue;
      add(k);
      for (std::size_t body = 0; body < event.count(); ++body) {
        const int ball = event.ball_at(body);
        if (last[ball] >= 0) flight(last[ball], k, ball);
        last[ball] = static_cast<long>(k);
      }
    }
  }

  std::vector<LoggedContact> contacts;
  Delays delays;
  std::vector<double> first_order;  ///< the step that each flight implies [s]
  /// For each flight that deviates only along its path, the logged duration minus its own [s].
  std::vector<double> surplus;
 private:
  /// Geometry of an impact and its depth.
  void add(std::size_t k) {
    const auto& event = log_.events[k];
    const auto& one = event.body[0];
    LoggedContact& contact = contacts[k];
    if (!event.with_wall && one.position == event.body[1].position) return;  // it has no normal
    const auto frame =
        event.with_wall ? audit::vessel_at(case_.mill, event.time, false) : audit::VesselFrame{};
    const double gap = audit::gap_of(event, case_, frame);
    const auto impact = audit::impact_of(event, case_, frame, true);
    const auto& [ball, other] = impact.ball;
    contact.normal = impact.normal;
    const Vec& met = event.with_wall ? impact.wall_velocity : event.body[1].velocity_before;
    contact.effective_mass = impact.effective_mass;
    contact.effective_radius =
        event.with_wall ? ball.radius : ball.radius * other.radius / (ball.radius + other.radius);
    contact.approach = -impact.along(one.velocity_before - met);
    contact.carrier = event.with_wall ? met
                                      : Vec((one.velocity_before * ball.mass + met * other.mass) *
                                            (1 / (ball.mass + other.mass)));
    const bool late = gap < -tolerances_.touch(event.time, event.with_wall);
    // The delay of a grazing contact cannot be determined.
    if (contact.approach > size(one.velocity_before) / 10)
      delays[event.with_wall ? event.partner : -1].push_back(late ? -gap / contact.approach : 0);
  }

  void flight(std::size_t from, std::size_t to, int ball) {
    const auto &begin = log_.events[from], &end = log_.events[to];
    const std::size_t side = begin.ball == ball ? 0 : 1, arriving = end.ball == ball ? 0 : 1;
    const auto &left = begin.body[side], &came = end.body[arriving];
    const double dt = end.time - begin.time;
    if (!(dt > 0)) return;
    const Vec& g = case_.mill.gravity;
    const Vec off = came.position - (left.position + (left.velocity_after + g * (dt / 2)) * dt);
    const double speed = size(left.velocity_after),
                 noise = tolerances_.position(end.time, speed * dt, speed);
    auto &first = contacts[from], &second = contacts[to];
    // A late departure displaces the ball by the delay times its velocity at the end of the flight.
    const double leaving = dot(Vec(left.velocity_after + g * dt - first.carrier), first.normal);
    const double coming = dot(Vec(came.velocity_before - second.carrier), second.normal);
    const bool large = size(off) > 3 * noise;
    // The ball leaves later than logged, or arrives earlier than logged. While bodies are in
    // contact the force between them moves the ball off its parabola, along the impulse.
    const auto duration = [&](const audit::BodyState& body, const Vec& normal, double speed) {
      const Vec impulse = body.velocity_after - body.velocity_before;
      const Vec across = off - impulse * (dot(off, impulse) / dot(impulse, impulse));
      return 3 * size(across) < size(off) ? -dot(off, normal) / speed : no_duration;
    };
    if (large && std::abs(leaving) > 0.05)
      first.duration_from_begin = duration(left, first.normal, leaving);
    if (large && std::abs(coming) > 0.05)
      second.duration_from_end = duration(came, second.normal, coming);
    if (large && !is_along(came.velocity_before, Vec(came.velocity_after - came.velocity_before)) &&
        !is_along(came.velocity_before, Vec(left.velocity_after - left.velocity_before)))
      surplus.push_back(surplus_of(off, came.velocity_before, g, noise));
    // A first-order integrator has the right velocity, and leaves the parabola along gravity only.
    const double g_size = size(g);
    if (!(g_size > 0)) return;
    const Vec gained = came.velocity_before - (left.velocity_after + g * dt);
    const double fall = dot(off, g) / g_size;
    const double rest = std::max(size(Vec(off - g * (fall / g_size))), size(gained) * dt);
    first_order.push_back(
        !large || 10 * rest <= std::abs(fall) ? 2 * fall / (g_size * dt) : unknown);
  }

  /// True for parallel vectors: finite contacts and time steps displace balls along the impulse.
  static bool is_along(const Vec& one, const Vec& two) {
    return std::abs(dot(one, two)) > 0.99 * size(one) * size(two);
  }
  /// Time by which a ball is late on its path [s]; unknown if it deviates from the path as well.
  static double surplus_of(const Vec& off, const Vec& velocity, const Vec& g, double noise) {
    const auto along = [&](const Vec& way) {
      return -dot(way, velocity) / dot(velocity, velocity);
    };
    double time = along(off);
    time = along(Vec(off + g * (time * time / 2)));
    const double rest = size(Vec(off + (velocity + g * (time / 2)) * time));
    return audit::vanishes(size(off), rest, noise) ? time : unknown;
  }

  const EventsAtHand& log_;
  const Case& case_;
  audit::Tolerances tolerances_;
};

/// Slope of ln(duration) over ln(speed): the median of pairs (Theil-Sen) half of the list apart.
double exponent_of(std::vector<std::pair<double, double>> points) {
  std::sort(points.begin(), points.end());
  std::vector<double> slopes;
  const std::size_t apart = points.size() / 2;
  for (std::size_t k = 0; k + apart < points.size(); ++k) {
    const double dx = points[k + apart].first - points[k].first;
    if (dx > 0.1) slopes.push_back((points[k + apart].second - points[k].second) / dx);
  }
  return slopes.size() < least_number / 2 ? unknown : quantile(slopes, 0.5);
}

std::optional<SoftContacts> soft_contacts(const std::vector<LoggedContact>& contacts, LoggedAt at) {
  std::vector<double> durations, springs, moduli;
  std::vector<std::pair<double, double>> points;
  std::size_t known = 0;
  for (const auto& c : contacts) {
    const double t = at == LoggedAt::begin ? c.duration_from_begin : c.duration_from_end;
    if (!std::isfinite(t)) continue;
    ++known;
    if (!(t > 0)) continue;
    durations.push_back(t);
    constexpr double pi = std::numbers::pi;
    springs.push_back(c.effective_mass * pi * pi / (t * t));
    if (!(c.approach > 0)) continue;
    // t = 2.868 (M^2 / (R E*^2 v))^(1/5)
    moduli.push_back(std::sqrt(std::pow(2.868 / t, 5) * c.effective_mass * c.effective_mass /
        (c.effective_radius * c.approach)));
    points.emplace_back(std::log(c.approach), std::log(t));
  }
  // Finite contacts require that nearly all durations are positive, and that they agree.
  if (durations.size() < least_number || 10 * durations.size() < 8 * known || !agree(durations))
    return std::nullopt;
  return SoftContacts{.duration = quantile(durations, 0.5),
      .low = quantile(durations, 0.25),
      .high = quantile(durations, 0.75),
      .at = at,
      .contacts = durations.size(),
      .exponent = exponent_of(std::move(points)),
      .spring = quantile(springs, 0.5),
      .modulus = moduli.empty() ? unknown : quantile(moduli, 0.5)};
}

/// The error of single times, if that alone explains the deviations of flights: as many are too
/// short as too long. With errors e of its two times that of a flight is sqrt(2) e.
std::optional<double> jitter_of(std::vector<double> surplus) {
  surplus = mostly_known(std::move(surplus));
  if (surplus.empty() || !(quantile(surplus, 0.25) < 0 && quantile(surplus, 0.75) > 0))
    return std::nullopt;
  double squares = 0;
  for (const double time : surplus) squares += time * time;
  return std::sqrt(squares / (2 * static_cast<double>(surplus.size())));
}

}  // namespace

TimeStepping time_stepping(const EventsAtHand& log, const Case& the_case, const Options& options) {
  TimeStepping result;
  result.step = common_step(log.events);
  const auto& has = log.available;
  if (!has.positions(false) || !has.velocities_before(false) || !has.velocities_after(false))
    return result;
  Measurements measured(log, the_case, audit::tolerances_of(the_case, options));
  result.soft = soft_contacts(measured.contacts, LoggedAt::begin);
  const auto end = soft_contacts(measured.contacts, LoggedAt::end);
  const auto spread = [](const SoftContacts& s) { return (s.high - s.low) / s.duration; };
  if (end && (!result.soft || spread(*end) < 0.8 * spread(*result.soft))) result.soft = end;
  if (const double step = late_step(measured.delays); step > 0) result.step_by_depth = step;
  // Rounding to a step has errors of up to half of it.
  const auto jitter = jitter_of(measured.surplus);
  if (jitter && !(result.step && *jitter < *result.step)) result.jitter = jitter;
  auto orders = mostly_known(std::move(measured.first_order));  // none without gravity
  if (orders.empty()) return result;
  const double middle = std::abs(quantile(orders, 0.5));
  const double step = result.step.value_or(result.step_by_depth.value_or(0));
  if (agree(orders) && middle > 1e-9 && (step == 0 || middle > step / 10))
    result.first_order_step = middle;
  // Second order is reported only where a delay of a tenth of a step would be visible.
  const double scatter = quantile(orders, 0.75) - quantile(orders, 0.25);
  result.second_order =
      !result.first_order_step && step > 0 && middle < step / 10 && scatter < step / 10;
  return result;
}

}  // namespace edmill::identify
