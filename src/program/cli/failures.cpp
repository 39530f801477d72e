#include "cli/failures.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmp.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <new>

#include "base/errors.hpp"
#include "casefile/memory_for.hpp"
#include "cli/exit_codes.hpp"
#include "cli/signals.hpp"
#include "io/destination.hpp"
#include "io/terminal.hpp"

namespace edmill::cli {

namespace {

int failed(const std::string& problem, int code = internal_error) {
  print_problem(problem);
  return code;
}

void* or_throw(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void throw_for_lack_of_memory() {
  mp_set_memory_functions(
      [](std::size_t size) { return or_throw(std::malloc(size)); },
      [](void* old, std::size_t, std::size_t size) { return or_throw(std::realloc(old, size)); },
      [](void* memory, std::size_t) { std::free(memory); });
}

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

int exit_code_of(const std::function<int()>& command) {
  const std::string no_memory = "found too little memory, expected more";
  try {
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
    return failed(no_memory);
  } catch (const std::length_error&) {
    return failed(no_memory);
  } catch (const std::exception& error) {
    return failed(error.what());
  }
}

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
