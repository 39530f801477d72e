// The first events of a case, proven. docs/theory.md, section 7; docs/certificates.md
#pragma once

#include <atomic>
#include <functional>
#include <istream>
#include <ostream>
#include <string>
#include <vector>

#include "casefile/case_spec.hpp"
#include "prove/flight.hpp"

namespace edmill::prove {

/// Two bodies that meet next, or may, and when.
struct Meeting {
  int ball = 0;
  bool with_wall = false;
  int partner = 0;  ///< ball or wall
  Enclosure time;   ///< [s] after the start: about when, exact; of a proven event the bracket
};

struct ProvenEvent : Meeting {
  Enclosure approach_speed, slip_speed;           ///< before the impact [m/s]
  std::vector<Flight> after;                      ///< of the ball and of a partner that is a ball
  std::vector<std::vector<std::string>> windows;  ///< of the flights that end, by body and wall
};

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
  std::string undecided;  ///< the decision that stopped it, or empty
};

struct Proof {
  ExactCase exact;
  slong bits = 0;
  std::vector<ProvenEvent> events;
  std::vector<std::vector<std::string>> open_windows;  ///< of flights that go on, by ball and wall
  slong accuracy = 0;  ///< bits after the point of the least known velocity at the end
  std::vector<Attempt> attempts;
  double seconds = 0;  ///< duration of the proof
  bool interrupted = false;
  std::string impossible;  ///< why there is no proof, if no bits help; otherwise empty
};

/// Proves the first events with 128 bits, doubled until all are proven, then with as few as needed.
/// @throws InputError for a case that `prove` does not know
Proof prove(const casefile::CaseSpec& spec, const ProofOptions& options);

/// The file that anybody can check, as JSON lines: the exact case, the events, the last flights.
void write_certificate(std::ostream& out, const Proof& proof);

/// The differences between the header of a certificate and this case, a line each:
/// "/balls/0/radius: found "1/250", expected "119/25000"". Name, digest, bits and number of events
/// are not compared: what is proven follows from the rest. @param name  of the file, for messages
/// @throws InputError when the file is not a certificate, or its header contains a key twice
std::vector<std::string> other_case(
    std::istream& certificate, const std::string& name, const ExactCase& exact);

/// CSV for readers: index, time, bodies, approach and slip speed, each with its radius.
void write_events(std::ostream& out, const Proof& proof, int digits);

}  // namespace edmill::prove
