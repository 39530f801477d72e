// Rules 2, 4 and 5: an event happens, and no other. docs/certificates.md, "What a checker verifies"
#pragma once

#include <string>

#include "motion.hpp"

namespace checker {

// The functions here throw Violation where the rule is not proven to hold.

/// Rule 2: the event happens. The gap of the two bodies has one root in this bracket, where it
/// falls.
void require_contact(const Motion& motion, const Contact& contact, const Real& bracket);

/// Rule 4: no other wall. The ball does not meet this wall on its flight up to a time.
/// @param windows  the text of the file, as "r2p2p1"
/// @param at_end   whether the flight ends with an impact on this wall
/// @throws std::invalid_argument for a depth that is no number
void require_no_wall(const Motion& motion, Index ball, Index wall, const std::string& windows,
    const Real& until, bool at_end);

/// Rule 5: no other pair. Two balls do not meet from the later start of their flights up to a time.
void require_no_pair(const Motion& motion, Index i, Index j, const Real& until);

}  // namespace checker
