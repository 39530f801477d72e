// What pictures have in common. In double: nothing is computed from them.
#pragma once

#include "io/atomic_file.hpp"
#include "output/output.hpp"
#include "output/scene.hpp"

namespace edmill::output {

/// Makes scenes of a run.
template <class Real>
class SceneOutput : public Output<Real> {
 public:
  SceneOutput(const casefile::OutputSpec& spec, const RunContext<Real>& run) : Output<Real>(spec, run) {
    for (const auto& surface : run.surfaces(spec)) walls_.push_back(model::mesh_of(surface));
  }

 protected:
  /// Where the case asks for a mark.
  SceneBall contact_at(const Vec3<Real>& point) const {
    const auto& mark = *this->spec.contact_point;
    return {mark.radius.template to<double>(), mark.colour, vector_cast<double>(point)};
  }

  /// The walls at their places, from which pistons stand inward.
  const std::vector<model::Mesh>& walls() const { return walls_; }

  /// Calls f(wall, moved) with how far each piston stands from its wall's place [m].
  static void for_each_piston(const model::AnyVessel<Real>& vessel, const Real& time, auto&& f) {
    const auto* pistons = vessel.pistons();
    for (std::size_t k = 0; pistons && k < pistons->count(); ++k) {
      const int wall = pistons->wall(k);
      const Vec3<Real> normal = vessel.normal(wall, Vec3<Real>::Zero());
      f(static_cast<std::size_t>(wall),
        vector_cast<double>(Vec3<Real>(normal * pistons->at(k, {0, time}).value)));
    }
  }

  /// Nobody looks at it yet: look_at.
  Scene scene(const Moment<Real>& at) const {
    const auto& mill = at.simulation.mill();
    const auto now = static_cast<double>(at.time);
    Scene s{.vessel = {walls_, this->run.vessel_colour, vessel_frame(mill.motion, now)}, .time = now};
    for_each_piston(mill.vessel, at.time, [&](std::size_t wall, const Vec3<double>& moved) {
      for (auto& point : s.vessel.walls[wall].points) point += moved;
    });
    for (int i = 0; i < at.simulation.ball_count(); ++i) {
      const auto state = at.state_of(i);
      s.balls.push_back({static_cast<double>(at.simulation.properties(i).radius),
                         this->run.ball_colours[static_cast<std::size_t>(i)],
                         vector_cast<double>(state.position), vector_cast<double>(state.velocity),
                         vector_cast<double>(state.spin)});
    }
    return s;
  }

 private:
  std::vector<model::Mesh> walls_;
};

/// A file with a frame at the start of the record, at the end of each interval, and at the end of the record.
template <class Real>
class FramesOutput : public OneFileOutput<Real, io::AtomicFile, SceneOutput<Real>> {
 public:
  /// @param interval  its `interval` and `max_rows` are those of the frames
  FramesOutput(const casefile::OutputSpec& spec, const RunContext<Real>& run,
               const casefile::TimerSpec& interval)
      : OneFileOutput<Real, io::AtomicFile, SceneOutput<Real>>(spec, run), clock_(interval) {}

 protected:
  virtual void add_frame(const Moment<Real>& at) = 0;

  void before(const ImpactFacts<Real>& f) override {
    const Real& now = f.time;
    if (complete_ || now < this->timer().from()) return;
    const auto frame = [&](const Real& time) { add_frame({f, time}); };
    if (!begun_) frame(this->timer().from());
    begun_ = true;
    clock_.pass(this->timer(), now, [&](const Real&, const Real& end) { frame(end); });
    complete_ = this->timer().ends_by(now);
    if (complete_) frame(this->timer().until(now));
  }
  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    const auto frame = [&](const Real& time) { add_frame({simulation, time}); };
    const Real& from = this->timer().from();
    if (!begun_) frame(from);
    if (!complete_) clock_.finish(from, until, [&](const Real&, const Real& end) { frame(end); });
  }
  void archive_record(Archive& a) override { a(this->file_, clock_, begun_, complete_); }

 private:
  IntervalClock<Real> clock_;
  bool begun_ = false, complete_ = false;
};

}  // namespace edmill::output
