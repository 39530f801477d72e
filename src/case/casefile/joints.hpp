// Joints of a chain as a case file says them.
#pragma once

#include <string>
#include <vector>

#include "casefile/quantity.hpp"
#include "model/motion.hpp"

namespace edmill::casefile {

class Section;
/// [[mill.joint]]; what is wrong is reported.
model::Joints<Quantity> read_joints(Section& mill);
/// Reports translations at constant speed, which only the end of a run bounds.
void require_end(Section& mill);

/// [[...swing]] of a joint or a piston; what is wrong is reported.
std::vector<model::Swing<Quantity>> read_swings(Section& section, bool rotates);
/// Reports speeds that a file could not give.
void check_swings(Section& section, const std::vector<model::Swing<Quantity>>& swings);
/// " + 0.01 m sin(2 pi 5 t)" for each.
std::string equation_of(const std::vector<model::Swing<Quantity>>& swings, bool rotate);
/// The swings with what each turns in a drive period, exactly.
std::vector<model::Swing<Quantity>> with_phases(std::vector<model::Swing<Quantity>> swings,
                                                const Quantity& period);

/// "turn about y at 300 rpm, shift by (0.15, 0, 0) m, turn about y at -600 rpm".
std::string equation_of(const model::Joints<Quantity>& joints);

}  // namespace edmill::casefile
