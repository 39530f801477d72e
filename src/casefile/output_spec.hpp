// Reading of entries [[output]].
#pragma once

#include "section.hpp"

namespace edmill::casefile {

/// Reads one entry and adds it to the case.
void read_output(Section entry, CaseSpec& spec);

}  // namespace edmill::casefile
