// Forces and torques of the balls on the vessel. docs/outputs.md, "vessel_load"
#pragma once

#include "casefile/output_entry.hpp"
#include "output/table_output.hpp"

namespace edmill::output {

struct VesselLoadKeys {
  static void keys(auto& output, auto&& row) {
    row(casefile::interval_key("10 ms"), output.timer.interval);
    row(casefile::max_rows_key("32000"), output.timer.max_rows);
  }
};

template <class Real>
class VesselLoadOutput : public IntervalOutput<Real> {
 public:
  VesselLoadOutput(const casefile::OutputSpec& spec, const RunContext<Real>& run)
      : IntervalOutput<Real>(spec, run) {
    std::vector<Column> columns{{"time", number, "s", "end of the interval"},
                                {"duration", number, "s", "length of the interval"}};
    const auto add = [&](const std::string& name, const char* unit, const char* meaning) {
      for (const auto* axis : {"_x", "_y", "_z"}) columns.push_back({name + axis, number, unit, meaning});
    };
    add("impulse", "N s", "on the vessel, inertial frame");
    add("force", "N", "mean force on the vessel, inertial frame");
    add("torque", "N m", "mean torque on the vessel about the fulcrum, inertial frame");
    add("vessel_force", "N", "mean force on the vessel, vessel frame");
    add("vessel_torque", "N m", "mean torque on the vessel about its centre, vessel frame");
    columns.push_back({"work", number, "J", "of the walls on the balls"});
    columns.push_back({"power", number, "W", "of the walls on the balls"});
    this->begin(std::move(columns));
  }

 protected:
  void archive_record(Archive& a) override { a(impulse_, moment_, vessel_impulse_, vessel_moment_, work_); }

  void record(const ImpactFacts<Real>& f) override {
    if (!f.impact.with_wall) return;
    const auto* body = f.simulation.mill().body_of(f.impact.partner);
    if (body && !body->on_vessel) return;
    const Vec3<Real> impulse = (f.one.velocity_before - f.one.velocity_after) * f.one.ball->mass;
    impulse_ += impulse;
    moment_ += cross<Real>(f.contact_point, impulse);
    const auto pose = pose_of(f);
    const Vec3<Real> own_impulse{dot<Real>(f.simulation.mill().motion.axis_x(pose), impulse),
                                 dot<Real>(f.simulation.mill().motion.axis_y(pose), impulse),
                                 dot<Real>(f.simulation.mill().motion.axis_z(pose), impulse)};
    vessel_impulse_ += own_impulse;
    vessel_moment_ += cross<Real>(own_contact_point(f, pose), own_impulse);
    work_ += f.outcome.wall_work;
  }

  void write_row(const Real& begin, const Moment<Real>& end) override {
    const Real duration = end.time - begin;
    this->put(end.time, duration, impulse_);
    for (const auto* sum : {&impulse_, &moment_, &vessel_impulse_, &vessel_moment_})
      this->put(Vec3<Real>(*sum / duration));
    this->put(work_, Real(work_ / duration));
    for (auto* sum : {&impulse_, &moment_, &vessel_impulse_, &vessel_moment_}) sum->setZero();
    work_ = Real(0);
  }

 private:
  // Sums of the present interval: impulses [N s] and their moments [N m s] about the fulcrum in the inertial
  // frame, and about the vessel's centre in its own.
  Vec3<Real> impulse_ = Vec3<Real>::Zero(), moment_ = Vec3<Real>::Zero(),
             vessel_impulse_ = Vec3<Real>::Zero(), vessel_moment_ = Vec3<Real>::Zero();
  Real work_{0};  ///< [J]
};

}  // namespace edmill::output
