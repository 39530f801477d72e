// What becomes of errors, and of standard streams that fail: a message on standard error, and an exit code.
#pragma once

#include <functional>
#include <string>

namespace edmill::cli {

/// GMP ends the program when there is no memory; from here on it throws `std::bad_alloc`. Its functions are
/// those of the whole process, so that the program may set them and the library may not.
void throw_for_lack_of_memory();

/// In one line; control characters are escaped.
void print_problem(const std::string& problem);

/// Says why a command has no result. @return the exit code
int tell_undecided(const std::string& why);

/// Does a command, and prints what it throws. @return the exit code
int exit_code_of(const std::function<int()>& command);

/// At the start: a standard descriptor that is closed is opened on /dev/null, so that no file gets its
/// number. Using it fails all the same.
void open_standard_descriptors();

/// At the end: whether all of standard output was written. When not, one message says why, unless its reader
/// did not want more, which ends the program by SIGPIPE.
/// @param code  of the command
/// @return the exit code
int after_output(int code);

}  // namespace edmill::cli
