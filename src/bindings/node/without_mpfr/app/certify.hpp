// The declarations of app/certify.hpp that the commands need, for builds without MPFR and Arb. The
// functions report what is missing, so that all options and all results are of one kind.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "casefile/case_spec.hpp"

namespace edmill::app {

/// A callback that is never called.
struct Uncalled {
  void operator=(const auto&) {}
};
struct Options {
  std::string file, certificate;
  std::size_t collisions = 0;
  int digits = 25;
  long most_bits = 16384;
  const std::atomic<bool>* interrupt = nullptr;
  Uncalled progress, found;
};
struct Evidence {
  std::string precision, undecided;
  double seconds = 0;
  bool interrupted = false;
  std::string text() const { return {}; }
  std::uint64_t right() const { return 0; }
};
struct Attempt {
  long bits;
  std::size_t events;
  std::string undecided;
};
struct Proof {
  std::vector<Attempt> attempts;
  std::vector<int> events;
  std::string impossible;
  long bits = 0, accuracy = 0;
  double seconds = 0;
  bool interrupted = false;
};
using CertifyOptions = Options;
using DigitsOptions = Options;
using ProveOptions = Options;

Evidence certify(const casefile::CaseSpec& spec, const Options& options);
void require_wider(const std::string& precision, const std::string& wider, const std::string& what);
Evidence shadow(const casefile::CaseSpec& spec, const std::string& precision,
    const std::string& wider, const std::atomic<bool>* interrupt);
Evidence find_digits(const casefile::CaseSpec& spec, const Options& options);
Evidence estimate_run(
    const casefile::CaseSpec& spec, const std::string& precision, const Options& options);
Proof prove(const casefile::CaseSpec& spec, const Options& options);
std::size_t right_events(
    const std::string& precision, const casefile::CaseSpec& spec, const Proof& proof);
std::vector<std::string> check_certificate(
    const casefile::CaseSpec& spec, const std::string& certificate);

}  // namespace edmill::app
