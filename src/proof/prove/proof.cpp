#include "prove/proof.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "base/errors.hpp"
#include "run/event_source.hpp"

namespace edmill::prove {

namespace {

constexpr slong first_bits = 128, spare_bits = 96;

bool stopped(const ProofOptions& options) {
  return options.interrupt && options.interrupt->load(std::memory_order_relaxed);
}

/// All events at this number of bits, or as many as it decides.
Attempt attempt(Proof& proof, const std::vector<Meeting>& next, slong bits, const ProofOptions& options) {
  Prover prover(proof.exact, bits);
  Attempt result{bits, 0, ""};
  proof.events.clear();
  try {
    for (const auto& candidate : next) {
      if (stopped(options)) break;
      proof.events.push_back(prover.take(candidate));
      ++result.events;
      if (options.progress) options.progress(bits, result.events);
    }
    proof.open_windows = prover.finish();
    proof.bits = bits;
    proof.accuracy = prover.accuracy();
  } catch (const Undecided& undecided) {
    result.undecided = undecided.what;
  }
  return result;
}

/// Where to look for each event: the first ones of a run in the widest scalar; none when it is interrupted.
/// @throws InputError when the case ends before
std::vector<Meeting> candidates(const casefile::CaseSpec& spec, const ProofOptions& options,
                                std::string& impossible) {
  const std::size_t collisions = options.collisions;
  const auto source = run::make_source("mpfr:" + std::to_string(placing_digits), spec, false);
  std::vector<run::Event> events;
  while (events.size() < collisions && !stopped(options)) {
    auto more = source->next(std::min<std::size_t>(64, collisions - events.size()));
    if (more.empty()) break;
    std::move(more.begin(), more.end(), std::back_inserter(events));
  }
  if (stopped(options)) return {};
  if (events.size() < collisions)
    throw InputError(fmt::format("{}: the case ends after {} collisions, {} are requested", spec.file,
                                 events.size(), collisions));
  const Precision scope(1024);
  const Enclosure start = enclosure_of(spec.initial_time);
  std::vector<Meeting> list;
  for (const auto& event : events) {
    if (event.by_rule) {
      impossible = fmt::format(
          "event {}, ball {} and {} {} at {} s, has another contact of its ball at the same time: the "
          "equations do not say what comes next",
          list.size(), event.ball, event.with_wall ? "wall" : "ball", event.partner, event.time.str(17));
      return {};
    }
    Enclosure time;
    arf_set_mpfr(arb_midref(time.arb()), event.time.data());
    list.push_back({event.ball, event.with_wall, event.partner, Enclosure(time - start).middle()});
  }
  return list;
}

}  // namespace

Proof prove(const casefile::CaseSpec& spec, const ProofOptions& options) {
  Proof proof;
  proof.exact = exact_case(spec);
  const auto next = candidates(spec, options, proof.impossible);
  if ((proof.interrupted = stopped(options))) return proof;
  if (!proof.impossible.empty()) return proof;
  for (slong bits = first_bits;; bits *= 2) {
    proof.attempts.push_back(attempt(proof, next, bits, options));
    if ((proof.interrupted = stopped(options))) return proof;
    if (proof.attempts.back().undecided.empty()) break;
    if (2 * bits > options.most_bits) {
      proof.impossible = fmt::format(
          "event {}: {} bits do not tell {}; the contacts may be simultaneous, or the widest scalar has lost "
          "the sequence",
          proof.attempts.back().events, bits, proof.attempts.back().undecided);
      return proof;
    }
  }
  // A certificate need not be longer than the proof asks for.
  const slong enough = (proof.bits - proof.accuracy + spare_bits + 31) / 32 * 32;
  if (enough < proof.bits && enough > first_bits) {
    const slong sure = proof.bits;
    proof.attempts.push_back(attempt(proof, next, enough, options));
    if ((proof.interrupted = stopped(options))) return proof;
    if (!proof.attempts.back().undecided.empty())
      proof.attempts.push_back(attempt(proof, next, sure, options));
    proof.interrupted = stopped(options);
  }
  return proof;
}

}  // namespace edmill::prove
