// A list of contacts with walls becomes a log of contacts.
#pragma once

#include "dem/import_dump.hpp"

namespace edmill::dem {

/// Such a list has no places. Its contacts can be judged where the velocity of a wall and its normal are the
/// same at all places: flat walls that do not turn. The log has no frames, and no contacts between balls.
/// @throws InputError when it cannot be read, lacks what is needed, or the case has other walls
Imported import_contact_list(const casefile::CaseSpec& spec, const ImportOptions& options,
                             ContactLogWriter& log);

}  // namespace edmill::dem
