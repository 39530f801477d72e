#include "io/terminal.hpp"

#include <atomic>
#include <cerrno>
#include <cstdio>

namespace edmill::io {

namespace {

std::atomic<int> first_error = 0;

void note_error() {
  int none = 0;
  first_error.compare_exchange_strong(none, errno != 0 ? errno : EIO);
}

}  // namespace

void print_text(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) note_error();
}

void tell_text(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

int output_error() {
  errno = 0;
  if (std::fflush(stdout) != 0) note_error();
  return first_error;
}

}  // namespace edmill::io
