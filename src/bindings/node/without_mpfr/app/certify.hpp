// The declarations of app/certify.hpp that the commands need, for builds without MPFR and Arb. The functions
// report what is missing.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "casefile/case_spec.hpp"

namespace edmill::app {

struct Evidence {
  double seconds = 0;
  std::string text() const { return {}; }
};
struct CertifyOptions {
  std::string file;
  std::size_t collisions = 0;
  int digits = 25;
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(const std::string& precision, std::size_t events)> progress;
  std::function<void(const Evidence&)> found;
};
struct Certification {
  std::string undecided;
  bool interrupted = false;
};
Certification certify(const casefile::CaseSpec& spec, const CertifyOptions& options);

struct Shadow : Evidence {
  bool interrupted = false;
};
void require_wider(const std::string& precision, const std::string& wider, const std::string& what);
Shadow shadow(const casefile::CaseSpec& spec, const std::string& precision, const std::string& wider,
              const std::atomic<bool>* interrupt);

struct DigitsOptions {
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(const std::string& precision, std::size_t events, double expected)> progress;
};
struct FoundDigits : Evidence {
  std::string precision, undecided;
  bool interrupted = false;
  std::uint64_t right() const { return 0; }
};
FoundDigits find_digits(const casefile::CaseSpec& spec, const DigitsOptions& options);
FoundDigits estimate_run(const casefile::CaseSpec& spec, const std::string& precision,
                         const DigitsOptions& options);

struct ProveOptions {
  std::string file, certificate;
  std::size_t collisions = 0;
  long most_bits = 16384;
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(long bits, std::size_t events)> progress;
};
struct Proof {
  struct Attempt {
    long bits;
    std::size_t events;
    std::string undecided;
  };
  std::vector<Attempt> attempts;
  std::vector<int> events;
  std::string impossible;
  long bits = 0, accuracy = 0;
  double seconds = 0;
  bool interrupted = false;
};
Proof prove(const casefile::CaseSpec& spec, const ProveOptions& options);
std::size_t right_events(const std::string& precision, const casefile::CaseSpec& spec, const Proof& proof);
std::vector<std::string> check_certificate(const casefile::CaseSpec& spec, const std::string& certificate);

}  // namespace edmill::app
