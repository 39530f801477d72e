// The room that bodies inside the vessel leave to the balls.
#pragma once

#include <string>
#include <vector>

#include "casefile/case_spec.hpp"
#include "model/mill.hpp"

namespace edmill::casefile {

/// Volume of the vessel outside of the bodies at an instant [m3], by 20 000 points, to about 1 %.
double free_volume(const model::Mill<double>& mill, const Instant<double>& when);

/// Where a moving body comes so near to a wall or a body that no ball passes between them.
struct NarrowGap {
  std::string one, other;
  double width;  ///< the least [m]; 0 if they touch
  double time;   ///< of it [s]
};
/// All such places in a cycle of the slowest joint, or up to the end of the run. Between two times
/// a gap cannot change faster than both move, so that no passage is missed. Bodies that are joined,
/// or do not move against each other, are left out.
std::vector<NarrowGap> narrow_gaps(const CaseSpec& spec, const model::Mill<double>& mill);

}  // namespace edmill::casefile
