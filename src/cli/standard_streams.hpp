// Standard input, output and error as the program finds and leaves them.
#pragma once

namespace edmill::cli {

/// At the start: a standard descriptor that is closed is opened on /dev/null, so that no file gets its
/// number. Using it fails all the same.
void open_standard_descriptors();

/// At the end: whether all of standard output was written. When not, one message says why, unless its reader
/// did not want more, which ends the program by SIGPIPE.
/// @param code  of the command
/// @return the exit code
int after_output(int code);

}  // namespace edmill::cli
