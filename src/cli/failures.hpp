// What becomes of errors: a message on standard error, and an exit code.
#pragma once

#include <functional>
#include <string>

namespace edmill::cli {

/// GMP ends the program when there is no memory; from here on it throws `std::bad_alloc`. Its functions are
/// those of the whole process, so that the program may set them and the library may not.
void throw_for_lack_of_memory();

/// In one line; control characters are escaped.
void print_problem(const std::string& problem);

/// Does a command, and prints what it throws. @return the exit code
int exit_code_of(const std::function<int()>& command);

}  // namespace edmill::cli
