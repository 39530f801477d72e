// What becomes of errors: a message on standard error, and an exit code.
#pragma once

#include <functional>
#include <string>

namespace edmill::cli {

/// In one line; control characters are escaped.
void print_problem(const std::string& problem);

/// Does a command, and prints what it throws. @return the exit code
int exit_code_of(const std::function<int()>& command);

}  // namespace edmill::cli
