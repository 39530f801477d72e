// What becomes of errors: a message on standard error, and an exit code.
#pragma once

#include <functional>
#include <string>

namespace edmill::cli {

/// In one line; control characters are escaped.
void print_problem(const std::string& problem);

/// Of a command. @return its exit code, or that of what it throws, which is told
int exit_code_of(const std::function<int()>& command);

}  // namespace edmill::cli
