#include "run/sensitivity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "base/errors.hpp"
#include "casefile/build_case.hpp"
#include "casefile/value_of_key.hpp"
#include "engine/simulation.hpp"
#include "io/named_file.hpp"
#include "output/collision_log.hpp"

namespace edmill::run {

namespace {

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
    throw InputError(
        fmt::format("--by: found \"{}\", expected initial.BALL.COORDINATE with a ball below {} and one of {}",
                    key, spec.ball_count(), fmt::join(coordinates, ", ")));
  number.ball = std::stoi(ball);
  number.coordinate = static_cast<int>(known - std::begin(coordinates));
  number.unit = std::array{"m", "m/s", "rad/s"}[static_cast<std::size_t>(number.coordinate / 3)];
  return number;
}

/// Reads the events of a run, and ends it when there are enough.
class Watch : public engine::Observer<mpfr> {
 public:
  Watch(std::size_t events, const SensitivityOptions& options, std::string precision)
      : wanted_(events), options_(options), precision_(std::move(precision)) {}

  void on_impact(const engine::Impact<mpfr>& impact, engine::Simulation<mpfr>& simulation) override {
    events.push_back(output::record_of<mpfr>(impact, simulation));
    if (events.size() >= wanted_ || (options_.interrupt && *options_.interrupt))
      simulation.request_stop(engine::EndReason::stopped);
    if (events.size() % 16 == 0) options_.progress(precision_, events.size());
  }

  std::vector<Event> events;

 private:
  std::size_t wanted_;
  const SensitivityOptions& options_;
  std::string precision_;
};

class Differentiator {
 public:
  Differentiator(const casefile::CaseSpec& spec, const SensitivityOptions& options)
      : spec_(spec), options_(options) {
    for (const auto& key : options.by) numbers_.push_back(number_of(spec, key));
    for (const auto& number : numbers_) result.by.push_back(number.key), result.units.push_back(number.unit);
  }

  /// With so many digits for the run. @return the digits that it needs
  double run(unsigned digits) {
    const unsigned step_digits = std::min(digits, most_digits_of_step), evaluation = digits + 2 * step_digits;
    std::unique_ptr<Linearised> linearised;
    {
      const mpfr::Digits wide(evaluation);
      const auto base = casefile::build_case<mpfr>(spec_);
      std::vector<Perturbation> others;
      for (const auto& number : numbers_) others.push_back(perturbed(number, base, step_digits));
      linearised = std::make_unique<Linearised>(without_change(base), std::move(others), evaluation);
    }
    const mpfr::Digits of_run(digits);
    result.precision = fmt::format("mpfr:{}", digits);
    const auto built = casefile::build_case<mpfr>(spec_);
    engine::Simulation<mpfr> simulation(built.the_case, built.states, built.start);
    Watch watch(options_.events, options_, result.precision);
    simulation.attach(*linearised);
    simulation.attach(watch);
    const auto end = built.the_case.stop.end_time ? *built.the_case.stop.end_time : Instant<mpfr>::never();
    simulation.run_until(end);
    result.interrupted = options_.interrupt && *options_.interrupt;
    result.events = std::move(watch.events);
    result.derivatives = linearised->events();
    put_lower_first();
    return needed();
  }

  void require_events() const {
    if (result.events.size() < options_.events && !result.interrupted)
      throw InputError(fmt::format("{}: the case ends after {} collisions, {} are requested", spec_.file,
                                   result.events.size(), options_.events));
    for (const auto& event : result.events)
      if (event.by_rule)
        throw UndecidedError(fmt::format(
            "a rule and not the equations orders two contacts of ball {} at {} s: there is no derivative",
            event.ball, event.time.str(17)));
  }

  Sensitivities result;

 private:
  using Built = casefile::InitialCase<mpfr>;

  static Perturbation without_change(const Built& built) {
    return {built.the_case.mill, built.the_case.balls,
            std::vector<tangent::Tangent<mpfr>>(built.states.size())};
  }
  Perturbation perturbed(const Parameter& number, const Built& base, unsigned step_digits) const {
    const mpfr step = mpfr(1) / mpfr(std::string("1e") + std::to_string(step_digits));
    if (number.ball < 0) return with_parameter(number.key, base, step, step_digits);
    auto same = without_change(base);
    same.step = step;
    auto& start = same.initial[static_cast<std::size_t>(number.ball)];
    std::array{&start.position, &start.velocity, &start.spin}[static_cast<std::size_t>(number.coordinate / 3)]
        ->
        operator[](number.coordinate % 3) = 1;
    return same;
  }
  /// A parameter at an end of its range, a restitution of 1, is changed to the other side.
  Perturbation with_parameter(const std::string& key, const Built& base, const mpfr& step,
                              unsigned step_digits) const {
    const auto value = casefile::value_of_key(spec_, key);
    for (const int sign : {1, -1}) try {
        const auto built =
            casefile::build_case<mpfr>(casefile::with_close_value(spec_, key, value.plus(sign, step_digits)));
        auto changed = without_change(built);
        changed.step = step * sign;
        changed.initial = change_of_start(base, built, changed.step);
        return changed;
      } catch (const InputError&) {
      }
    throw InputError(fmt::format(
        "--by: found \"{}\", whose value {} can be neither a little larger nor a little smaller, expected a "
        "parameter that varies continuously",
        key, value.number));
  }
  /// Balls are placed, and a run begins, by the parameters of the case.
  static std::vector<tangent::Tangent<mpfr>> change_of_start(const Built& base, const Built& other,
                                                             const mpfr& step) {
    const auto begin = [](const Built& built) {
      return DriveClock<mpfr>(built.the_case.mill.motion.period()).seconds(built.start);
    };
    const mpfr later = (begin(other) - begin(base)) / step;
    std::vector<tangent::Tangent<mpfr>> change(base.states.size());
    for (std::size_t k = 0; k < change.size(); ++k) {
      const auto &one = base.states[k], &two = other.states[k];
      change[k].position = (two.position - one.position) / step - one.velocity * later;
      change[k].velocity = (two.velocity - one.velocity) / step - base.the_case.mill.gravity * later;
      change[k].spin = (two.spin - one.spin) / step;
    }
    return change;
  }

  /// Of two balls the lower number comes first, as in other lists of events.
  void put_lower_first() {
    for (std::size_t k = 0; k < result.events.size(); ++k) {
      auto& event = result.events[k];
      if (event.with_wall || event.ball < event.partner) continue;
      std::swap(event.ball, event.partner);
      for (auto& d : result.derivatives[k]) std::swap(d.states_after[0], d.states_after[1]);
    }
  }

  /// An error of the run has grown as the derivatives have: by the largest of them.
  double needed() const {
    mpfr largest(1);
    for (const auto& event : result.derivatives)
      for (const auto& d : event)
        for (const auto& t : d.states_after)
          for (const auto* v : {&t.position, &t.velocity})
            for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, abs((*v)[axis]));
    // Of a second derivative, by which an error of the state moves the first one.
    return options_.digits + 25 + 2 * static_cast<double>(log10(largest));
  }

  const casefile::CaseSpec& spec_;
  const SensitivityOptions& options_;
  std::vector<Parameter> numbers_;
};

void write(std::ostream& out, const casefile::CaseSpec& spec, const SensitivityOptions& options,
           const Sensitivities& found) {
  out << "# edmill sensitivities 1\n# case digest " << spec.digest << ", " << found.precision << '\n';
  for (std::size_t k = 0; k < found.by.size(); ++k)
    out << "# d_ columns " << k << ": SI units per " << (found.units[k].empty() ? "1" : found.units[k])
        << " of " << found.by[k] << '\n';
  out << "index,time,ball,partner_kind,partner";
  const auto header = [&](std::size_t k, std::string_view name) { out << ",d_" << name << '_' << k; };
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
    out << e << ',' << text(event.time) << ',' << event.ball << (event.with_wall ? ",wall," : ",ball,")
        << event.partner;
    for (const auto& d : found.derivatives[e]) {
      for (const auto& value : d.values) out << ',' << text(value);
      if (!options.states) continue;
      for (std::size_t body = 0; body < 2; ++body)
        for (const auto* v :
             {&d.states_after[body].position, &d.states_after[body].velocity, &d.states_after[body].spin})
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
    throw InputError(fmt::format("--digits: found {}, expected at most {}: a derivative has no more",
                                 options.digits, most_digits));
  auto file = io::file_for(options.file);
  Differentiator differentiator(spec, options);
  double digits = options.digits + 60.0;
  for (;;) {
    const double needed = differentiator.run(static_cast<unsigned>(digits));
    differentiator.require_events();
    if (differentiator.result.interrupted || needed <= digits) break;
    digits = 1.1 * needed;
  }
  auto found = std::move(differentiator.result);
  if (file && !found.interrupted) file->write([&](std::ostream& out) { write(out, spec, options, found); });
  return found;
}

}  // namespace edmill::run
