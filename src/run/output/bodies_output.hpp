// Where the dose lands: on each ball and on each wall. docs/outputs.md, "bodies"
#pragma once

#include <vector>

#include "output/table_output.hpp"
#include "output/tallies.hpp"

namespace edmill::output {

/// Half of the dose of an impact is on either body.
template <class Real>
class BodiesOutput : public TableOutput<Real> {
 public:
  BodiesOutput(const casefile::OutputSpec& spec, const RunContext<Real>& run)
      : TableOutput<Real>(spec, run),
        on_balls_(run.ball_colours.size()),
        on_walls_(run.surfaces(spec).size()) {}

 protected:
  void archive_record(Archive& a) override { a(on_balls_, on_walls_); }

  void record(const ImpactFacts<Real>& f) override {
    const Real half = f.outcome.milling_dose / 2;
    const auto partner = static_cast<std::size_t>(f.impact.partner);
    on_balls_[static_cast<std::size_t>(f.impact.ball)].add(half);
    (f.impact.with_wall ? on_walls_[partner] : on_balls_[partner]).add(half);
  }

  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    this->begin({{"kind", text, "", "ball or wall"},
                 {"body", integer, "", "its number"},
                 {"impacts", integer, "1", "of the body"},
                 {"dose", number, "J", "half of that of its impacts"},
                 {"dose_rate", number, "W", "the same per second of the record"},
                 {"area", number, "m2", "of its surface"}},
                {this->window(until)});
    const Real time = until - this->timer().from();
    const auto put = [&](const char* kind, std::size_t body, const Tally<Real>& share, const Real& area) {
      const Real dose = share.energy.value();
      this->put(kind, static_cast<std::uint64_t>(body), share.impacts, dose,
                io::value_if(time > 0, [&] { return Real(dose / time); }), area);
    };
    for (std::size_t k = 0; k < on_balls_.size(); ++k) {
      const Real radius = simulation.properties(static_cast<int>(k)).radius;
      put("ball", k, on_balls_[k], 4 * numerics::pi<Real>() * radius * radius);
    }
    for (std::size_t k = 0; k < on_walls_.size(); ++k)
      put("wall", k, on_walls_[k], this->run.walls[k].area());
  }

 private:
  std::vector<Tally<Real>> on_balls_, on_walls_;
};

}  // namespace edmill::output
