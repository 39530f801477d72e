// final_state.csv: the state of every ball at the end of a run, from which another can start.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "base/instant.hpp"
#include "model/ball.hpp"

namespace edmill::io {

template <class Real>
struct SavedState {
  Instant<Real> time;
  std::vector<model::BallState<Real>> states;
};

/// Columns: ball, position [m], velocity [m/s], spin [rad/s], and the instant: time [s] for reading,
/// drive_period and drive_offset [s] for an exact restart. Every number has enough digits to round-trip.
template <class Real>
void write_final_state(std::ostream& out, const SavedState<Real>& saved, const DriveClock<Real>& clock);

/// @throws InputError naming file and line of what deviates from this format
template <class Real>
SavedState<Real> read_final_state(const std::string& path);

}  // namespace edmill::io
