// The commands that print the command line in other forms.
#pragma once

#include "base/version.hpp"
#include "cli/command_texts.hpp"
#include "cli/reference.hpp"
#include "io/terminal.hpp"

namespace edmill::cli {

inline std::string manual_text(const CLI::App& app) { return man_page(app, version()); }

/// @tparam text  of the whole command line
template <std::string (*text)(const CLI::App&)>
struct Text {
  void add_options(CLI::App& command) { program_ = command.get_parent(); }
  int run() {
    io::print("{}", text(*program_));
    return ok;
  }

 private:
  const CLI::App* program_ = nullptr;
};

struct Manual : Text<manual_text> {
  static constexpr const char* name = "manual";
  static constexpr const char* what = "print the manual page, edmill(1), for man";
};
struct Reference : Text<reference> {
  static constexpr const char* name = "reference";
  static constexpr const char* what =
      "print the reference of commands, exit codes, keys of files and outputs, as Markdown";
};
struct Completion : Text<bash_completion> {
  static constexpr const char* name = "completion";
  static constexpr const char* what = "print the completion of these commands for bash";
};

}  // namespace edmill::cli
