// What pictures have in common. In double: nothing is computed from them.
#pragma once

#include <cmath>
#include <filesystem>

#include "output/balls_before.hpp"
#include "output/output.hpp"
#include "output/scene.hpp"

namespace edmill::output {

/// Makes scenes of a run.
template <class Real>
class SceneOutput : public Output<Real> {
 public:
  SceneOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
              const RunContext<Real>& run)
      : Output<Real>(spec, run),
        place_(folder / spec.folder / spec.file),
        contact_(spec.contact_point),
        run_(run) {}

 protected:
  const std::filesystem::path& place() const { return place_; }
  bool shows_contact() const { return contact_.has_value(); }

  static SceneAngles angles(const engine::Simulation<Real>& simulation, double time) {
    const auto& motion = *simulation.mill().motion.template get_if<model::SpexMotion<Real>>();
    const double phase = static_cast<double>(motion.angular_speed()) * time;
    return {std::acos(0.0) + static_cast<double>(motion.theta_max) * std::cos(phase),
            static_cast<double>(motion.gamma_max) * std::sin(phase)};
  }

  SceneBall contact_at(const Vec3<Real>& point) const {
    return {contact_->radius.template to<double>(), contact_->colour, vector_cast<double>(point)};
  }

  /// @param state_of  state of a ball by its id at `time`
  template <class StateOf>
  Scene scene(const engine::Simulation<Real>& simulation, const Real& time, StateOf&& state_of) const {
    const auto& mill = simulation.mill();
    const auto& motion = *mill.motion.template get_if<model::SpexMotion<Real>>();
    const auto& vessel = *mill.vessel.template get_if<model::CylinderVessel<Real>>();
    Scene s{static_cast<double>(motion.arm),
            static_cast<double>(vessel.radius),
            static_cast<double>(vessel.half_height),
            run_.vessel_colour,
            angles(simulation, static_cast<double>(time)),
            {},
            {},
            static_cast<double>(time)};
    for (int i = 0; i < simulation.ball_count(); ++i) {
      const auto state = state_of(i);
      s.balls.push_back({static_cast<double>(simulation.properties(i).radius),
                         run_.ball_colours[static_cast<std::size_t>(i)], vector_cast<double>(state.position),
                         vector_cast<double>(state.velocity), vector_cast<double>(state.spin)});
    }
    return s;
  }

 private:
  std::filesystem::path place_;
  std::optional<casefile::ContactPointSpec> contact_;
  RunContext<Real> run_;
};

}  // namespace edmill::output
