// Joints of a chain as a case file says them.
#pragma once

#include <string>

#include "casefile/quantity.hpp"
#include "model/motions/joints.hpp"

namespace edmill::casefile {

class Section;
/// [[mill.joint]]; what is wrong is reported.
model::Joints<Quantity> read_joints(Section& mill);

/// "turn about y at 300 rpm, shift by (0.15, 0, 0) m, turn about y at -600 rpm".
std::string equation_of(const model::Joints<Quantity>& joints);

}  // namespace edmill::casefile
