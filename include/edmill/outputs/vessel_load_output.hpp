// What the balls do to the vessel. docs/outputs.md, "vessel_load"
#pragma once

#include "edmill/outputs/output.hpp"
#include "edmill/outputs/titles.hpp"

namespace edmill::outputs {

template <class Real>
class VesselLoadOutput : public TableOutput<Real> {
 public:
  VesselLoadOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                   const RunFacts<Real>& run)
      : TableOutput<Real>(spec, folder, run), clock_(spec.timer) {
    auto& out = this->out();
    out << title_of("time", "s") << ',' << title_of("duration", "s");
    for (const auto& [name, unit] : {std::pair{"impulse", "N s"},
                                     {"force", "N"},
                                     {"torque", "N m"},
                                     {"vessel_force", "N"},
                                     {"vessel_torque", "N m"}})
      for (const auto* axis : {"_x", "_y", "_z"}) out << ',' << title_of(std::string(name) + axis, unit);
    out << ',' << title_of("work", "J") << ',' << title_of("power", "W") << '\n';
  }

 protected:
  void before(const Seen<Real>& seen) override {
    clock_.pass(this->timer(), seen.facts.time,
                [&](const Real& begin, const Real& end) { write_row(begin, end); });
  }

  void record(const Seen<Real>& seen) override {
    const auto& f = seen.facts;
    if (f.ball_ball) return;
    const Vec3<Real> impulse = (f.one.velocity_before - f.one.velocity_after) * f.one.ball->mass;
    impulse_ += impulse;
    moment_ += cross<Real>(f.contact_point, impulse);
    const auto pose = pose_of(seen);
    const Vec3<Real> own_impulse{dot<Real>(model::vessel_axis_x(pose), impulse),
                                 dot<Real>(model::vessel_axis_y(pose), impulse),
                                 dot<Real>(model::vessel_axis_z(pose), impulse)};
    vessel_impulse_ += own_impulse;
    vessel_moment_ += cross<Real>(own_contact_point(seen, pose), own_impulse);
    work_ += f.wall_work;
  }

  void end_of_record(const engine::Simulation<Real>&, const Real& until) override {
    clock_.finish(this->timer().from(), until,
                  [&](const Real& begin, const Real& end) { write_row(begin, end); });
  }

 private:
  void write_row(const Real& begin, const Real& end) {
    const Real duration = end - begin;
    auto& out = this->out();
    out << to_text<Real>(end) << ',' << to_text<Real>(duration);
    const auto write = [&](const Vec3<Real>& vector, const Real& over) {
      for (int axis = 0; axis < 3; ++axis) out << ',' << to_text<Real>(vector[axis] / over);
    };
    write(impulse_, Real(1));
    for (const auto* sum : {&impulse_, &moment_, &vessel_impulse_, &vessel_moment_}) write(*sum, duration);
    out << ',' << to_text<Real>(work_) << ',' << to_text<Real>(work_ / duration) << '\n';
    for (auto* sum : {&impulse_, &moment_, &vessel_impulse_, &vessel_moment_}) sum->setZero();
    work_ = Real(0);
  }

  IntervalClock<Real> clock_;
  // Sums of the present interval: impulses [N s] and their moments [N m s] about the fulcrum in the inertial
  // frame, and about the vessel's centre in its own.
  Vec3<Real> impulse_ = Vec3<Real>::Zero(), moment_ = Vec3<Real>::Zero(),
             vessel_impulse_ = Vec3<Real>::Zero(), vessel_moment_ = Vec3<Real>::Zero();
  Real work_{0};  ///< [J]
};

}  // namespace edmill::outputs
