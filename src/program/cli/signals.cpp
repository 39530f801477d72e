#include "cli/signals.hpp"

#include <csignal>
#include <cstdlib>

#include "cli/exit_codes.hpp"
#include "io/input_file.hpp"

namespace edmill::cli {

namespace {

std::atomic<bool> flag{false};
volatile std::sig_atomic_t received = 0, asked = 0;
bool pipes_end_us = true;

/// A batch system repeats SIGXCPU, or follows with SIGTERM, while results are being written; only who asks
/// twice does not want them.
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

/// Libraries may take signals before `main`, as UCX does, which comes with Debian 13's MPI: what the program
/// was started with is noted before they are initialised.
bool hangup_is_ignored = false;
void note_hangup(int, char**, char**) { hangup_is_ignored = is_ignored(SIGHUP); }
[[gnu::section(".preinit_array"), gnu::used]] void (*const before_libraries)(int, char**,
                                                                             char**) = note_hangup;

}  // namespace

void begin_with_signals() {
  if (hangup_is_ignored) std::signal(SIGHUP, SIG_IGN);
  pipes_end_us = !is_ignored(SIGPIPE);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

void end_by_pipe_signal() {
  if (!pipes_end_us) return;
  std::signal(SIGPIPE, SIG_DFL);
  std::raise(SIGPIPE);
}

std::atomic<bool>& interrupt_flag() { return flag; }

void listen_for_signals() {
  io::end_waits_by(flag);
  for (const int signal : {SIGINT, SIGTERM, SIGXCPU, SIGUSR1}) std::signal(signal, on_signal);
  if (!hangup_is_ignored) std::signal(SIGHUP, on_signal);
}

int with_signal(int exit_code) { return exit_code == interrupted ? exit_code + received : exit_code; }

int after_signals(int exit_code) { return received ? interrupted + received : exit_code; }

}  // namespace edmill::cli
