// The pose of a vessel as a function in Python, for decks that call it.
#pragma once

#include <string>

#include "dem/deck.hpp"

namespace edmill::dem {

/// Defines pose(t): orientation, centre, angular velocity and its rate, velocity and acceleration of the
/// centre, all along inertial axes. Needs `import numpy as np`.
std::string pose_in_python(const DeckCase& c);

}  // namespace edmill::dem
