// The states from which the plain programs start: `final_state.csv` of `edmill run`.
#pragma once

#include <istream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "vectors.hpp"

template <class T> struct State {
  Vec<T> position, velocity, spin;
  T time;
};

// Throws std::runtime_error where a line has fewer than eleven cells.
template <class T> std::vector<State<T>> read_states(std::istream& in) {
  std::vector<State<T>> states;
  std::string line, cell;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::vector<T> c;
    for (std::istringstream row(line); std::getline(row, cell, ',');) c.push_back(T(cell));
    if (c.size() < 11) throw std::runtime_error("short line in the states");
    states.push_back({{c[1], c[2], c[3]}, {c[4], c[5], c[6]}, {c[7], c[8], c[9]}, c[10]});
  }
  return states;
}
