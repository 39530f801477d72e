// Lists of contacts that a code has found by itself, with begin, end and velocities at both: Lethe's log of
// collisions with walls, or a table with its columns.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/ball.hpp"

namespace edmill::dem {

/// Whether a file is one, by its header. A stream is none: it can be read once.
bool is_contact_list(const std::string& file);

/// A contact of a ball with a wall, in SI. The states have no places.
struct ListedContact {
  int ball = 0, boundary = 0;  ///< numbers of the file
  double begin = 0, end = 0;
  model::BallState<double> before, after;
  std::optional<double> mass, diameter;
};

/// By the end of the contacts. @throws InputError with the bad lines
std::vector<ListedContact> read_contact_list(const std::string& file);

}  // namespace edmill::dem
