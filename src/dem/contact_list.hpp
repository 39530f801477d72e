// Lists of contacts that a code has found by itself, with begin, end and velocities at both: Lethe's log of
// collisions with walls, or a table with its columns.
#pragma once

#include "dem/import_dump.hpp"

namespace edmill::dem {

/// Whether a file is one, by its header. A stream is none: it can be read once.
bool is_contact_list(const std::string& file);

/// Such a list has no places. Its contacts can be judged where the velocity of a wall and its normal are the
/// same at all places: flat walls that do not turn. The log has no frames, and no contacts between balls.
/// @throws InputError when it cannot be read, lacks what is needed, or the case has other walls
Imported import_contact_list(const casefile::CaseSpec& spec, const ImportOptions& options,
                             ContactLogWriter& log);

}  // namespace edmill::dem
