// The command `edmill variables`.
#pragma once

#include <string>

namespace edmill::cli {

/// All variables that outputs can show, as Markdown tables; docs/variables.md is made of it.
std::string list_variables();

}  // namespace edmill::cli
