// Signals that end long work: it stops at its next event, with its results so far on disk.
#pragma once

#include <atomic>

namespace edmill::cli {

/// At the start of the program: a write to a file that is too large, or to a pipe that nobody reads, fails in
/// place of killing; a SIGHUP that the program was started with ignored, as by nohup, stays so, whatever
/// libraries do.
void begin_with_signals();
/// Ends the program as a pipe that nobody reads ends others; returns if it was ignored at the start.
void end_by_pipe_signal();

/// Becomes true at the first signal after `listen_for_signals`, or when another rank has seen one; a second
/// SIGINT or SIGTERM ends the program at once.
std::atomic<bool>& interrupt_flag();

/// SIGINT, SIGTERM, SIGHUP, SIGXCPU and SIGUSR1; before it is called they end the program. A SIGHUP that is
/// ignored, as with nohup, stays so.
void listen_for_signals();

/// 128 and the signal for `interrupted`, any other code as it is.
int with_signal(int exit_code);

/// 128 and the signal when one came, whatever the code.
int after_signals(int exit_code);

}  // namespace edmill::cli
