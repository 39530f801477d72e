#include "cli/standard_streams.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "cli/exit_codes.hpp"
#include "cli/signals.hpp"
#include "io/terminal.hpp"

namespace edmill::cli {

void open_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    // The other way round, so that reading or writing fails; the lowest free number is this one.
    if (::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0) return;
  }
}

int after_output(int code) {
  const int error = io::output_error();
  // These have said what is wrong.
  if (error == 0 || code == internal_error || code == bad_input || code == undecided) return code;
  if (error == EPIPE) end_by_pipe_signal();
  io::tell("edmill: standard output could not be written: {}\n", error == EBADF ? "it is closed"
                                                                 : error == EFBIG
                                                                     ? "file size limit (ulimit -f)"
                                                                     : std::strerror(error));
  return internal_error;
}

}  // namespace edmill::cli
