// The command `edmill variables`.
#pragma once

#include <string>

namespace edmill::cli {

/// All variables that outputs can contain, as Markdown tables; docs/variables.md contains them.
std::string list_variables();

}  // namespace edmill::cli
