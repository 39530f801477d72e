// What pictures have in common. In double: nothing is computed from them.
#pragma once

#include <filesystem>

#include "output/balls_before.hpp"
#include "output/output.hpp"
#include "output/scene.hpp"
#include "output/vessel_frame.hpp"

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
        run_(run) {
    for (const auto& surface : run.surfaces(spec)) walls_.push_back(model::mesh_of(surface));
  }

 protected:
  int ball_count() const { return static_cast<int>(run_.ball_colours.size()); }
  const std::filesystem::path& place() const { return place_; }
  bool shows_contact() const { return contact_.has_value(); }

  SceneBall contact_at(const Vec3<Real>& point) const {
    return {contact_->radius.template to<double>(), contact_->colour, vector_cast<double>(point)};
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
  /// @param state_of  state of a ball by its id at `time`
  Scene scene(const engine::Simulation<Real>& simulation, const Real& time, auto&& state_of) const {
    const auto& mill = simulation.mill();
    const auto now = static_cast<double>(time);
    Scene s{{walls_at(mill.vessel, time), run_.vessel_colour, vessel_frame(mill.motion, now)},
            Vec3<double>::Zero(),
            Vec3<double>::Zero(),
            {},
            {},
            now};
    for (int i = 0; i < simulation.ball_count(); ++i) {
      const auto state = state_of(i);
      s.balls.push_back({static_cast<double>(simulation.properties(i).radius),
                         run_.ball_colours[static_cast<std::size_t>(i)], vector_cast<double>(state.position),
                         vector_cast<double>(state.velocity), vector_cast<double>(state.spin)});
    }
    return s;
  }

 private:
  /// The walls, with pistons where they stand.
  std::vector<model::Mesh> walls_at(const model::AnyVessel<Real>& vessel, const Real& time) const {
    auto walls = walls_;
    for_each_piston(vessel, time, [&](std::size_t wall, const Vec3<double>& moved) {
      for (auto& point : walls[wall].points) point += moved;
    });
    return walls;
  }

  std::filesystem::path place_;
  std::optional<casefile::ContactPointSpec> contact_;
  RunContext<Real> run_;
  std::vector<model::Mesh> walls_;
};

}  // namespace edmill::output
