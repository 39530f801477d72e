// The event log as HDF5, for long runs: rows are small, and a reader takes only the columns it needs.
#pragma once

#include <limits>

#include "output/collisions_output.hpp"
#include "output/event_file.hpp"
#include "output/one_file_output.hpp"

namespace edmill::output {

namespace detail {

inline std::vector<EventColumn> event_columns(const model::Partners& partners, bool states) {
  using Type = EventColumn::Type;
  std::string walls;
  for (int wall = 0; wall < partners.walls(); ++wall)
    walls += (wall == 0 ? "" : ", ") + std::to_string(wall) + " " + partners[wall].label;
  std::vector<EventColumn> columns{
      {"index", "1", "impacts since the start of the run, from 0", Type::integer},
      {"time", "s", "instant of the impact", Type::number},
      {"ball", "1", "id of the ball, from 0", Type::integer},
      {"partner", "1", "id of the other ball, or of the wall: " + walls, Type::integer},
      {"with_wall", "1", "1 when the partner is a wall", Type::integer},
      {"approach_speed", "m/s", "normal relative speed at the contact point before", Type::number},
      {"slip_speed", "m/s", "tangential relative speed at the contact point before", Type::number},
      {"milling_dose", "J", "kinetic energy that the impact dissipates", Type::number},
      {"wall_work", "J", "work of the wall on the ball", Type::number}};
  if (states)
    for (const std::string body : {"ball", "partner"})
      for (const auto& [what, unit] : {std::pair{"position", "m"},
                                       {"velocity_before", "m/s"},
                                       {"spin_before", "rad/s"},
                                       {"velocity_after", "m/s"},
                                       {"spin_after", "rad/s"}})
        columns.push_back({body + "_" + what, unit, "inertial frame; nan for a wall", Type::vector});
  return columns;
}

}  // namespace detail

/// NAME.h5: /events with a dataset for each column, the balls and their final state beside it. Numbers
/// are 64-bit whatever the scalar: the digits of a wide run are in the CSV.
template <class Real>
class EventsOutput : public OneFileOutput<Real, EventFile> {
 public:
  EventsOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
               const RunContext<Real>& run)
      : OneFileOutput<Real, EventFile>(spec, folder, run,
                                       detail::event_columns(run.partners, spec.own_keys<StatesKey>().states),
                                       run.notes),
        states_(spec.own_keys<StatesKey>().states) {}

 protected:
  void record(const Seen<Real>& seen) override {
    const auto& f = seen.facts;
    const auto& o = seen.impact.outcome;
    file_.add(0, static_cast<std::int64_t>(f.index));
    file_.add(1, static_cast<double>(f.time));
    file_.add(2, std::int64_t{f.ball});
    file_.add(3, std::int64_t{f.partner});
    file_.add(4, std::int64_t{f.ball_ball ? 0 : 1});
    std::size_t column = 5;
    for (const Real* value : {&o.approach_speed, &o.slip_speed, &o.milling_dose, &o.wall_work})
      file_.add(column++, static_cast<double>(*value));
    if (states_) {
      add_body(column, f.one, seen.simulation.flight(f.ball).position);
      add_body(column, f.two, f.two.ball ? seen.simulation.flight(f.partner).position : f.contact_point);
    }
    file_.end_row();
  }

  void end_of_record(const engine::Simulation<Real>& simulation, const Real&) override {
    std::vector<double> places, velocities, spins, diameters, masses;
    for (int i = 0; i < simulation.ball_count(); ++i) {
      const auto state = simulation.state_at(i, simulation.now());
      for (int axis = 0; axis < 3; ++axis) {
        places.push_back(static_cast<double>(state.position[axis]));
        velocities.push_back(static_cast<double>(state.velocity[axis]));
        spins.push_back(static_cast<double>(state.spin[axis]));
      }
      diameters.push_back(static_cast<double>(2 * simulation.properties(i).radius));
      masses.push_back(static_cast<double>(simulation.properties(i).mass));
    }
    const std::string when = "of each ball at the end of the run, inertial frame";
    file_.add_table("final_time", "s", "end of the run", {static_cast<double>(simulation.seconds())}, 1);
    file_.add_table("final_position", "m", when, places, 3);
    file_.add_table("final_velocity", "m/s", when, velocities, 3);
    file_.add_table("final_spin", "rad/s", when, spins, 3);
    file_.add_table("ball_diameter", "m", "of each ball", diameters, 1);
    file_.add_table("ball_mass", "kg", "of each ball", masses, 1);
  }

 private:
  void add_body(std::size_t& column, const model::ImpactBody<Real>& body, const Vec3<Real>& place) {
    for (const Vec3<Real>* vector :
         {&place, &body.velocity_before, &body.spin_before, &body.velocity_after, &body.spin_after}) {
      for (int axis = 0; axis < 3; ++axis)
        file_.add(column, body.ball ? static_cast<double>((*vector)[axis])
                                    : std::numeric_limits<double>::quiet_NaN());
      ++column;
    }
  }

  using OneFileOutput<Real, EventFile>::file_;

  bool states_;
};

}  // namespace edmill::output
