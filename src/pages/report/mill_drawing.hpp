// A mill's motion drawn as a picture.
#pragma once

#include <string>

#include "model/mill.hpp"

namespace edmill::report {

/// An SVG with three views, along z, x and y: the vessel at time 0 and at three later quarters of a period of
/// the clock, the path of its centre and of one of its points over the period, and the joints of a chain at
/// time 0: dashed axes of rotations, arms of translations, by number from the ground.
std::string mill_drawing(const model::Mill<double>& mill);

}  // namespace edmill::report
