// Lyapunov exponents of the run. docs/outputs.md, "lyapunov"
#pragma once

#include <algorithm>

#include "base/batches.hpp"
#include "io/summary.hpp"
#include "output/table_output.hpp"
#include "tangent/spectrum.hpp"

namespace edmill::output {

struct LyapunovKeys {
  std::uint64_t exponents = 1;

  static void keys(auto& t, auto&& row) {
    row(
        casefile::Parameter{
            "exponents",
            Dimension::none,
            "how many, the largest first; of N balls there are 9 N, and more than that are all of "
            "them",
            {1, 9000},
            "1"},
        t.exponents);
  }
};

/// Directions are carried along in double whatever the run's scalar: exponents need few digits.
template <class Real>
class LyapunovOutput : public TableOutput<Real> {
 public:
  LyapunovOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                 const RunContext<Real>& run)
      : TableOutput<Real>(spec, folder, run), wanted_(spec.own_keys<LyapunovKeys>().exponents) {}

 protected:
  void archive_record(Archive& a) override {
    if (spectrum_) saved_ = spectrum_->state();
    a(saved_, before_, batches_, collisions_, of_balls_, touched_, begun_);
    if (a.loading()) spectrum_.reset();
  }

  /// Directions turn before the record begins, too.
  void every(const ImpactFacts<Real>& f) override {
    const auto& simulation = f.simulation;
    const auto& impact = f.impact;
    if (!spectrum_)
      make_spectrum(simulation, in_double(simulation.clock().after(impact.time, -impact.flight_time[0])));
    const tangent::ImpactAt<double> at{in_double(impact.time), vector_cast<double>(impact.normal),
                                       static_cast<double>(impact.outcome.approach_speed),
                                       impact.outcome.in_stall};
    const auto body = [&](int place, int ball) {
      const auto& flight = simulation.flight(ball);
      return tangent::Spectrum::Body{
          ball, vector_cast<double>(flight.position), vector_cast<double>(impact.velocity_before[place]),
          vector_cast<double>(impact.spin_before[place]), vector_cast<double>(flight.velocity)};
    };
    if (begun_ && !(at.time < batches_.next_period())) end_period(at.time);
    if (impact.with_wall)
      spectrum_->with_wall(at, impact.partner, body(0, impact.ball));
    else
      spectrum_->of_pair(at, body(0, impact.ball), body(1, impact.partner));
  }

  void record(const ImpactFacts<Real>& f) override {
    if (!begun_) begin_record(in_double(f.impact.time));
    ++collisions_;
    of_balls_ += f.impact.with_wall ? 1 : 2;
    touched_ += f.outcome.least_separation;
  }

  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    using enum Column::Type;
    this->begin({{"exponent", integer, "", "the largest is 1"},
                 {"per_second", number, "1/s", "growth of ln of the distance of motions nearby"},
                 {"half_width", number, "1/s", "of the 95 % interval, from batches of whole drive periods"},
                 {"per_collision", number, "1", "the same for each collision of a ball"},
                 {"digits_per_impact", number, "1",
                  "decimal digits that an impact of the run costs in this direction"}},
                {this->window(until), std::to_string(collisions_) + " impacts, of which " +
                                          std::to_string(touched_) + " at the least separation speed"});
    if (!spectrum_ || !begun_) return;
    const auto now = in_double(simulation.now());
    const double per_ball = static_cast<double>(of_balls_) / static_cast<double>(simulation.ball_count());
    end_period(now);
    const double period = static_cast<double>(simulation.clock().period());
    const double duration = static_cast<double>(batches_.elapsed()) * period;
    if (!(duration > 0)) return;
    for (std::size_t k = 0; k < spectrum_->directions(); ++k) {
      const bool lost = touched_ > 0 && k + 1 == spectrum_->dimensions();
      const double growth = lost ? -std::numeric_limits<double>::infinity() : batches_.total(k);
      const double rate = growth / duration;
      const auto batches = batches_.amounts(k);
      const double length = static_cast<double>(batches_.periods()) * period;
      const bool known = !lost && batches.size() >= io::Intervals::fewest;
      const double share = duration / static_cast<double>(until - this->timer().from());  // of the impacts
      this->put(
          static_cast<std::uint64_t>(k + 1), std::optional<Real>(Real(rate)),
          io::value_if(known, [&] { return Real(io::Intervals::of(batches, length).half_width); }),
          std::optional<Real>(Real(growth / (share * per_ball))),
          std::optional<Real>(Real(growth / (share * static_cast<double>(collisions_)) / 2.302585092994046)));
    }
  }

 private:
  static Instant<double> in_double(const Instant<Real>& t) {
    return {t.period, static_cast<double>(t.offset)};
  }

  void make_spectrum(const engine::Simulation<Real>& simulation, const Instant<double>& start) {
    tangent::Spectrum::Balls balls;
    for (int k = 0; k < simulation.ball_count(); ++k) {
      const auto& p = simulation.properties(k);
      balls.push_back({static_cast<double>(p.radius), static_cast<double>(p.mass),
                       static_cast<double>(p.reduced_inertia), p.material});
    }
    spectrum_.emplace(model::mill_cast<double>(simulation.mill()), std::move(balls), start,
                      static_cast<std::size_t>(wanted_));
    if (!saved_.tangents.empty()) spectrum_->restore(saved_);
  }
  void begin_record(const Instant<double>& now) {
    spectrum_->orthonormalise(now);
    before_ = spectrum_->growth();
    batches_.begin(now);
    begun_ = true;
  }
  void end_period(const Instant<double>& now) {
    if (now < batches_.next_period()) return;
    spectrum_->orthonormalise(now);
    auto growth = spectrum_->growth();
    for (std::size_t k = 0; k < growth.size(); ++k) growth[k] -= before_[k];
    batches_.pass(now, growth);
  }

  std::uint64_t wanted_;
  std::optional<tangent::Spectrum> spectrum_;  ///< from the first impact on
  tangent::Spectrum::State saved_;             ///< of a checkpoint
  std::vector<double> before_;                 ///< growth up to the record
  numerics::Batches<double> batches_;
  std::uint64_t collisions_ = 0, of_balls_ = 0, touched_ = 0;
  bool begun_ = false;
};

}  // namespace edmill::output
