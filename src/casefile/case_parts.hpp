// Sections of a case file that have a source file of their own.
#pragma once

#include "casefile/case_spec.hpp"
#include "casefile/section.hpp"

namespace edmill::casefile {

inline constexpr std::uint64_t largest_count = 100000000;  ///< of balls

/// [contact], [contact.ball_ball] and [contact.ball_wall].
void read_contact(Section contact, CaseSpec& spec);
/// An entry [[ball]].
void read_ball(Section entry, CaseSpec& spec);
/// An entry [[balls]].
void read_batch(Section entry, CaseSpec& spec);

}  // namespace edmill::casefile
