// The first events of a case, proven. docs/theory.md, section 7
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "casefile/case_spec.hpp"
#include "prove/prover.hpp"

namespace edmill::prove {

struct ProofOptions {
  std::size_t collisions = 0;
  slong most_bits = 16384;
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(slong bits, std::size_t events)> progress;  ///< called for each event
};

/// A trial at one number of bits.
struct Attempt {
  slong bits;
  std::size_t events;     ///< that it proved
  std::string undecided;  ///< what stopped it, or empty
};

struct Proof {
  ExactCase exact;
  slong bits = 0;
  std::vector<ProvenEvent> events;
  std::vector<std::vector<std::string>> open_windows;  ///< of the flights at the end, by ball and wall
  slong accuracy = 0;  ///< bits after the point of the least known velocity at the end
  std::vector<Attempt> attempts;
  bool interrupted = false;
  std::string impossible;  ///< why the model itself cannot say what comes next, or no scalar knows where to
                           ///< look; no proof then
};

/// Proves the first events with 128 bits, and twice as many until all are proven; then once more with as many
/// as the last try used.
/// @throws InputError for a case that `prove` does not know
Proof prove(const casefile::CaseSpec& spec, const ProofOptions& options);

}  // namespace edmill::prove
