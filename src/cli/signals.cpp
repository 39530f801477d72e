#include "cli/signals.hpp"

#include <csignal>
#include <cstdlib>

#include "cli/run_case.hpp"

namespace edmill::cli {

namespace {

std::atomic<bool> flag{false};
volatile std::sig_atomic_t received = 0;

extern "C" void on_signal(int signal) {
  if (received) std::_Exit(128 + signal);
  received = signal;
  flag.store(true, std::memory_order_relaxed);
}

}  // namespace

std::atomic<bool>& interrupt_flag() { return flag; }

void listen_for_signals() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

int with_signal(int exit_code) { return exit_code == interrupted ? exit_code + received : exit_code; }

int after_signals(int exit_code) { return received ? interrupted + received : exit_code; }

}  // namespace edmill::cli
