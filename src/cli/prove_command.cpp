#include "cli/prove_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <optional>

#include "base/errors.hpp"
#include "cli/certify_command.hpp"
#include "cli/exit_codes.hpp"
#include "io/input_file.hpp"
#include "io/named_file.hpp"
#include "io/terminal.hpp"
#include "prove/certificate.hpp"

namespace edmill::cli {

namespace {

void print_attempts(const prove::Proof& proof) {
  for (const auto& attempt : proof.attempts)
    io::print("{} bits: {} events{}\n", attempt.bits, attempt.events,
              attempt.undecided.empty() ? "" : "; undecided: " + attempt.undecided);
}

/// Events of a run in the order of the proof, from the first on.
std::size_t right_events(const std::string& precision, const casefile::CaseSpec& spec,
                         const prove::Proof& proof) {
  const auto source = source_in(precision, spec, false);
  std::size_t right = 0;
  while (right < proof.events.size()) {
    const auto more = source->next(std::min<std::size_t>(256, proof.events.size() - right));
    if (more.empty()) return right;
    for (const auto& event : more) {
      const auto& proven = proof.events[right];
      if (event.ball != proven.ball || event.with_wall != proven.with_wall || event.partner != proven.partner)
        return right;
      ++right;
    }
  }
  return right;
}

/// Whether the certificate is one of this case.
int check_header(const casefile::CaseSpec& spec, const ProveOptions& options) {
  io::InputFile file(options.checked, "a certificate");
  const auto differences = prove::other_case(file, options.checked, prove::exact_case(spec));
  for (const auto& line : differences) io::print("{}\n", line);
  if (!differences.empty()) {
    if (!options.quiet) io::print("{} is of another case than {}\n", options.checked, spec.file);
    return outputs_differ;
  }
  if (!options.quiet)
    io::print("{} is of the case {}; check_certificate says whether its events are proven\n", options.checked,
              spec.file);
  return ok;
}

}  // namespace

int run_prove(const casefile::CaseSpec& spec, const ProveOptions& options) {
  if (!options.checked.empty()) return check_header(spec, options);
  if (options.collisions == 0)
    throw InputError(
        "prove: found neither --collisions nor --check, expected how many events, or a certificate");
  std::optional<io::NamedFile> events, certificate;
  if (!options.file.empty()) events.emplace(options.file);
  if (!options.certificate.empty()) certificate.emplace(options.certificate);
  const auto begin = std::chrono::steady_clock::now();
  const bool show = !options.quiet && ::isatty(STDERR_FILENO);
  prove::ProofOptions proving{options.collisions, options.most_bits, options.interrupt, {}};
  if (show)
    proving.progress = [&](long bits, std::size_t events) {
      if (events % 16 == 0) io::tell("\r{} bits: {} of {} events ", bits, events, options.collisions);
    };
  const auto proof = prove::prove(spec, proving);
  if (show) io::tell("\r\x1b[K");
  if (!options.quiet) print_attempts(proof);
  if (proof.interrupted) return ok;
  if (!proof.impossible.empty()) {
    io::tell("edmill: {}; nothing is written\n", proof.impossible);
    return undecided;
  }
  if (events) events->write([&](auto& out) { prove::write_events(out, proof, 27); });
  if (certificate) certificate->write([&](auto& out) { prove::write_certificate(out, proof); });
  if (options.quiet) return ok;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  io::print("proven: {} events in {} bits, {:.2f} bits lost per event ({:.1f} s)\n", proof.events.size(),
            proof.bits,
            static_cast<double>(proof.bits - proof.accuracy) / static_cast<double>(proof.events.size()),
            seconds);
  if (options.compare)
    for (const auto& precision : casefile::precisions())
      io::print("{:<9} {} events right\n", precision, right_events(precision, spec, proof));
  return ok;
}

}  // namespace edmill::cli
