// Lyapunov exponents of the run. docs/outputs.md, "lyapunov"
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/sums.hpp"
#include "io/summary.hpp"
#include "output/table_output.hpp"
#include "tangent/spectrum.hpp"

namespace edmill::output {

struct LyapunovKeys {
  std::uint64_t exponents = 1;

  static void keys(auto& output, auto&& row) {
    row(Parameter{"interval", Dimension::time,
            "length of an interval for finite-time exponents: a row with the growth in each "
            "one, in place of the table of exponents",
            Range::positive}
            .usually("the whole record"),
        output.timer.interval);
    row(max_rows_key(), output.timer.max_rows);
    row(Parameter{"exponents",
            "number of exponents, the largest first; N balls have 9 N, and a larger number means "
            "all of them",
            Range(1, 9000), "1"},
        output.template make_own<LyapunovKeys>().exponents);
  }
  static void check(Section& s, const CaseSpec&, OutputSpec& output) {
    s.require(
        output.only.empty(), "only", "no restriction: exponents describe the motion of all balls");
  }
};

/// Tangent directions evolve in double for every scalar: exponents need few digits.
template <class Real> class LyapunovOutput : public TableOutput<Real> {
 public:
  LyapunovOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : TableOutput<Real>(spec, run),
        wanted_(std::min<std::uint64_t>(
            spec.own_keys<LyapunovKeys>().exponents, 9 * run.ball_colours.size())),
        intervals_(spec.timer) {
    if (!spec.timer.interval) return;
    std::vector<Column> columns{{"time", number, "s", "end of the interval"}};
    for (std::uint64_t k = 1; k <= wanted_; ++k)
      columns.push_back({"exponent_" + std::to_string(k), number, "1/s",
          "growth of ln of the distance of motions nearby, over the interval"});
    this->begin(std::move(columns));
  }
 protected:
  void archive_record(Archive& a) override {
    if (spectrum_) saved_ = spectrum_->state();
    a(saved_, before_, batches_, intervals_, collisions_, of_balls_, touched_, begun_, ended_);
    if (a.loading()) spectrum_.reset();
  }

  /// Tangent directions also evolve before the record begins; they stop when it has ended.
  void every(const ImpactFacts<Real>& f) override {
    if (ended_) return;
    const auto& simulation = f.simulation;
    const auto& impact = f.impact;
    if (!spectrum_)
      make_spectrum(
          simulation, in_double(simulation.clock().after(impact.time, -impact.flight_time[0])));
    const tangent::ImpactAt at{in_double(impact.time), vector_cast<double>(impact.normal),
        static_cast<double>(impact.outcome.approach_speed), impact.outcome.in_stall};
    const auto body = [&](int place, int ball) {
      const auto& flight = simulation.flight(ball);
      return tangent::Struck{ball, vector_cast<double>(flight.position),
          vector_cast<double>(impact.velocity_before[place]),
          vector_cast<double>(impact.spin_before[place]), vector_cast<double>(flight.velocity)};
    };
    begin_record(simulation, f.time);
    if (begun_) {
      if (const Real until = this->timer().until(f.time); until < f.time)
        return end_record(simulation, until);
      end_intervals(simulation, f.time);
    }
    if (impact.with_wall)
      spectrum_->with_wall(at, impact.partner, body(0, impact.ball));
    else
      spectrum_->of_pair(at, body(0, impact.ball), body(1, impact.partner));
  }

  void record(const ImpactFacts<Real>& f) override {
    ++collisions_;
    of_balls_ += f.impact.with_wall ? 1 : 2;
    touched_ += f.outcome.least_separation;
  }

  void end_of_record(const Simulation<Real>& simulation, const Real& until) override {
    if (begun_ && !spectrum_) make_spectrum(simulation, in_double(simulation.now()));
    if (begun_ && !ended_) end_record(simulation, until);
    if (!this->spec.timer.interval) put_exponents(simulation, until);
  }
 private:
  /// The exponents of the record.
  void put_exponents(const Simulation<Real>& simulation, const Real& until) {
    const double period = static_cast<double>(simulation.clock().period());
    const double duration = begun_ ? static_cast<double>(batches_.elapsed()) * period : 0;
    std::vector<std::string> comments{this->window(until),
        std::to_string(collisions_) + " impacts, of which " + std::to_string(touched_) +
            " at the least separation speed"};
    if (!(duration > 0))
      comments.push_back("no exponents: the record is shorter than a drive period");
    this->begin({{"exponent", integer, "", "the largest is 1"},
                    {"per_second", number, "1/s", "growth of ln of the distance of motions nearby"},
                    {"half_width", number, "1/s",
                        "of the 95 % interval, from batches of whole drive periods"},
                    {"per_collision", number, "1", "the same for each collision of a ball"},
                    {"digits_per_impact", number, "1",
                        "decimal digits that an impact of the run costs in this direction"}},
        std::move(comments));
    if (!(duration > 0)) return;
    const double per_ball =
        static_cast<double>(of_balls_) / static_cast<double>(this->run.ball_colours.size());
    const double share =
        duration / static_cast<double>(until - this->timer().from());  // of the impacts
    const double length = static_cast<double>(batches_.periods()) * period;
    std::vector<std::size_t> order(wanted_);
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto total = [&](std::size_t k) { return is_lost(k) ? none : batches_.total(k); };
    std::stable_sort(
        order.begin(), order.end(), [&](auto a, auto b) { return total(a) > total(b); });
    std::uint64_t place = 0;
    for (const auto k : order) {
      const double growth = total(k);
      const auto batches = batches_.amounts(k);
      const bool known = !is_lost(k) && batches.size() >= io::Intervals::fewest;
      this->put(++place, Real(growth / duration),
          io::value_if(known, [&] { return Real(io::Intervals::of(batches, length).half_width); }),
          Real(growth / (share * per_ball)),
          Real(growth / (share * static_cast<double>(collisions_)) / 2.302585092994046));
    }
  }

  static Instant<double> in_double(const Instant<Real>& t) {
    return {t.period, static_cast<double>(t.offset)};
  }

  void make_spectrum(const Simulation<Real>& simulation, const Instant<double>& start) {
    tangent::Balls balls;
    for (int k = 0; k < simulation.ball_count(); ++k) {
      const auto& p = simulation.properties(k);
      balls.push_back({static_cast<double>(p.radius), static_cast<double>(p.mass),
          static_cast<double>(p.reduced_inertia), p.material});
    }
    spectrum_.emplace(model::mill_cast<double>(simulation.mill()), balls, start, wanted_);
    if (!saved_.tangents.empty()) spectrum_->restore(saved_);
  }
  /// Starts the record, before the first impact after its start changes the directions.
  void begin_record(const Simulation<Real>& simulation, const Real& time) {
    if (begun_ || !this->timer().is_open() || time < this->timer().from()) return;
    const auto start = in_double(simulation.instant_of(this->timer().from()));
    spectrum_->orthonormalise(start);
    before_ = spectrum_->growth();
    batches_.begin(start);
    begun_ = true;
  }
  void end_intervals(const Simulation<Real>& simulation, const Real& time) {
    if (this->spec.timer.interval) return intervals_.pass(this->timer(), time, row_of(simulation));
    const auto now = in_double(simulation.instant_of(time));
    if (now < batches_.next_period()) return;
    spectrum_->orthonormalise(now);
    auto growth = spectrum_->growth();
    for (std::size_t k = 0; k < growth.size(); ++k)
      growth[k] = is_lost(k) ? 0 : growth[k] - before_[k];
    batches_.pass(now, growth);
  }
  void end_record(const Simulation<Real>& simulation, const Real& until) {
    end_intervals(simulation, until);
    if (this->spec.timer.interval)
      intervals_.finish(this->timer().from(), until, row_of(simulation));
    ended_ = true;
  }
  /// Writes the row of an interval.
  auto row_of(const Simulation<Real>& simulation) {
    return [this, &simulation](const Real& begin, const Real& end) {
      spectrum_->orthonormalise(in_double(simulation.instant_of(end)));
      const auto& growth = spectrum_->growth();
      this->put(end);
      for (std::size_t k = 0; k < growth.size(); ++k)
        this->put(
            Real(is_lost(k) ? none : (growth[k] - before_[k]) / static_cast<double>(end - begin)));
      before_ = growth;
    };
  }

  /// True if impacts at the least separation speed have annihilated the direction.
  bool is_lost(std::size_t k) const { return std::isinf(spectrum_->growth()[k]); }
  static constexpr double none = -std::numeric_limits<double>::infinity();

  std::uint64_t wanted_;
  IntervalClock<Real> intervals_;              ///< of finite-time exponents
  std::optional<tangent::Spectrum> spectrum_;  ///< from the first impact on
  tangent::Spectrum::State saved_;             ///< of a checkpoint
  std::vector<double> before_;                 ///< growth up to the record
  numerics::Batches<double> batches_;
  std::uint64_t collisions_ = 0, of_balls_ = 0, touched_ = 0;
  bool begun_ = false, ended_ = false;
};

}  // namespace edmill::output
