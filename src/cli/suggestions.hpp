// What mistyped commands and options were meant to be.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace edmill::cli {

/// What is wrong with the words of a command line that could not be read: an unknown command or option with
/// the nearest that there is, else what the parser says.
std::string problem_of(const CLI::App& app, const std::vector<std::string>& words,
                       const CLI::ParseError& error);

}  // namespace edmill::cli
