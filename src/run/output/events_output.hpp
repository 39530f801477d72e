// The log of all impacts: as text, and as HDF5 for long runs. docs/files.md
#pragma once

#include <limits>

#include "casefile/section.hpp"
#include "io/atomic_file.hpp"
#include "output/collision_log.hpp"
#include "output/event_file.hpp"
#include "output/output.hpp"

namespace edmill::output {

/// The key that adds the bodies' states before and after each impact to a log.
struct StatesKey {
  bool states = false;

  static void keys(auto& k, auto&& row) {
    row({"states", "also the positions and velocities before and after each impact", Range::any,
            "false"},
        k.states);
  }
};

struct CollisionsKeys : OwnKeys<StatesKey> {
  static void check(Section& s, const CaseSpec&, OutputSpec& output) {
    s.require(!output.hdf5(), "file", "a name ending in .csv; `events` is the log as HDF5");
  }
};

/// Text alone, line by line: the log as HDF5 is another type, `events`.
template <class Real> class CollisionsOutput : public OneFileOutput<Real, io::AtomicFile> {
 public:
  CollisionsOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : OneFileOutput<Real, io::AtomicFile>(spec, run, spec.append),
        states_(spec.own_keys<StatesKey>().states) {
    this->file_.stream() << collision_log_header(states_) << '\n';
  }
 protected:
  void record(const ImpactFacts<Real>& f) override {
    this->file_.stream() << collision_line<Real>(f.impact, f.simulation, states_) << '\n';
  }
 private:
  bool states_;
};

inline std::vector<EventColumn> event_columns(const model::Partners& partners, bool states) {
  using Type = EventColumn::Type;
  std::string walls;
  for (int wall = 0; wall < partners.walls(); ++wall)
    walls += (wall == 0 ? "" : ", ") + std::to_string(wall) + " " + partners[wall].label;
  std::vector<EventColumn> columns{
      {"index", "1", "impacts since the start of the run, from 0", Type::integer},
      {"ball", "1", "id of the ball, from 0", Type::integer},
      {"partner", "1", "id of the other ball, or of the wall: " + walls, Type::integer},
      {"with_wall", "1", "1 when the partner is a wall", Type::integer}};
  for (const auto& q : model::logged_quantities) {
    const auto place = q.name == "time" ? columns.begin() + 1 : columns.end();
    columns.insert(
        place, {std::string(q.name), std::string(q.unit), std::string(q.meaning), Type::number});
  }
  if (states)
    for (const std::string body : {"ball", "partner"})
      for (const auto& v : model::logged_vectors)
        columns.push_back({body + "_" + std::string(v.name), std::string(v.unit),
            "inertial frame; nan for a wall", Type::vector});
  return columns;
}

/// NAME.h5: /events with a dataset for each column, so that a reader takes only those it needs, and
/// datasets with the balls and their final state. Numbers are 64-bit for every scalar: the digits
/// of a wide run are in the CSV.
template <class Real> class EventsOutput : public OneFileOutput<Real, EventFile> {
 public:
  EventsOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : OneFileOutput<Real, EventFile>(
            spec, run, event_columns(run.partners, spec.own_keys<StatesKey>().states), run.notes),
        states_(spec.own_keys<StatesKey>().states) {}
 protected:
  void record(const ImpactFacts<Real>& f) override {
    const auto record = record_of<Real>(f.impact, f.simulation);
    file_.add(0, static_cast<std::int64_t>(f.impact.index));
    file_.add(1, static_cast<double>(record.time));
    file_.add(2, std::int64_t{f.impact.ball});
    file_.add(3, std::int64_t{f.impact.partner});
    file_.add(4, std::int64_t{f.impact.with_wall ? 1 : 0});
    std::size_t column = 5;
    for (std::size_t k = model::approach_speed; k < model::logged_count; ++k)
      file_.add(column++, static_cast<double>(record[k]));
    if (states_) {
      add_body(column, f.one, f.simulation.flight(f.impact.ball).position);
      add_body(column, f.two,
          f.two.ball ? f.simulation.flight(f.impact.partner).position : f.contact_point);
    }
    file_.end_row();
  }

  void end_of_record(const Simulation<Real>& simulation, const Real&) override {
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
    file_.add_table(
        "final_time", "s", "end of the run", {static_cast<double>(simulation.seconds())}, 1);
    file_.add_table("final_position", "m", when, places, 3);
    file_.add_table("final_velocity", "m/s", when, velocities, 3);
    file_.add_table("final_spin", "rad/s", when, spins, 3);
    file_.add_table("ball_diameter", "m", "of each ball", diameters, 1);
    file_.add_table("ball_mass", "kg", "of each ball", masses, 1);
  }
 private:
  void add_body(std::size_t& column, const ImpactBody<Real>& body, const Vec3<Real>& place) {
    for (const Vec3<Real>* vector : {&place, &body.velocity_before, &body.spin_before,
             &body.velocity_after, &body.spin_after}) {
      for (int axis = 0; axis < 3; ++axis)
        file_.add(column,
            body.ball ? static_cast<double>((*vector)[axis])
                      : std::numeric_limits<double>::quiet_NaN());
      ++column;
    }
  }

  using OneFileOutput<Real, EventFile>::file_;

  bool states_;
};

}  // namespace edmill::output
