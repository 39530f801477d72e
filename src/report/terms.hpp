// The words of a page and what they mean.
#pragma once

#include "plot/markup.hpp"

namespace edmill::report {

/// Ends each section with a folded list of the terms that its text uses.
void add_terms(pugi::xml_node main);

}  // namespace edmill::report
