// All text for standard output and standard error.
#pragma once

#include <fmt/format.h>

#include <string_view>

namespace edmill::io {

/// Text for standard output. A failure is remembered and does not end the work whose results are on disk:
/// `output_error` tells of it at the end.
void print_text(std::string_view text);
/// Text for standard error. What cannot be written is lost: an error keeps its exit code.
void tell_text(std::string_view text);

template <class... T>
void print(fmt::format_string<T...> format, T&&... values) {
  print_text(fmt::format(format, std::forward<T>(values)...));
}
template <class... T>
void tell(fmt::format_string<T...> format, T&&... values) {
  tell_text(fmt::format(format, std::forward<T>(values)...));
}

/// Writes what is left of standard output. @return errno of its first failure; 0 when everything was written
int output_error();

}  // namespace edmill::io
