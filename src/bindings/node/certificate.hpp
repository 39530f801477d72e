// Checks a certificate by verification/checker, which has no code of edmill.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "base/errors.hpp"
#include "check.hpp"
#include "cli/exit_codes.hpp"
#include "io/input_file.hpp"
#include "io/terminal.hpp"

namespace edmill::cli {

struct Certificate {
  static constexpr const char* name = "certificate";
  static constexpr const char* what = "check a certificate of proven events, without trusting edmill";

  void add_options(CLI::App& command) {
    command.add_option("file", file_, "certificate (JSON lines)")->required();
    command.add_flag("--quiet", quiet_, "print nothing");
  }
  int run() {
    io::InputFile in(file_, "a certificate");
    try {
      const auto verdict = checker::check(in);
      if (!quiet_) io::print("{}\n", verdict);
      return ok;
    } catch (const checker::Rejected& why) {
      if (!quiet_) io::print("rejected: {}\n", why.what());
      return outputs_differ;
    } catch (const InputError&) {
      throw;
    } catch (const std::exception&) {
      throw InputError(file_ + ": this file is not a certificate of `edmill prove --certificate`");
    }
  }

 private:
  std::string file_;
  bool quiet_ = false;
};

}  // namespace edmill::cli
