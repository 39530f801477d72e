#include "app/prove.hpp"

#include <chrono>

#include "app/certify.hpp"
#include "base/clean_text.hpp"
#include "io/input_file.hpp"
#include "io/output_folder.hpp"
#include "prove/proof.hpp"

namespace edmill::app {

std::size_t right_events(const std::string& precision, const casefile::CaseSpec& spec,
                         const prove::Proof& proof) {
  const auto source = run::make_source(precision, spec, false);
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

Proven prove(const casefile::CaseSpec& spec, const ProveOptions& options) {
  auto events = io::file_for(options.file), certificate = io::file_for(options.certificate);
  const auto begin = std::chrono::steady_clock::now();
  Proven result{prove::prove(spec, options)};
  result.proof.exact.name = one_line(result.proof.exact.name);
  const auto& proof = result.proof;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (proof.interrupted || !proof.impossible.empty()) return result;
  if (events) events->write([&](auto& out) { prove::write_events(out, proof, 27); });
  if (certificate) certificate->write([&](auto& out) { prove::write_certificate(out, proof); });
  return result;
}

std::vector<std::string> check_certificate(const casefile::CaseSpec& spec, const std::string& certificate) {
  io::InputFile file(certificate, "a certificate");
  return prove::other_case(file, certificate, prove::exact_case(spec));
}

}  // namespace edmill::app
