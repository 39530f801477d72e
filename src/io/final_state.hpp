// final_state.csv: where every ball is at the end of a run; it can start another.
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
/// drive_period and drive_offset [s] for an exact restart. Every number in as many digits as round-trip.
template <class Real>
void write_final_state(std::ostream& out, const SavedState<Real>& saved, const DriveClock<Real>& clock);

/// @throws InputError naming file and line of what is not as written above
template <class Real>
SavedState<Real> read_final_state(const std::string& path);

}  // namespace edmill::io
