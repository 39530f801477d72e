#include "run/sensitivity.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors.hpp"
#include "base/wide_trigonometry.hpp"
#include "casefile/build_case.hpp"
#include "engine/simulation.hpp"
#include "io/output_folder.hpp"
#include "output/collision_log.hpp"

namespace edmill::run {

namespace {

using Vector = Vec3<mpfr>;
using Tangent = tangent::Tangent<mpfr>;

/// The model and the initial state after a small change of one number of either.
struct Perturbation {
  model::Mill<mpfr> mill;  ///< with the parameter larger by `step`
  std::vector<model::BallProperties<mpfr>> balls;
  std::vector<Tangent> initial;  ///< derivative of the balls' states at the start
  mpfr step{0};                  ///< negative where no larger value is allowed
};

/// States of a ball and, if it is one, its partner.
using States = std::array<model::BallState<mpfr>, 2>;

/// Converts a time to the clock of a mill with another drive period.
Instant<mpfr> on_clock_of(
    const model::Mill<mpfr>& mill, const mpfr& period, const Instant<mpfr>& t, const mpfr& later) {
  return {t.period, t.offset + mpfr(t.period) * (period - mill.motion.period()) + later};
}

/// @param states  just before the impact; they become those after it
dynamics::ImpactOutcome<mpfr> collide(const Perturbation& in, const engine::Impact<mpfr>& impact,
    const Instant<mpfr>& time, States& states) {
  auto& [one, two] = states;
  const auto& own = in.balls[impact.ball];
  const bool rests = impact.outcome.in_stall;
  if (!impact.with_wall) {
    const Vector between = one.position - two.position;
    const Vector normal = between * (mpfr(1) / norm<mpfr>(between));
    const auto& partner = in.balls[impact.partner];
    return dynamics::collide_balls<mpfr>(normal, own, partner, one.velocity, one.spin, two.velocity,
        two.spin, in.mill.law_between(own, partner), rests);
  }
  const auto touch = model::touch_of(in.mill, impact.partner, own.radius, time, one.position);
  return dynamics::collide_with_wall<mpfr>(touch.normal, own, touch.wall_velocity, one.velocity,
      one.spin, in.mill.law_with_wall(own, impact.partner), rests);
}

/// Carries the states of motions infinitely close to a run from impact to impact: the maps of an
/// impact for the run and for its neighbour, `step` away, in three times the run's digits, give the
/// derivative as difference over step.
class Linearised : public engine::Observer<mpfr> {
 public:
  /// @param base    the mill in these digits, and balls without `initial`
  /// @param digits  of the evaluation
  /// @param found   to which each impact adds its derivatives, by perturbation
  Linearised(Perturbation base, std::vector<Perturbation> others, unsigned digits,
      std::vector<std::vector<EventDerivative>>& found)
      : base_(std::move(base)), others_(std::move(others)), digits_(digits), found_(found) {
    for (const auto& other : others_) tangents_.push_back(other.initial);
  }

  void on_impact(
      const engine::Impact<mpfr>& impact, engine::Simulation<mpfr>& simulation) override {
    const mpfr::Digits evaluation(digits_);
    States before;
    for (int k = 0; k < (impact.with_wall ? 1 : 2); ++k)
      before[k] = {simulation.flight(ball_of(impact, k)).position, impact.velocity_before[k],
          impact.spin_before[k]};
    auto& derivatives = found_.emplace_back();
    for (std::size_t which = 0; which < others_.size(); ++which)
      derivatives.push_back(derivative(impact, before, which));
  }
 private:
  static int ball_of(const engine::Impact<mpfr>& impact, int k) {
    return k == 0 ? impact.ball : impact.partner;
  }

  EventDerivative derivative(
      const engine::Impact<mpfr>& impact, const States& before, std::size_t which) {
    const auto& other = others_[which];
    const mpfr& step = other.step;
    const auto& gravity = base_.mill.gravity;
    const Vector gravity_rate = (other.mill.gravity - gravity) / step;
    const int count = impact.with_wall ? 1 : 2;
    std::array<Tangent*, 2> t{};
    for (int k = 0; k < count; ++k) {
      const mpfr& dt = impact.flight_time[k];
      t[k] = &tangents_[which][ball_of(impact, k)];
      t[k]->fly(dt);
      t[k]->position += gravity_rate * mpfr(dt * dt / 2);
      t[k]->velocity += gravity_rate * dt;
    }
    const auto radius = [&](const Perturbation& in, int k) {
      return in.balls[ball_of(impact, k)].radius;
    };
    const mpfr& period = base_.mill.motion.period();
    mpfr gap;
    if (impact.with_wall) {
      const auto at = [&](const Perturbation& in, const Vector& position) {
        return mpfr(-model::touch_of(in.mill, impact.partner, radius(in, 0),
            on_clock_of(in.mill, period, impact.time, 0), position)
                         .overlap);
      };
      const Vector moved = before[0].position + t[0]->position * step;
      gap = (at(other, moved) - at(base_, before[0].position)) / step;
    } else {
      gap = dot<mpfr>(impact.normal, Vector(t[0]->position - t[1]->position)) -
          (radius(other, 0) + radius(other, 1) - radius(base_, 0) - radius(base_, 1)) / step;
    }
    const mpfr& approach = impact.outcome.approach_speed;
    const mpfr later = approach > 0 ? mpfr(gap / approach) : mpfr(0);

    States run = before, nearby;
    for (int k = 0; k < count; ++k) {
      const auto& b = before[k];
      nearby[k] = {b.position + (t[k]->position + b.velocity * later) * step,
          b.velocity + (t[k]->velocity + gravity * later) * step, b.spin + t[k]->spin * step};
    }
    const auto o = collide(base_, impact, impact.time, run);
    const auto p =
        collide(other, impact, on_clock_of(other.mill, period, impact.time, later * step), nearby);

    EventDerivative d;
    const auto rate = [&](const mpfr& a, const mpfr& b) { return mpfr((b - a) / step); };
    d.values = {later, rate(o.approach_speed, p.approach_speed), rate(o.slip_speed, p.slip_speed),
        rate(o.milling_dose, p.milling_dose), rate(o.wall_work, p.wall_work)};
    for (int k = 0; k < count; ++k) {
      t[k]->position += (before[k].velocity - run[k].velocity) * later;
      t[k]->velocity = (nearby[k].velocity - run[k].velocity) / step - gravity * later;
      t[k]->spin = (nearby[k].spin - run[k].spin) / step;
      d.states_after[k] = *t[k];
    }
    return d;
  }

  Perturbation base_;
  std::vector<Perturbation> others_;
  unsigned digits_;
  /// Tangents by perturbation and ball, at the ball's last impact.
  std::vector<std::vector<Tangent>> tangents_;
  std::vector<std::vector<EventDerivative>>& found_;
};

constexpr unsigned most_digits_of_step = 380;  // decimals in a case have at most 400

/// The nine numbers of a ball's state.
constexpr std::string_view coordinates[] = {"x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz"};

/// A number by which a run is differentiated.
struct Parameter {
  std::string key, unit;
  int ball = -1, coordinate = -1;  ///< of the initial state
};

Parameter number_of(const casefile::CaseSpec& spec, const std::string& key) {
  Parameter number{key, "", -1, -1};
  constexpr std::string_view begin = "initial.";
  if (!key.starts_with(begin)) {
    number.unit = casefile::value_of_key(spec, key).unit;
    return number;
  }
  const auto point = key.find('.', begin.size());
  const std::string ball = key.substr(begin.size(), point - begin.size());
  const bool whole =
      !ball.empty() && ball.size() < 8 && ball.find_first_not_of("0123456789") == std::string::npos;
  const auto known = point == std::string::npos
      ? std::end(coordinates)
      : std::find(std::begin(coordinates), std::end(coordinates), key.substr(point + 1));
  if (!whole || std::stoul(ball) >= spec.ball_count() || known == std::end(coordinates))
    throw InputError(fmt::format(
        "--by: found \"{}\", expected initial.BALL.COORDINATE with a ball below {} and one of {}",
        key, spec.ball_count(), fmt::join(coordinates, ", ")));
  number.ball = std::stoi(ball);
  number.coordinate = static_cast<int>(known - std::begin(coordinates));
  number.unit = std::array{"m", "m/s", "rad/s"}[static_cast<std::size_t>(number.coordinate / 3)];
  return number;
}

/// Runs the case in more and more digits and collects its events with their derivatives.
class Differentiator : private engine::Observer<mpfr> {
 public:
  Differentiator(const casefile::CaseSpec& spec, const SensitivityOptions& options)
      : spec_(spec), options_(options) {
    result.by = options.by;
    for (const auto& key : options.by) {
      numbers_.push_back(number_of(spec, key));
      result.units.push_back(numbers_.back().unit);
    }
  }

  /// Runs the case with this many digits. @return the digits that it needs
  double run(unsigned digits) {
    const unsigned step_digits = std::min(digits, most_digits_of_step),
                   evaluation = digits + 2 * step_digits;
    Linearised linearised = [&] {
      const mpfr::Digits wide(evaluation);
      const auto base = casefile::build_case<mpfr>(spec_);
      std::vector<Perturbation> others;
      for (const auto& number : numbers_) others.push_back(perturbed(number, base, step_digits));
      return Linearised(without_change(base), std::move(others), evaluation, result.derivatives);
    }();
    const mpfr::Digits of_run(digits);
    result.precision = fmt::format("mpfr:{}", digits);
    const auto built = casefile::build_case<mpfr>(spec_);
    engine::Simulation<mpfr> simulation(built.the_case, built.states, built.start);
    simulation.attach(linearised);
    simulation.attach(*this);
    result.events.clear();
    result.derivatives.clear();
    simulation.run_until(built.the_case.stop.end_time.value_or(Instant<mpfr>::never()));
    result.interrupted = options_.interrupt && *options_.interrupt;
    put_lower_first();
    return needed();
  }

  void require_events() const {
    if (result.events.size() < options_.events && !result.interrupted)
      throw InputError(fmt::format("{}: the case ends after {} collisions, {} are requested",
          spec_.file, result.events.size(), options_.events));
    for (const auto& event : result.events)
      if (event.by_rule)
        throw UndecidedError(
            fmt::format("a rule and not the equations orders two contacts of ball {} at {} s: "
                        "there is no derivative",
                event.ball, event.time.str(17)));
  }

  Sensitivities result;
 private:
  using Built = casefile::InitialCase<mpfr>;

  /// Ends the run when there are enough events.
  void on_impact(
      const engine::Impact<mpfr>& impact, engine::Simulation<mpfr>& simulation) override {
    result.events.push_back(output::record_of<mpfr>(impact, simulation));
    const auto count = result.events.size();
    if (count >= options_.events || (options_.interrupt && *options_.interrupt))
      simulation.request_stop(engine::EndReason::stopped);
    if (count % 16 == 0) options_.progress(result.precision, count);
  }

  static Perturbation without_change(const Built& built) {
    return {built.the_case.mill, built.the_case.balls, std::vector<Tangent>(built.states.size())};
  }
  Perturbation perturbed(const Parameter& number, const Built& base, unsigned step_digits) const {
    const mpfr step = mpfr(1) / mpfr(std::string("1e") + std::to_string(step_digits));
    if (number.ball < 0) return with_parameter(number.key, base, step, step_digits);
    auto same = without_change(base);
    same.step = step;
    auto& start = same.initial[static_cast<std::size_t>(number.ball)];
    Vector* const parts[] = {&start.position, &start.velocity, &start.spin};
    (*parts[number.coordinate / 3])[number.coordinate % 3] = 1;
    return same;
  }
  /// Changes a parameter by `step`; at the end of its range, in the other direction.
  Perturbation with_parameter(
      const std::string& key, const Built& base, const mpfr& step, unsigned step_digits) const {
    const auto value = casefile::value_of_key(spec_, key);
    for (const int sign : {1, -1}) {
      try {
        const auto built = casefile::build_case<mpfr>(casefile::with_value(
            spec_, key, value.plus(sign, step_digits), casefile::SizeLimit::none));
        auto changed = without_change(built);
        changed.step = step * sign;
        changed.initial = change_of_start(base, built, changed.step);
        return changed;
      } catch (const InputError&) {  // tried in the other direction
      }
    }
    throw InputError(
        fmt::format("--by: found \"{}\", whose value {} can be neither a little larger nor a "
                    "little smaller, expected a parameter that varies continuously",
            key, value.number));
  }
  /// Derivative of the initial state: parameters also shift places and the begin.
  static std::vector<Tangent> change_of_start(
      const Built& base, const Built& other, const mpfr& step) {
    const auto begin = [](const Built& built) {
      return DriveClock<mpfr>(built.the_case.mill.motion.period()).seconds(built.start);
    };
    const mpfr later = (begin(other) - begin(base)) / step;
    std::vector<Tangent> change(base.states.size());
    for (std::size_t k = 0; k < change.size(); ++k) {
      const auto &one = base.states[k], &two = other.states[k];
      change[k].position = (two.position - one.position) / step - one.velocity * later;
      change[k].velocity =
          (two.velocity - one.velocity) / step - base.the_case.mill.gravity * later;
      change[k].spin = (two.spin - one.spin) / step;
    }
    return change;
  }

  /// Puts the ball with the lower number first in each event, as in other lists of events.
  void put_lower_first() {
    for (std::size_t k = 0; k < result.events.size(); ++k) {
      auto& event = result.events[k];
      if (event.with_wall || event.ball < event.partner) continue;
      std::swap(event.ball, event.partner);
      for (auto& d : result.derivatives[k]) std::swap(d.states_after[0], d.states_after[1]);
    }
  }

  /// The digits that the run needs: its errors have grown by the largest of the derivatives.
  double needed() const {
    mpfr largest(1);
    for (const auto& event : result.derivatives)
      for (const auto& d : event)
        for (const auto& t : d.states_after)
          for (const auto* v : {&t.position, &t.velocity})
            for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, abs((*v)[axis]));
    // With those of a second derivative, by which an error of the state changes the first.
    return options_.digits + 25 + 2 * static_cast<double>(log10(largest));
  }

  const casefile::CaseSpec& spec_;
  const SensitivityOptions& options_;
  std::vector<Parameter> numbers_;
};

void write(std::ostream& out, const casefile::CaseSpec& spec, const SensitivityOptions& options,
    const Sensitivities& found) {
  out << "# edmill sensitivities 1\n# case digest " << spec.digest << ", " << found.precision
      << '\n';
  for (std::size_t k = 0; k < found.by.size(); ++k)
    out << "# d_ columns " << k << ": SI units per "
        << (found.units[k].empty() ? "1" : found.units[k]) << " of " << found.by[k] << '\n';
  out << "index,time,ball,partner_kind,partner";
  const auto header = [&](std::size_t k, std::string_view name) {
    out << ",d_" << name << '_' << k;
  };
  for (std::size_t k = 0; k < found.by.size(); ++k) {
    for (const auto& quantity : model::logged_quantities) header(k, quantity.name);
    if (options.states)
      for (const char* body : {"ball", "partner"})
        for (const auto& c : coordinates) header(k, std::string(body) + "_" + std::string(c));
  }
  out << '\n';
  const auto text = [&](const mpfr& x) { return x.str(static_cast<int>(options.digits)); };
  for (std::size_t e = 0; e < found.events.size(); ++e) {
    const auto& event = found.events[e];
    out << e << ',' << text(event.time) << ',' << event.ball
        << (event.with_wall ? ",wall," : ",ball,") << event.partner;
    for (const auto& d : found.derivatives[e]) {
      for (const auto& value : d.values) out << ',' << text(value);
      if (!options.states) continue;
      for (std::size_t body = 0; body < 2; ++body)
        for (const auto* v : {&d.states_after[body].position, &d.states_after[body].velocity,
                 &d.states_after[body].spin})
          for (int axis = 0; axis < 3; ++axis)
            out << ',' << (body == 1 && event.with_wall ? "" : text((*v)[axis]));
    }
    out << '\n';
  }
}

}  // namespace

Sensitivities sensitivity(const casefile::CaseSpec& spec, const SensitivityOptions& options) {
  constexpr unsigned most_digits = most_digits_of_step - 20;
  if (options.digits > most_digits)
    throw InputError(
        fmt::format("--digits: found {}, expected at most {}: a derivative has no more",
            options.digits, most_digits));
  io::NamedFile file(options.file);
  Differentiator differentiator(spec, options);
  double digits = options.digits + 60.0;
  for (;;) {
    const double needed = differentiator.run(static_cast<unsigned>(digits));
    differentiator.require_events();
    if (differentiator.result.interrupted || needed <= digits) break;
    digits = 1.1 * needed;
  }
  auto found = std::move(differentiator.result);
  if (!found.interrupted) file.write([&](std::ostream& out) { write(out, spec, options, found); });
  return found;
}

}  // namespace edmill::run
