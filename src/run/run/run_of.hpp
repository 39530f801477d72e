// A run in one scalar: EventSource, AnyRun and the public Run; for the instantiation files only.
#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.hpp"
#include "base/standard_arithmetic.hpp"
#include "base/wide_trigonometry.hpp"
#include "casefile/case_spec.hpp"
#include "edmill/run.hpp"
#include "io/final_state.hpp"
#include "io/summary.hpp"
#include "output/collision_log.hpp"
#include "output/outputs.hpp"
#include "run/any_run.hpp"
#include "run/event_source.hpp"
#include "run/run_driver.hpp"
#include "run/run_folder.hpp"

namespace edmill::run {

template <class Real> class RunningCase : public EventSource, private engine::Observer<Real> {
 public:
  RunningCase(const casefile::CaseSpec& spec, bool to_end, const std::atomic<bool>* interrupt)
      : spec_(spec), built_(casefile::build_case<Real>(spec)), interrupt_(interrupt),
        reached_(built_.start) {
    if (const auto& stop = built_.the_case.stop; to_end) {
      const auto is_set = [](const auto& limit) { return limit.has_value(); };
      if (std::any_of(stop.limits.begin(), stop.limits.end(), is_set))
        stop_rules_.emplace(built_.the_case);
      if (stop.end_time) end_ = *stop.end_time;
    }
    begin(built_.states);
  }

  std::vector<Event> next(std::size_t count) override {
    const auto scope = digits_.use();
    while (waiting_.size() < count && !over_) advance();
    const auto end =
        waiting_.begin() + static_cast<std::ptrdiff_t>(std::min(count, waiting_.size()));
    std::vector<Event> events(waiting_.begin(), end);
    waiting_.erase(waiting_.begin(), end);
    return events;
  }
  std::size_t pass(std::size_t count) override {
    const auto scope = digits_.use();
    wanted_ = false;
    const auto before = impacts_;
    while (impacts_ - before < count && !over_) advance();
    wanted_ = true;
    return impacts_ - before;
  }
  bool has_collapsed() const override { return simulation_->collapse().has_value(); }
  double reached() const override { return static_cast<double>(simulation_->seconds()); }

  std::vector<Number> states() const override {
    std::vector<Number> numbers;
    for (const auto& state : states_now())
      for (const auto& vector : {state.position, state.velocity, state.spin})
        for (int axis = 0; axis < 3; ++axis) numbers.push_back(Number(vector[axis]));
    return numbers;
  }

  void continue_in([[maybe_unused]] unsigned digits) override {
    if constexpr (requires { digits_.digits; }) {
      if (over_) return;
      const auto states = states_now();
      digits_.digits = digits;
      const auto scope = digits_.use();
      built_.the_case.mill = casefile::build_mill<Real>(spec_);
      begin(states);
    }
  }
 private:
  void begin(const std::vector<model::BallState<Real>>& states) {
    simulation_.emplace(built_.the_case, states, reached_, interrupt_);
    simulation_->attach(*this);
  }
  /// Advances by a window much shorter than many events take, so that few are computed in vain.
  void advance() {
    reached_ = simulation_->clock().after(reached_, simulation_->clock().period() / 16);
    const bool last = !(reached_ < end_);
    over_ =
        simulation_->run_until(last ? end_ : reached_, interrupt_) != engine::EndReason::end_time ||
        last;
  }
  std::vector<model::BallState<Real>> states_now() const {
    const auto scope = digits_.use();
    std::vector<model::BallState<Real>> states;
    for (int k = 0; k < simulation_->ball_count(); ++k)
      states.push_back(simulation_->state_at(k, simulation_->now()));
    return states;
  }
  void on_impact(
      const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override {
    if (stop_rules_) {
      auto numbered = impact;
      numbered.index = impacts_;  // earlier simulations have had impacts, too
      stop_rules_->on_impact(numbered, simulation);
    }
    ++impacts_;
    if (!wanted_) return;
    const auto record = output::record_of<Real>(impact, simulation);
    Event event{.ball = record.ball, .with_wall = record.with_wall, .partner = record.partner};
    for (std::size_t k = 0; k < model::logged_count; ++k) event[k] = Number(record[k]);
    event.by_rule = record.by_rule;
    event.put_in_order();
    waiting_.push_back(event);
  }

  ChosenDigits<Real> digits_;
  casefile::CaseSpec spec_;
  casefile::InitialCase<Real> built_;
  const std::atomic<bool>* interrupt_;
  std::optional<StopRuleWatch<Real>> stop_rules_;
  std::optional<engine::Simulation<Real>> simulation_;
  Instant<Real> reached_, end_ = Instant<Real>::never();
  std::uint64_t impacts_ = 0;
  bool wanted_ = true;  ///< events are kept
  std::deque<Event> waiting_;
  bool over_ = false;
};

template <class Real>
std::unique_ptr<EventSource> make_source_in(
    const casefile::CaseSpec& spec, bool to_end, const std::atomic<bool>* interrupt) {
  return std::make_unique<RunningCase<Real>>(spec, to_end, interrupt);
}

/// Converts to the public type, each number with `of`.
template <class To, class Real, class Of>
Impact<To> to_public(const engine::Impact<Real>& i, const Real& time, const Of& of) {
  const auto& o = i.outcome;
  return {i.index, of(time), i.ball, i.with_wall, i.partner,
      {of(i.normal[0]), of(i.normal[1]), of(i.normal[2])}, of(o.approach_speed), of(o.slip_speed),
      of(o.separation_speed), of(o.restitution_tangential), of(o.normal_impulse),
      of(o.tangential_impulse), of(o.milling_dose), of(o.supplied_energy), of(o.wall_work)};
}
template <class To, class Real, class Of>
BallState<To> to_public(const model::BallState<Real>& s, const Of& of) {
  const auto vector = [&](const Vec3<Real>& v) { return Vector<To>{of(v[0]), of(v[1]), of(v[2])}; };
  return {vector(s.position), vector(s.velocity), vector(s.spin)};
}

/// Converts user-defined joints to a motion, with exact numbers of turns per period.
template <class Real>
model::AnyMotion<Real> to_motion(const Joints<Real>& given, const Real& period) {
  const auto per_period = [](const TurnsPerPeriod& t) {
    using casefile::Quantity;
    if (t.of < 1)
      throw InputError(
          "joint: found turns per " + std::to_string(t.of) + " periods, expected 1 or more");
    const std::vector<model::Swing<Quantity>> turning{
        {Quantity{1}, Quantity{t.turns, t.of}, Quantity{0}}};
    return casefile::with_phases(turning, Quantity{1}).front().per_period;
  };
  model::Joints<Real> joints{{}, period};
  for (const auto& j : given) {
    const auto turns = per_period(j.speed);
    model::Joint<Real> joint{
        j.rotates, j.axis, j.shift, j.angle, Real(0), j.rotates ? turns : model::TurnFraction{}};
    for (const auto& h : j.harmonics)
      joint.swings.push_back({h.amplitude, Real(0), h.phase, per_period(h.frequency)});
    if (!j.rotates && j.speed.turns != 0)
      throw InputError("joint: found a translation with turns per period, expected harmonics");
    if ((j.rotates || !joint.swings.empty()) && j.axis == std::array<Real, 3>{})
      throw InputError("joint: the axis has no length");
    joints.list.push_back(std::move(joint));
  }
  return model::ChainMotion<Real>(joints);
}

/// Replaces the vessel of a case by the program's own, without what the case says about walls.
/// @throws InputError for moving walls or materials of walls, which cannot be transferred
template <class Real>
void forget_walls(model::Mill<Real>& mill, const model::AnyVessel<Real>& own) {
  auto& of_walls = mill.pairs.of_walls;
  const auto old_count = static_cast<std::size_t>(mill.vessel.wall_count()),
             new_count = static_cast<std::size_t>(own.wall_count()), bodies = mill.bodies.size();
  std::vector<int> kept;  // laws of the bodies
  bool foreign = mill.vessel.pistons() != nullptr;
  for (std::size_t k = 0; k < of_walls.size(); ++k) {
    const auto wall = k % (old_count + bodies);
    foreign = foreign || (wall < old_count && of_walls[k] >= 0);
    if (wall == 0) kept.insert(kept.end(), new_count, -1);
    if (wall >= old_count) kept.push_back(of_walls[k]);
  }
  constexpr std::size_t most = 48;  // as of a case
  if (bodies > 0 && new_count + bodies > most)
    throw InputError("vessel of the program: found " + std::to_string(new_count + bodies) +
        " walls and bodies, expected at most " + std::to_string(most));
  if (foreign)
    throw InputError(
        "vessel of the program: found a case whose walls move or have materials, expected a case "
        "with plain walls");
  of_walls = kept;
  mill.vessel = own;
}

/// Puts the bodies of a case on the motion and in the vessel that the program defines.
template <class Real>
void fit_bodies(model::Mill<Real>& mill, const casefile::CaseSpec& spec, bool own_joints) {
  for (auto& body : mill.bodies) {
    if (own_joints && body.on_vessel) {
      auto joints = body.motion.joints();
      const auto& carrier = mill.motion.template get_if<model::ChainMotion<Real>>()->joints().list;
      const auto before = static_cast<std::ptrdiff_t>(casefile::joints_of(spec.mill).size());
      joints.list.erase(joints.list.begin(), joints.list.begin() + before);
      joints.list.insert(joints.list.begin(), carrier.begin(), carrier.end());
      body.motion = model::ChainMotion<Real>(joints);
    }
    const Real domain = body.motion.reach(mill.motion.reach(mill.vessel.reach()));
    body.shape = body.shape.among(
        Real(spec.largest_diameter() / 2 * (1 + 1e-9)), domain * (1 + rounding_margin<Real>()));
  }
}

/// Builds the case with the parts that the program defines.
template <class Real>
casefile::InitialCase<Real> build(const casefile::CaseSpec& spec, const OwnParts<Real>& own) {
  auto mill = casefile::build_mill<Real>(spec);
  if (own.laws.ball_ball) mill.ball_ball.law = model::LawOfProgram<Real>{own.laws.ball_ball};
  if (own.laws.ball_wall) mill.ball_wall.law = model::LawOfProgram<Real>{own.laws.ball_wall};
  if (!own.planes.empty()) {
    std::vector<typename model::PolyhedronVessel<Real>::Plane> planes;
    for (const auto& [n, distance] : own.planes) planes.push_back({{n[0], n[1], n[2]}, distance});
    forget_walls<Real>(mill, model::PolyhedronVessel<Real>(planes));
  } else if (own.vessel) {
    const auto& half = own.vessel->half_sizes;
    forget_walls<Real>(
        mill, model::AlgebraicVessel<Real>(own.vessel->walls, {half[0], half[1], half[2]}));
  }
  if (!own.joints.empty()) mill.motion = to_motion<Real>(own.joints, mill.motion.period());
  fit_bodies<Real>(mill, spec, !own.joints.empty());
  return casefile::build_case_in<Real>(mill, spec);
}

/// Adapts a contact law with numbers as texts to one with numbers.
template <class Real> class LawOfTexts : public CustomLaw<Real> {
 public:
  explicit LawOfTexts(std::shared_ptr<const LawInTexts> law) : law_(std::move(law)) {}
  Real restitution(const Real& approach_speed) const override {
    return number(law_->restitution(to_text<Real>(approach_speed)), "restitution");
  }
  Real restitution_of_slip(
      const Real& change, const Real& slip, const Real& compliance) const override {
    const auto text = law_->restitution_of_slip(
        to_text<Real>(change), to_text<Real>(slip), to_text<Real>(compliance));
    return number(text, "restitution_of_slip");
  }
 private:
  static Real number(const std::string& text, const char* what) {
    try {
      return from_text<Real>(text);
    } catch (const std::invalid_argument&) {
      throw InputError("contact law of the program: " + std::string(what) + ": found " + text +
          ", expected a number");
    }
  }

  std::shared_ptr<const LawInTexts> law_;
};

template <class Real> class RunOf : public AnyRun, private engine::Observer<Real> {
 public:
  RunOf(std::shared_ptr<const casefile::CaseSpec> spec, const OwnParts<Real>& own,
      const RunSetup& setup = {})
      : spec_(std::move(spec)), built_(build(*spec_, own)),
        own_laws_(own.laws.ball_ball || own.laws.ball_wall) {
    guests_.interrupt = setup.interrupt;
    guests_.observers.push_back(this);
    if (setup.progress) {
      std::optional<double> end;
      if (spec_->end_time) end = spec_->end_time->template to<double>();
      guests_.observers.push_back(&progress_.emplace(setup.progress, end));
    }
    if (setup.max_cpu_time < std::numeric_limits<double>::infinity())
      guests_.observers.push_back(&cpu_limit_.emplace(setup.max_cpu_time));
  }

  /// Arithmetic settings of the run, for calls from outside.
  struct Scope {
    StandardArithmetic arithmetic;
    decltype(std::declval<const ChosenDigits<Real>&>().use()) digits;
  };
  Scope use() const { return {{}, digits_.use()}; }

  void write_to(const std::filesystem::path& folder, std::optional<io::Checkpoint> checkpoint,
      const std::function<void(const std::filesystem::path&)>& without_locks) override {
    const auto scope = use();
    EDMILL_REQUIRE(end_reason_ == model::EndReason::paused && !advanced_ && !outputs_,
        "write_to is called once, before the run advances");
    folder_.emplace(folder, *spec_, std::move(checkpoint));
    if (without_locks && !folder_->locked()) without_locks(folder_->place());
    guests_.checkpoints = folder_->checkpoints();
    try {
      const DriveClock<Real> clock(built_.the_case.mill.motion.period());
      outputs_.emplace(*spec_, built_.the_case.mill, folder_->place(), clock.seconds(built_.start));
    } catch (...) {
      folder_.reset();  // free for others
      throw;
    }
  }
  void attach(Watcher& watcher) override { watchers_.push_back(&watcher); }
  /// Called for each impact after the outputs, for the public Run.
  void attach(std::function<void(const Impact<Real>&)> call) { calls_.push_back(std::move(call)); }

  void begin() override {
    const auto scope = use();
    if (!driver_) driver_.emplace(built_, guests_);
  }
  void finish() override { advance(std::nullopt); }
  /// @param limit  empty for the end of the case @return true if the run can be continued
  bool advance(const std::optional<Real>& limit) {
    const auto scope = use();
    if (end_reason_ != model::EndReason::paused) return false;
    try {
      begin();
      advanced_ = true;
      if (limit && !(*limit > now())) return true;
      if (limit) asked_ = {driver_->simulation().clock().at(*limit), *limit};
      end_reason_ = limit ? driver_->go(asked_.first) : driver_->go();
    } catch (const UndecidedError& undecided) {
      end_reason_ = model::EndReason::undecided;
      error_ = undecided.what();
      throw;
    }
    return end_reason_ == model::EndReason::paused;
  }
  void stop(model::EndReason why) override { driver_->simulation().request_stop(why); }

  int ball_count() const override { return static_cast<int>(built_.states.size()); }
  std::string time() const override {
    const auto scope = use();
    return to_text<Real>(now());
  }
  /// The current time [s]: exactly what was requested if the run is there, not the rounded instant.
  Real now() const {
    const auto& now = driver_->simulation().now();
    const auto& end = built_.the_case.stop.end_time;
    if (end && now == *end) return spec_->end_time->template to<Real>();
    return now == asked_.first ? asked_.second : driver_->simulation().seconds();
  }
  BallState<std::string> ball(int i) const override {
    const auto scope = use();
    return to_public<std::string>(state_of(i), to_text<Real>);
  }
  Ball<Real> properties_of(int i) const {
    EDMILL_REQUIRE(i >= 0 && i < ball_count(), "the number of a ball");
    const auto& ball = built_.the_case.balls[static_cast<std::size_t>(i)];
    const auto material = static_cast<std::size_t>(ball.material);
    return {ball.radius, ball.mass, material > 0 ? spec_->materials[material - 1].name : ""};
  }
  model::BallState<Real> state_of(int i) const {
    EDMILL_REQUIRE(i >= 0 && i < ball_count(), "the number of a ball");
    return driver_->simulation().state_at(i, driver_->simulation().now());
  }

  io::Facts facts() const override {
    const auto scope = use();
    return io::facts_of(result());
  }
  std::string summary_json() const override {
    const auto scope = use();
    return io::summary_json(result());
  }
  /// The summary so far, with warnings. After the run's end it does not change.
  io::Summary<Real> result() const {
    if (ended_) return *ended_;
    auto s = summary_of(*spec_, built_, driver_);
    if (driver_) s.end_time = now();
    finish_summary(s, end_reason_, error_);
    if (end_reason_ != model::EndReason::paused) ended_ = s;
    return s;
  }

  bool goes_on() const override {
    return folder_ && folder_->has_checkpoint() && end_reason_ == model::EndReason::interrupted;
  }
  void commit(const std::function<std::string()>& when_written) override {
    const auto scope = use();
    EDMILL_REQUIRE(outputs_, "write_to was called");
    if (driver_) outputs_->on_end(driver_->simulation());
    write_results();
    const std::string left = when_written();
    if (!goes_on()) folder_->remove_checkpoint(left);
    outputs_.reset();
    folder_.reset();
  }
 private:
  void on_impact(
      const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override {
    if (own_laws_ || !spec_->outputs.empty() || !calls_.empty() || !watchers_.empty())
      show(impact, simulation);
  }
  /// A separate function, so that an impact that nobody observes costs a few instructions.
  [[gnu::noinline]] void show(
      const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) {
    if (own_laws_) require_no_gain(impact);
    if (outputs_ && !spec_->outputs.empty()) outputs_->on_impact(impact, simulation);
    if (watchers_.empty() && calls_.empty()) return;
    const Real time = simulation.seconds();
    if (!calls_.empty()) {
      const auto seen = to_public<Real>(impact, time, std::identity());
      for (const auto& call : calls_) call(seen);
    }
    const auto rounded = [](const Real& x) { return static_cast<double>(x); };
    const SeenImpact seen{impact.index, rounded(time),
        [&] { return to_public<double>(impact, time, rounded); },
        [&] { return to_public<std::string>(impact, time, to_text<Real>); }};
    for (auto* watcher : watchers_) watcher->on_impact(seen, *this);
  }
  void archive(Archive& a) override {
    if (outputs_ && !spec_->outputs.empty()) a(*outputs_);
  }

  /// Writes all files before any is put in place; the summary, which names them, is last.
  void write_results() {
    const DriveClock<Real> clock(built_.the_case.mill.motion.period());
    auto files = outputs_->complete(goes_on());
    folder_->write("final_state.csv", [&](std::ostream& out) {
      io::write_final_state<Real>(out, saved_state(built_, driver_), clock);
    });
    folder_->write(
        "case.toml", [&](std::ostream& out) { out << casefile::text_with_settings(*spec_); });
    std::vector<std::filesystem::path> all{"case.toml", "summary.json", "final_state.csv"};
    for (const auto* file : files)
      all.push_back(file->place().lexically_proximate(folder_->place()));
    folder_->write_crate(spec_->digest, scalar_name<Real>(), all);
    folder_->write("summary.json", [&](std::ostream& out) { out << summary_json(); });
    folder_->commit(std::move(files));
  }

  /// A law with e_t beyond -1 may give an impact more energy than it had.
  static void require_no_gain(const engine::Impact<Real>& impact) {
    const auto& o = impact.outcome;
    const Real rounding =
        (o.normal_impulse * o.approach_speed + o.tangential_impulse * o.slip_speed) / 1000000000;
    if (!(o.milling_dose >= -rounding))
      throw InputError("contact law of the program: impact " + std::to_string(impact.index) +
          " of ball " + std::to_string(impact.ball) + " and " +
          (impact.with_wall ? "wall " : "ball ") + std::to_string(impact.partner) + " gains " +
          to_text<Real>(-o.milling_dose) + " J: e_t is " + to_text<Real>(o.restitution_tangential) +
          ", expected -1 to 1");
  }

  ChosenDigits<Real> digits_;
  std::shared_ptr<const casefile::CaseSpec> spec_;
  casefile::InitialCase<Real> built_;
  bool own_laws_;
  Guests<Real> guests_;
  std::optional<ProgressWatch<Real>> progress_;
  std::optional<CpuLimit<Real>> cpu_limit_;
  std::optional<RunFolder> folder_;
  std::optional<output::Outputs<Real>> outputs_;
  std::vector<Watcher*> watchers_;
  std::vector<std::function<void(const Impact<Real>&)>> calls_;
  std::optional<RunDriver<Real>> driver_;
  bool advanced_ = false;
  std::pair<Instant<Real>, Real> asked_{
      Instant<Real>::long_ago(), Real(0)};  ///< end of the last advance [s]
  model::EndReason end_reason_ = model::EndReason::paused;
  std::string error_;
  mutable std::optional<io::Summary<Real>> ended_;
};

template <class Real>
std::unique_ptr<AnyRun> make_run_in(const casefile::CaseSpec& spec, const RunSetup& setup) {
  const auto law = [](const auto& texts) {
    return texts ? std::make_shared<LawOfTexts<Real>>(texts) : nullptr;
  };
  return std::make_unique<RunOf<Real>>(std::make_shared<const casefile::CaseSpec>(spec),
      OwnParts<Real>{{}, {}, {}, {law(setup.ball_ball), law(setup.ball_wall)}}, setup);
}

}  // namespace edmill::run

namespace edmill {

template <class Real> class Run<Real>::Implementation : public run::RunOf<Real> {
 public:
  using run::RunOf<Real>::RunOf;
};

template <class Real>
Run<Real>::Run(const Case& the_case, const Laws<Real>& laws, const Planes<Real>& vessel)
    : Run(the_case, OwnParts<Real>{vessel, {}, {}, laws}) {}
template <class Real>
Run<Real>::Run(const Case& the_case, const OwnParts<Real>& own)
    : implementation_([&] {
        const StandardArithmetic scope;
        auto made = std::make_unique<Implementation>(the_case.spec_, own);
        made->begin();
        return made;
      }()) {}
template <class Real> Run<Real>::~Run() = default;

template <class Real> void Run<Real>::attach(Observer<Real>& observer) {
  implementation_->attach(
      [this, &observer](const Impact<Real>& impact) { observer.on_impact(impact, *this); });
}
template <class Real> void Run<Real>::write_to(const std::string& folder) {
  implementation_->write_to(folder, std::nullopt, {});
}
template <class Real> void Run<Real>::commit() {
  implementation_->commit([] { return std::string(); });
}
template <class Real> bool Run<Real>::advance_to(const Real& time) {
  return implementation_->advance(time);
}
template <class Real> void Run<Real>::finish() { implementation_->finish(); }
template <class Real> void Run<Real>::stop() { implementation_->stop(model::EndReason::stopped); }
template <class Real> void Run<Real>::interrupt() {
  implementation_->stop(model::EndReason::interrupted);
}
template <class Real> Real Run<Real>::time() const {
  const auto scope = implementation_->use();
  return implementation_->now();
}
template <class Real> int Run<Real>::ball_count() const { return implementation_->ball_count(); }
template <class Real> BallState<Real> Run<Real>::ball(int i) const {
  const auto scope = implementation_->use();
  return run::to_public<Real>(implementation_->state_of(i), std::identity());
}
template <class Real> Ball<Real> Run<Real>::properties(int i) const {
  const auto scope = implementation_->use();
  return implementation_->properties_of(i);
}
template <class Real> Summary<Real> Run<Real>::summary() const {
  const auto scope = implementation_->use();
  const auto s = implementation_->result();
  Summary<Real> out;
  out.start_time = s.start_time;
  out.end_time = s.end_time;
  for (int k = 0; k < s.partners.count(); ++k) out.partners.push_back(s.partners[k].key);
  out.collisions = s.collisions;
  out.dose_by_partner = s.dose_by_partner;
  out.milling_dose = s.milling_dose;
  out.wall_work = s.wall_work;
  out.supplied_energy = s.supplied_energy;
  out.energy_closure = s.energy_closure;
  out.simultaneous_contacts = s.simultaneous_contacts;
  out.cpu_seconds = s.cpu_seconds;
  out.end_reason = model::name(s.end_reason);
  for (const auto& warning : s.warnings) out.warnings.push_back(warning.text);
  if (s.intervals.any()) out.milling_dose_rate_half_width = s.intervals.dose_rate.half_width;
  out.milling_time = s.milling_time();
  out.json = io::summary_json(s);
  return out;
}

}  // namespace edmill

#define EDMILL_RUN(Real)                                                \
  namespace edmill {                                                    \
  template std::unique_ptr<run::EventSource> run::make_source_in<Real>( \
      const casefile::CaseSpec&, bool, const std::atomic<bool>*);       \
  template std::unique_ptr<run::AnyRun> run::make_run_in<Real>(         \
      const casefile::CaseSpec&, const run::RunSetup&);                 \
  template class Run<Real>;                                             \
  }
