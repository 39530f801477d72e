#include "identify/fit.hpp"

#include <Eigen/LU>
#include <iterator>
#include <unsupported/Eigen/NonLinearOptimization>

#include "base/statistics.hpp"

namespace edmill::identify {

using audit::Check;

namespace {

constexpr double out_of_range = 1e15;

/// Rows below this fraction of the tolerance count as a perfect fit, up to rounding.
constexpr double perfect = 1e-4;

/// Rounding error of a row: that of double precision over the default tolerance of 1e-9.
constexpr double rounding_of_rows = 4e-7;

double median_size(std::vector<double> values) {
  for (double& v : values) v = std::abs(v);
  return numerics::quantile(std::move(values), 0.5);
}

/// Scales of the Cauchy weights, from the size of the initial residuals down to the tolerance.
std::vector<double> scales_for(const VectorXd& rows) {
  std::vector<double> off;
  for (const double r : rows)
    if (std::abs(r) > 1) off.push_back(r);
  const double largest = std::max(1.0, median_size(std::move(off)));
  std::vector<double> scales;
  for (double s = 3 * largest; s > 1; s /= 30) scales.push_back(s);
  scales.push_back(1);
  return scales;
}

/// Step of a parameter in its unit; negative if the case does not allow a larger value.
double possible_step(const Assumed& assumed, const Assumption& p, double value, double step) {
  return p.on(assumed, value + step * p.change).built() ? step : -step;
}

/// The interface through which Eigen evaluates weighted rows and their derivatives.
struct Problem {
  using Scalar = double;
  using InputType = VectorXd;
  using ValueType = VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  const Residuals& sample;
  const Hypothesis& tried;
  VectorXd roots{};  ///< square roots of the weights

  int inputs() const { return static_cast<int>(fitted(tried).size()); }
  int values() const { return static_cast<int>(sample.count()); }
  /// @param x  the numbers, each in its unit of a fit
  Hypothesis at(const VectorXd& x) const {
    Hypothesis moved = tried;
    for (Eigen::Index k = 0; auto& number : fitted(moved))
      number.value = x[k++] * number.what.change;
    return moved;
  }
  int operator()(const VectorXd& x, VectorXd& out) const {
    out = roots.cwiseProduct(sample.rows(at(x).assumed()));
    return 0;
  }
  int df(const VectorXd& x, Eigen::MatrixXd& out) const {
    out = roots.asDiagonal() * derivatives(at(x));
    return 0;
  }
  /// Finite differences, with a step for which neither rounding nor curvature matters.
  Eigen::MatrixXd derivatives(Hypothesis moved) const {
    Eigen::MatrixXd columns(values(), inputs());
    const VectorXd here = sample.rows(moved.assumed());
    for (Eigen::Index k = 0; auto& [what, value, half_width] : fitted(moved)) {
      const double step = possible_step(moved.assumed(), what, value, 1e-7);
      const double before = std::exchange(value, value + step * what.change);
      columns.col(k++) = (sample.rows(moved.assumed()) - here) / step;
      value = before;
    }
    return columns;
  }
};

VectorXd weights_of(const VectorXd& rows, double scale) {
  return (1 + rows.array().square() / (scale * scale)).inverse();
}

/// Sets the intervals: three standard deviations for noise of the size of the residuals, plus the
/// effect of the worst shift of all rows by that size: rounding shifts rows together.
void set_half_widths(const Eigen::MatrixXd& j, const VectorXd& rows, Hypothesis& tried) {
  const auto weights = weights_of(rows, 1);
  double sum = 0, total = 0;
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    if (j.row(i).isZero(0))
      continue;  // depends on no parameter, and says nothing about their noise
    sum += weights[i] * rows[i] * rows[i];
    total += weights[i];
  }
  // A few rows may fit better than rounding allows.
  const double noise = std::max(total > 0 ? std::sqrt(sum / total) : 0, rounding_of_rows);
  const Eigen::MatrixXd inverse = (j.transpose() * weights.asDiagonal() * j).inverse();
  const Eigen::MatrixXd influence = inverse * j.transpose() * weights.asDiagonal();
  for (Eigen::Index c = 0; auto& [what, value, half_width] : fitted(tried)) {
    const double random = 3 * std::sqrt(std::max(0.0, inverse(c, c))) * noise,
                 shift = influence.row(c).cwiseAbs().sum() * noise;
    const double rounding = 2e-15 * std::max(std::abs(value), std::abs(what.value));
    half_width = (random + shift) * what.change + rounding;
    ++c;
  }
}

}  // namespace

/// Rows of an event for an assumed model, terms of the equations, and deviations of the log.
audit::Rows LogResiduals::rows_of(
    std::size_t k, const Case& model, const LogChange& change, const Terms& terms) const {
  LoggedEvent copy, copy_of_earlier;
  const auto event_at = [&, is_changed = !(change == LogChange{})](
                            std::size_t place, LoggedEvent& own) -> const LoggedEvent& {
    if (!is_changed) return log_.events[place];
    own = log_.events[place];
    change.apply(own, model.mill);
    return own;
  };
  const audit::Equations equations(log_.available, tolerances_, terms, true);
  const LoggedEvent& event = event_at(k, copy);
  const bool placed = log_.available.positions(event.with_wall);
  audit::VesselFrame frame;
  if (event.with_wall && placed) frame = audit::vessel_at(model.mill, event.time, false);
  auto impact = audit::impact_of(event, model, frame, placed);
  impact.in_stall = in_stall_[k];
  impact.arm = terms.arm;
  if (event.with_wall && placed) {
    if (terms.wall_velocity_delay != 0 || terms.wall_velocity_formula != 0) {
      const double time = event.time - terms.wall_velocity_delay;
      impact.set_wall_velocity(audit::wall_velocities[terms.wall_velocity_formula], model.mill,
          audit::vessel_at(model.mill, time, false), audit::vessel_at(model.mill, time, true));
    }
    impact.wall_velocity *= terms.wall_velocity;
  }
  audit::Rows rows;
  if (placed) equations.of_touch(event, audit::gap_of(event, model, frame), rows);
  equations.of_impact(impact, rows);
  for (std::size_t body = 0; body < impact.count(); ++body) {
    const Before& begin = before_[k][body];
    if (begin.event < 0) continue;
    const LoggedEvent& earlier = event_at(begin.event, copy_of_earlier);
    equations.of_flight(
        {earlier.body[begin.body], event.body[body], log_.available.body[begin.body],
            log_.available.body[body], earlier.time, event.time,
            model.balls[event.ball_at(body)].radius, static_cast<int>(body)},
        model.mill.gravity, rows);
  }
  std::erase_if(rows, [](const audit::Row& row) { return row.equation == Check::approach; });
  return rows;
}

LogResiduals::LogResiduals(
    const EventsAtHand& log, const audit::Tolerances& tolerances, const Case& nominal)
    : log_(log), tolerances_(tolerances), before_(log.events.size()), in_stall_(log.events.size()),
      branches_(log.events.size()), nominal_(nominal) {
  std::vector<Before> last(nominal.balls.size());
  audit::StallHistory stalls(nominal.mill, nominal.balls.size());
  for (std::size_t k = 0; k < log.events.size(); ++k) {
    const auto& event = log.events[k];
    if (!event.problem.empty()) {  // the next flights have no known beginning
      std::fill(last.begin(), last.end(), Before{});
      for (std::size_t ball = 0; ball < last.size(); ++ball) stalls.forget(static_cast<int>(ball));
      continue;
    }
    for (std::size_t body = 0; body < event.count(); ++body) {
      auto& own = last[event.ball_at(body)];
      before_[k][body] = own;
      own = {static_cast<long>(k), body};
    }
    const auto& law = *audit::impact_of(event, nominal, {}, false).law;
    in_stall_[k] = stalls.take(event, law, tolerances.relative) == audit::Friction::rests;
    branches_[k] = branches_of(event);
  }
}

Branches LogResiduals::branches_of(const LoggedEvent& event) const {
  const auto& has = log_.available;
  if (!has.positions(event.with_wall) || !has.velocities_before(event.with_wall)) return {};
  const auto impact = audit::impact_of(event, nominal_,
      event.with_wall ? audit::vessel_at(nominal_.mill, event.time, false) : audit::VesselFrame{},
      true);
  const auto speeds = audit::speeds_before(impact);
  const double separation = impact.separation_speed(speeds.g_n), bounce = separation - speeds.g_n;
  // A contact sticks if twice the impulse does not change e_t.
  const auto e_t = [&](double impulse) {
    return impact.tangential_restitution(impact.compliance, impulse, speeds.slip);
  };
  return {true, has.spins(event.with_wall) && e_t(bounce) == e_t(2 * bounce),
      separation > impact.by_restitution(speeds.g_n)};
}

Residuals::Residuals(const LogResiduals& log, const std::vector<std::size_t>& events) : log_(&log) {
  for (const std::size_t k : events) {
    if (!log.log_.events[k].problem.empty()) continue;
    for (const auto& row : log.rows_of(k, log.nominal_, {}, {})) {
      const double allowed = row.allowed > 0 && std::isfinite(row.allowed) ? row.allowed : 1;
      const bool of_flight = row.equation == Check::flight || row.equation == Check::spin_kept;
      of_case_.insert(of_case_.end(), row.count, {allowed, row.kind, {k, row.body, of_flight}});
    }
    chosen_.push_back(k);
  }
}

VectorXd Residuals::rows(const Assumed& assumed) const {
  if (assumed.restricted.empty()) return of_whole(assumed);
  Assumed whole = assumed;
  whole.restricted.clear();
  auto values = of_whole(whole);
  // The rows are evaluated once for each combination of parts that contains a row.
  std::vector<std::size_t> set_of(count(), 0);
  for (std::size_t r = 0; r < assumed.restricted.size(); ++r)
    for (std::size_t k = 0; k < count(); ++k)
      if (assumed.restricted[r].part->contains(of_case_[k].at)) set_of[k] |= std::size_t{1} << r;
  for (const std::size_t set : std::set<std::size_t>(set_of.begin(), set_of.end())) {
    if (set == 0) continue;
    Assumed here = whole;
    for (std::size_t r = 0; r < assumed.restricted.size(); ++r)
      if (set >> r & 1) assumed.restricted[r].make(here);
    const VectorXd own = of_whole(here);
    for (std::size_t k = 0; k < count(); ++k)
      if (set_of[k] == set) values[k] = own[k];
  }
  return values;
}

VectorXd Residuals::of_whole(const Assumed& assumed) const {
  VectorXd values = VectorXd::Constant(count(), out_of_range);
  const auto model = assumed.built();
  if (!model) return values;
  std::size_t place = 0;
  for (const std::size_t k : chosen_)
    for (const auto& row : log_->rows_of(k, *model, assumed.log, assumed.terms))
      for (int n = 0; n < row.count; ++n, ++place)
        if (const double value = row.difference[n] / of_case_[place].allowed; std::isfinite(value))
          values[place] = std::clamp(value, -out_of_range, out_of_range);
  return values;
}

double misfit(const Residuals& sample, const VectorXd& rows) {
  std::array<std::vector<double>, audit::row_kinds> of_kind;
  for (std::size_t k = 0; k < sample.count(); ++k)
    of_kind[static_cast<std::size_t>(sample.of_case()[k].kind)].push_back(rows[k]);
  double cost = 0;
  for (const auto& own : of_kind) {
    const double scale = std::max(median_size(own), perfect);
    for (const double r : own)
      cost += 2 * std::log1p(r * r / (scale * scale)) + 2 * std::log(scale);
  }
  return cost;
}

void fit(const Residuals& sample, Hypothesis& tried) {
  Problem problem{sample, tried};
  VectorXd x(problem.inputs());
  for (Eigen::Index k = 0; const auto& number : fitted(tried))
    x[k++] = number.value / number.what.change;
  auto rows = sample.rows(tried.assumed());
  const auto scales = scales_for(rows);
  constexpr std::size_t most_rounds = 25;
  double cost = std::numeric_limits<double>::infinity();
  for (std::size_t round = 0; round < scales.size() + most_rounds; ++round) {
    problem.roots = weights_of(rows, scales[std::min(round, scales.size() - 1)]).cwiseSqrt();
    Eigen::LevenbergMarquardt<Problem> solver(problem);
    solver.parameters.xtol = solver.parameters.ftol = 1e-15;
    VectorXd now = x;
    auto status = solver.minimizeInit(now);
    for (int step = 0; step < 3 && status <= Eigen::LevenbergMarquardtSpace::Running; ++step)
      status = solver.minimizeOneStep(now);
    double moved = 0;
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      if (!std::isfinite(now[k])) continue;
      moved = std::max(moved, std::abs(now[k] - x[k]) / std::max(1.0, std::abs(now[k])));
      x[k] = now[k];
    }
    rows = sample.rows(problem.at(x).assumed());
    if (round < scales.size()) continue;
    // A change of the numbers by the remaining noise changes the cost by about its mean per row.
    constexpr double of_noise = 1e-6;
    const double last = std::exchange(cost, 0);
    for (const double r : rows) cost += std::log1p(r * r);
    if (moved < 1e-13 || last - cost < of_noise * cost / static_cast<double>(rows.size())) break;
  }
  tried = problem.at(x);
  set_half_widths(problem.derivatives(tried), rows, tried);
}

VectorXd sensitivity(const Residuals& sample, const Assumed& base, const VectorXd& rows,
    const Assumption& p) {  // A restitution or least separation speed of 0 may need a large
                            // step to have any effect.
  for (const double length : {1e-6, 1.0}) {
    if (!p.is_of_case() || (length == 1 && p.value != 0)) break;
    const double step = possible_step(base, p, p.value, length);
    const VectorXd moved = sample.rows(p.on(base, p.value + step * p.change)) - rows;
    const VectorXd slope = (moved.array().abs() > rounding_of_rows).select(moved / step, 0);
    if (!slope.isZero(0)) return slope;
  }
  return {};
}

double linear_misfit(const Residuals& sample, const VectorXd& rows, const VectorXd& slope) {
  VectorXd left = rows;
  const auto scales = scales_for(rows);
  for (std::size_t round = 0; round < scales.size() + 2; ++round) {
    const VectorXd weighted =
        weights_of(left, scales[std::min(round, scales.size() - 1)]).cwiseProduct(slope);
    const double change = -weighted.dot(rows) / weighted.dot(slope);
    if (!std::isfinite(change)) break;
    left = rows + slope * change;
  }
  return misfit(sample, left);
}

}  // namespace edmill::identify
