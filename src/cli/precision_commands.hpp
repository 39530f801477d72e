// The commands `edmill certify` and `edmill prove`, and `edmill run --shadow`: what is certain about a case.
#pragma once

#include <string>

#include "app/certify.hpp"
#include "app/prove.hpp"

namespace edmill::cli {

struct CertifyOptions : app::CertifyOptions {
  bool quiet = false;
};

/// @return an exit code; `undecided` when the widest two scalars do not agree
int run_certify(const casefile::CaseSpec& spec, CertifyOptions options);

/// @return an exit code; `interrupted` when it was
int run_shadow(const casefile::CaseSpec& spec, const std::string& precision, const std::string& shadow,
               const std::atomic<bool>* interrupt);

/// Prints what the run will take. @param precision  empty where the case asks for digits
/// @return an exit code
int run_estimate(const casefile::CaseSpec& spec, const std::string& precision, bool quiet);

/// Finds the precision of a case that asks for digits, and prints the evidence.
/// @return an exit code; `undecided` when no number of digits suffices
int choose_digits(casefile::CaseSpec& spec, bool quiet, std::string& precision);

struct ProveOptions : app::ProveOptions {
  bool compare = false;  ///< also print how many events each scalar gets right
  std::string checked;   ///< a certificate whose header is to be that of the case; else one is proven
  bool quiet = false;
};

/// @return an exit code; `undecided` when the model does not say what comes next, or bits do not suffice
int run_prove(const casefile::CaseSpec& spec, ProveOptions options);

}  // namespace edmill::cli
