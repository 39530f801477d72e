#include "cli/exit_codes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <new>

#include "base/errors.hpp"
#include "casefile/case_spec.hpp"
#include "io/atomic_file.hpp"
#include "io/input_file.hpp"
#include "io/terminal.hpp"
#ifndef EDMILL_WITHOUT_MPFR
#include <gmp.h>
#endif

namespace edmill::cli {

namespace {

int failed(const std::string& problem, int code = internal_error) {
  print_problem(problem);
  return code;
}

std::atomic<bool> flag{false};
volatile std::sig_atomic_t received = 0, asked = 0;
bool pipes_end_us = true;

/// Sets the flag. The program ends at once only at a second SIGINT or SIGTERM, since a batch system
/// may repeat SIGXCPU, or send SIGTERM after it, while results are being written.
extern "C" void on_signal(int signal) {
  if (signal == SIGINT || signal == SIGTERM) {
    if (asked) std::_Exit(128 + signal);
    asked = 1;
  }
  if (!received) received = signal;
  flag.store(true, std::memory_order_relaxed);
}

bool is_ignored(int signal) {
  struct sigaction now {};
  return sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

/// True if SIGHUP was ignored at the start. This is recorded before libraries are initialised,
/// because some of them handle signals before `main`, such as UCX in Debian 13's MPI.
bool hangup_is_ignored = false;
#ifdef __ELF__
void note_hangup(int, char**, char**) { hangup_is_ignored = is_ignored(SIGHUP); }
[[gnu::section(".preinit_array"), gnu::used]] void (*const before_libraries)(
    int, char**, char**) = note_hangup;
#endif

/// From here on GMP throws `std::bad_alloc` when there is no memory, instead of ending the program.
/// Its functions are those of the whole process: the program may set them, the library may not.
void throw_for_lack_of_memory() {
#ifndef EDMILL_WITHOUT_MPFR
  static const auto or_throw = [](void* memory) {
    return memory ? memory : throw std::bad_alloc();
  };
  mp_set_memory_functions([](std::size_t size) { return or_throw(std::malloc(size)); },
      [](void* old, std::size_t, std::size_t size) { return or_throw(std::realloc(old, size)); },
      [](void* memory, std::size_t) { std::free(memory); });
#endif
}

/// Grows the stack to its final size: where it cannot grow later, a program ends without a message.
[[gnu::noinline]] void grow_stack() {
  std::array<volatile char, 1 << 20> room;
  const std::vector<char> as_much(2 * room.size());  // throws where the stack would end the program
  for (std::size_t k = room.size(); k >= 4096; k -= 4096) room[k - 1] = as_much[k];
}

/// Opens closed standard descriptors on /dev/null, so that no file gets their numbers.
void open_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    // The other way round, so that reading or writing fails; the lowest free number is this one.
    if (::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0) return;
  }
}

/// Lets a write to a file that is too large, or to a pipe that nobody reads, fail instead of
/// killing the program. A SIGHUP that was ignored at the start, as by nohup, stays ignored.
void begin_with_signals() {
  if (hangup_is_ignored) std::signal(SIGHUP, SIG_IGN);
  pipes_end_us = !is_ignored(SIGPIPE);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

/// Ends the program by SIGPIPE, as other programs end if nobody reads their pipe; returns if that
/// signal was ignored at the start.
void end_by_pipe_signal() {
  if (!pipes_end_us) return;
  std::signal(SIGPIPE, SIG_DFL);
  std::raise(SIGPIPE);
}

/// Whether all of standard output was written. When not, one message says why, unless its reader
/// did not want more, which ends the program by SIGPIPE.
/// @param code  of the command @return the exit code
int after_output(int code) {
  const int error = io::output_error();
  // These commands have reported their error.
  if (error == 0 || code == internal_error || code == bad_input || code == undecided) return code;
  if (error == EPIPE) end_by_pipe_signal();
  io::tell("edmill: standard output could not be written: {}\n",
      error == EBADF       ? "it is closed"
          : error == EFBIG ? "file size limit (ulimit -f)"
                           : std::strerror(error));
  return internal_error;
}

/// Runs a command, and prints the errors that it throws. @return the exit code
int exit_code_of(const std::function<int()>& command) try {
  return command();
} catch (const InputError& error) {
  for (const auto& problem : error.problems()) print_problem(problem);
  return bad_input;
} catch (const InterruptedError& error) {
  return after_signals(failed(error.what(), interrupted));
} catch (const UndecidedError& error) {
  return failed(error.what(), undecided);
} catch (const io::PipeClosed& error) {
  end_by_pipe_signal();
  return failed(error.what());
} catch (const casefile::OutOfMemory& error) {
  return failed(error.what());
} catch (const std::bad_alloc&) {
  return failed("not enough memory");
} catch (const std::length_error&) {
  return failed("not enough memory");
} catch (const std::exception& error) {
  return failed(error.what());
}

}  // namespace

void print_problem(const std::string& problem) {
  std::string line;
  for (const char c : problem)
    line += std::iscntrl(static_cast<unsigned char>(c))
        ? fmt::format("\\x{:02x}", static_cast<unsigned char>(c))
        : std::string(1, c);
  io::tell("edmill: {}\n", line);
}

int tell_undecided(const std::string& why) {
  io::tell("edmill: {}; nothing is written\n", why);
  return undecided;
}

int as_program(const std::function<int()>& command) {
  throw_for_lack_of_memory();
  open_standard_descriptors();
  begin_with_signals();
  return after_output(exit_code_of([&] {
    grow_stack();
    return command();
  }));
}

std::atomic<bool>& interrupt_flag() { return flag; }

void listen_for_signals() {
  io::end_waits_by(flag);
  for (const int signal : {SIGINT, SIGTERM, SIGXCPU, SIGUSR1}) std::signal(signal, on_signal);
  if (!hangup_is_ignored) std::signal(SIGHUP, on_signal);
}

int plus_signal(int exit_code) {
  return exit_code == interrupted ? exit_code + received : exit_code;
}

int after_signals(int exit_code) { return received ? interrupted + received : exit_code; }

}  // namespace edmill::cli
