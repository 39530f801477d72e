// What moving pictures have in common. In double: nothing is computed from them.
#pragma once

#include <functional>

#include "output/scene_output.hpp"

namespace edmill::output {

/// A frame at the start of the record, at the end of each interval, and at the end of the record.
template <class Real>
class FramesOutput : public SceneOutput<Real> {
 public:
  /// @param interval  its `interval` and `max_rows` are those of the frames
  FramesOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
               const RunContext<Real>& run, const casefile::TimerSpec& interval)
      : SceneOutput<Real>(spec, folder, run), clock_(interval) {}

 protected:
  using StateOf = std::function<model::BallState<Real>(int ball)>;  ///< at the time of the frame
  virtual void add_frame(const engine::Simulation<Real>& simulation, const Real& time,
                         const StateOf& state_of) = 0;

  void before(const ImpactFacts<Real>& f) override {
    const Real& now = f.time;
    if (complete_ || now < this->timer().from()) return;
    const BallsBefore<Real> balls(f);
    const auto frame = [&](const Real& time) {
      add_frame(f.simulation, time, [&](int i) { return balls.state(i, time); });
    };
    if (!begun_) frame(this->timer().from());
    begun_ = true;
    clock_.pass(this->timer(), now, [&](const Real&, const Real& end) { frame(end); });
    complete_ = this->timer().ends_by(now);
    if (complete_) frame(this->timer().until(now));
  }
  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    const auto frame = [&](const Real& time) {
      const auto when = simulation.instant_of(time);
      add_frame(simulation, time, [&](int i) { return simulation.state_at(i, when); });
    };
    const Real& from = this->timer().from();
    if (!begun_) frame(from);
    if (!complete_) clock_.finish(from, until, [&](const Real&, const Real& end) { frame(end); });
  }
  void archive_record(Archive& a) override { a(clock_, begun_, complete_); }

 private:
  IntervalClock<Real> clock_;
  bool begun_ = false, complete_ = false;
};

}  // namespace edmill::output
