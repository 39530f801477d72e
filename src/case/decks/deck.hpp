// Writes a case as ready-to-run input of a DEM code. docs/dem.md
#pragma once

#include <array>
#include <string>
#include <vector>

#include "casefile/case_spec.hpp"

namespace edmill::decks {

struct DeckOptions {
  std::string code;             ///< one of deck_codes
  std::string name = "deck";    ///< of the files, without extension
  double contact_time = 50e-6;  ///< of the largest ball on a wall [s]
  double speed = 1;             ///< approach speed of that contact [m/s]
  double duration = 0;          ///< simulated [s]; 0 for that of the case
  double frame_interval = 0;  ///< between frames of the dump [s]; 0 for a fifth of the contact time
  int steps = 50;             ///< time steps during a contact
  int facets =
      0;  ///< of a round wall in codes that have only triangles; 0: 128 in LIGGGHTS, 24 in YADE
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

}  // namespace edmill::decks
