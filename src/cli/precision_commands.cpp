#include "cli/precision_commands.hpp"

#include "app/digits.hpp"
#include "base/errors.hpp"
#include "casefile/memory_for.hpp"
#include "casefile/precisions.hpp"
#include "cli/exit_codes.hpp"
#include "cli/progress_line.hpp"
#include "cli/signals.hpp"
#include "io/terminal.hpp"

namespace edmill::cli {

namespace {

constexpr const char* no_line = "\r\x1b[K";

void print_attempts(const prove::Proof& proof) {
  for (const auto& attempt : proof.attempts)
    io::print("{} bits: {} events{}\n", attempt.bits, attempt.events,
              attempt.undecided.empty() ? "" : "; undecided: " + attempt.undecided);
}

/// For runs that write nothing.
app::DigitsOptions options_of_trials(bool quiet) {
  app::DigitsOptions options;
  options.interrupt = &interrupt_flag();
  listen_for_signals();
  if (shows_progress(quiet))
    options.progress = [](const std::string& precision, std::size_t events, double expected) {
      io::tell("{}{}: {} of about {:.0f} events ", no_line, precision, events, expected);
    };
  return options;
}

/// @return the exit code
int tell_undecided(const std::string& why) {
  io::tell("edmill: {}; nothing is written\n", why);
  return undecided;
}

/// Whether the certificate is one of this case.
int check_header(const casefile::CaseSpec& spec, const ProveOptions& options) {
  const auto differences = app::check_certificate(spec, options.checked);
  for (const auto& line : differences) io::print("{}\n", line);
  if (!options.quiet && differences.empty())
    io::print("{} is of the case {}; check_certificate says whether its events are proven\n", options.checked,
              spec.file);
  if (!options.quiet && !differences.empty())
    io::print("{} is of another case than {}\n", options.checked, spec.file);
  return differences.empty() ? ok : outputs_differ;
}

}  // namespace

int run_certify(const casefile::CaseSpec& spec, CertifyOptions options) {
  const bool show = shows_progress(options.quiet);
  if (show)
    options.progress = [&](const std::string& precision, std::size_t events) {
      const auto all = options.collisions == 0 ? "" : fmt::format(" of {}", options.collisions);
      io::tell("{}{}: {}{} events ", no_line, precision, events, all);
    };
  const auto result = app::certify(spec, options, [&](const app::Evidence& evidence) {
    if (show) io::tell("{}", no_line);
    if (!options.quiet) io::print("{} ({:.1f} s)\n", evidence.text(), evidence.seconds);
  });
  if (show) io::tell("{}", no_line);
  if (result.interrupted) return ok;
  if (!result.undecided.empty()) return tell_undecided(result.undecided);
  if (!options.quiet) io::print("certified: {}\n", options.file);
  return ok;
}

int run_shadow(const casefile::CaseSpec& spec, const std::string& precision, const std::string& shadow,
               const std::atomic<bool>* interrupt) {
  const auto result = app::shadow(spec, precision, shadow, interrupt);
  io::print("{}", result.text());
  return result.interrupted ? interrupted : ok;
}

int run_estimate(const casefile::CaseSpec& spec, const std::string& precision, bool quiet) {
  const auto estimate = casefile::with_memory_for(
      spec, [&] { return app::estimate_run(spec, precision, options_of_trials(quiet)); });
  if (shows_progress(quiet)) io::tell("{}", no_line);
  if (estimate.interrupted) return after_signals(interrupted);
  io::print("{}", estimate.text());
  return after_signals(precision.empty() && !estimate.undecided.empty() ? undecided : ok);
}

int choose_digits(casefile::CaseSpec& spec, bool quiet, std::string& precision) {
  const auto found =
      casefile::with_memory_for(spec, [&] { return app::find_digits(spec, options_of_trials(quiet)); });
  if (shows_progress(quiet)) io::tell("{}", no_line);
  if (found.interrupted) {
    io::tell("edmill: interrupted before the digits were found; nothing is written\n");
    return after_signals(interrupted);
  }
  if (!found.undecided.empty()) return tell_undecided(found.undecided);
  if (!quiet) io::print("{}", found.text());
  precision = found.precision;
  spec.right_digits = found.right();
  return ok;
}

int run_prove(const casefile::CaseSpec& spec, ProveOptions options) {
  if (!options.checked.empty()) return check_header(spec, options);
  if (options.collisions == 0)
    throw InputError(
        "prove: found neither --collisions nor --check, expected how many events, or a certificate");
  const bool show = shows_progress(options.quiet);
  if (show)
    options.progress = [&](long bits, std::size_t events) {
      if (events % 16 == 0) io::tell("\r{} bits: {} of {} events ", bits, events, options.collisions);
    };
  const auto result = app::prove(spec, options);
  const auto& proof = result.proof;
  if (show) io::tell("{}", no_line);
  if (!options.quiet) print_attempts(proof);
  if (proof.interrupted) return ok;
  if (!proof.impossible.empty()) return tell_undecided(proof.impossible);
  if (options.quiet) return ok;
  io::print("proven: {} events in {} bits, {:.2f} bits lost per event ({:.1f} s)\n", proof.events.size(),
            proof.bits,
            static_cast<double>(proof.bits - proof.accuracy) / static_cast<double>(proof.events.size()),
            result.seconds);
  if (options.compare)
    for (const auto& precision : casefile::precisions())
      io::print("{:<9} {} events right\n", precision, app::right_events(precision, spec, proof));
  return ok;
}

}  // namespace edmill::cli
