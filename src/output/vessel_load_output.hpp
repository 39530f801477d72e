// What the balls do to the vessel. docs/outputs.md, "vessel_load"
#pragma once

#include "output/output.hpp"
#include "output/titles.hpp"

namespace edmill::output {

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
    this->describe("time", "end of the interval");
    this->describe("work", "of the walls on the balls");
    this->describe("power", "of the walls on the balls");
    for (const std::string axis : {"_x", "_y", "_z"}) {
      this->describe("impulse" + axis, "on the vessel, inertial frame");
      this->describe("force" + axis, "mean force on the vessel, inertial frame");
      this->describe("torque" + axis, "mean torque on the vessel about the fulcrum, inertial frame");
      this->describe("vessel_force" + axis, "mean force on the vessel, vessel frame");
      this->describe("vessel_torque" + axis, "mean torque on the vessel about its centre, vessel frame");
    }
    out << ',' << title_of("work", "J") << ',' << title_of("power", "W") << '\n';
  }

 protected:
  void archive_record(Archive& a) override {
    a(clock_, impulse_, moment_, vessel_impulse_, vessel_moment_, work_);
  }

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

}  // namespace edmill::output
