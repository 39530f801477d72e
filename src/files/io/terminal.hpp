// All text for standard output and standard error.
#pragma once

#include <fmt/format.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <string_view>

namespace edmill::io {

inline std::atomic<int> first_error = 0;  ///< errno; 0 when everything was written

inline void note_error() {
  int none = 0;
  first_error.compare_exchange_strong(none, errno != 0 ? errno : EIO);
}

/// Text for standard output. A failure does not end the work; `output_error` reports it at the end.
inline void print_text(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) note_error();
}
/// Prints to standard error. Failures are ignored, so that an error keeps its exit code.
inline void tell_text(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

template <class... T> void print(fmt::format_string<T...> format, T&&... values) {
  print_text(fmt::format(format, std::forward<T>(values)...));
}
template <class... T> void tell(fmt::format_string<T...> format, T&&... values) {
  tell_text(fmt::format(format, std::forward<T>(values)...));
}

/// Flushes standard output. @return errno of its first failure; 0 when everything was written
inline int output_error() {
  errno = 0;
  if (std::fflush(stdout) != 0) note_error();
  return first_error;
}

}  // namespace edmill::io
