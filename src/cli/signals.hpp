// SIGINT and SIGTERM: long work stops at its next event, with its results so far on disk.
#pragma once

#include <atomic>

namespace edmill::cli {

/// Becomes true at the first signal after `listen_for_signals`, or when another rank has seen one; a second
/// signal ends the program at once.
std::atomic<bool>& interrupt_flag();

/// Before it is called a signal ends the program.
void listen_for_signals();

/// 128 and the signal for `interrupted`, any other code as it is.
int with_signal(int exit_code);

/// 128 and the signal when one came, whatever the code.
int after_signals(int exit_code);

}  // namespace edmill::cli
