// A case as the input of a DEM code that runs as it is. docs/dem.md
#pragma once

#include <array>
#include <string>
#include <vector>

#include "casefile/build_case.hpp"

namespace edmill::dem {

struct DeckOptions {
  std::string code;             ///< one of deck_codes
  std::string name = "deck";    ///< of the files, without extension
  double contact_time = 50e-6;  ///< of the largest ball on a wall [s]
  double speed = 1;             ///< at which it lasts so long [m/s]
  double duration = 0;          ///< simulated [s]; 0 for that of the case
  double frame_interval = 0;    ///< between frames of the dump [s]; 0 for a fifth of the contact time
  int steps = 50;               ///< of time in a contact
  int facets = 0;  ///< of a round wall where the code has triangles alone; 0 for 128 in LIGGGHTS, 24 in YADE
};

inline constexpr std::array<const char*, 3> deck_codes{"lammps", "liggghts", "yade"};

struct DeckFile {
  std::string name, text;
};

struct Deck {
  std::vector<DeckFile> files;  ///< the first is the one to run
  std::string command;          ///< that runs it
  std::vector<std::string> notes;
};

/// @throws InputError for what a code cannot express, with the reason
Deck make_deck(const casefile::CaseSpec& spec, const DeckOptions& options);

/// A law of contacts as a DEM code has it.
struct SoftLaw {
  double restitution, friction;
  double damping;  ///< soft_contact.hpp
};

inline const double turn = 2 * numerics::pi<double>();  ///< [rad]

/// What all decks are written from; SI.
struct DeckCase {
  std::string file, digest;  ///< of the case
  std::vector<model::BallProperties<double>> balls;
  std::vector<model::BallState<double>> states;  ///< inertial
  SoftLaw of_balls, of_walls;
  model::Mill<double> mill;
  model::Joints<double> joints;  ///< of the vessel
  double begin, period;          ///< time of the states, period of the drive [s]
  model::AnyPose<double> pose;   ///< of the vessel at the begin
  double young, time_step;       ///< [Pa], [s]
  long steps, frame_every;       ///< of the run; between frames
  double largest_radius;

  static constexpr double poisson = 0.3;
  double density(std::size_t ball) const;
  /// No joint turns: the vessel translates, or stands still.
  bool translates() const;
};

/// The first lines of every deck, comments: of which case it is, and with which contacts.
std::string header_of(const DeckCase& c, const DeckOptions& options);

/// Gravity as a command of LAMMPS and LIGGGHTS; empty where there is none.
std::string weight_of(const DeckCase& c);
// One file each.
Deck lammps_deck(const DeckCase& c, const DeckOptions& options);
Deck liggghts_deck(const DeckCase& c, const DeckOptions& options);
Deck yade_deck(const DeckCase& c, const DeckOptions& options);

/// The pose of the vessel as a function in Python: defines pose(t): orientation, centre, angular velocity and
/// its rate, velocity and acceleration of the centre, all along inertial axes. Needs `import numpy as np`.
std::string pose_in_python(const DeckCase& c);

/// [0.003 * sin(62.8 * t + 0.5)]: the displacement of all translations along each axis at the time `t`, as
/// LAMMPS, LIGGGHTS and Python write formulas. @pre c.translates()
std::array<std::string, 3> displacement_formulas(const DeckCase& c, const std::string& time);

/// Unit; zero for a joint without one.
std::array<double, 3> axis_of(const model::Joint<double>& joint);

}  // namespace edmill::dem
