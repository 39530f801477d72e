// The first events of a case, proven: event by event, which bodies meet and when. docs/theory.md, section 7;
// docs/certificates.md
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

/// A contact law at the precision in force.
struct Law {
  bool coulomb;
  Enclosure restitution, tangential, friction, least_separation;
};

/// The state of a proof after some events: all balls in flights that enclose the true ones.
class Prover {
 public:
  /// @param bits  of the numbers that are kept; arithmetic has 64 more
  Prover(const ExactCase& exact, slong bits);

  /// Proves that this is the next event, and goes on to its other side.
  /// @throws Undecided
  ProvenEvent take(const Meeting& next);
  /// Proves that the flights that have not ended meet nothing up to the end of the last bracket.
  /// @return by ball, the windows by wall; none for the balls of the last event
  std::vector<std::vector<std::string>> finish();

  /// Bits that the radii leave of the least known velocity.
  slong accuracy() const;

 private:
  /// What arithmetic at one precision needs.
  struct Tools {
    struct Ball {
      Walls walls;
      Enclosure radius, density, inertia;
    };
    slong bits;
    Motion motion;
    Vector gravity;
    std::vector<Ball> balls;
    std::vector<Law> laws;
  };
  struct Track {
    Flight flight, coarse;
    Enclosure begin;           ///< lower end of the bracket of its first event
    long event = -1;           ///< its number; -1 for the start
    int wall = -1, with = -1;  ///< that it was an impact with
    Enclosure since;           ///< when the flight began
    int unmoved = 0;           ///< impacts in a row before which the ball had no time to move
  };

  static Tools tools(const ExactCase& exact, slong bits);
  Enclosure bracket(const Meeting& next) const;
  Gap gap_at(const Meeting& next, const Enclosure& time) const;
  bool brackets(const Meeting& next, const Enclosure& time) const;
  std::vector<std::string> exclude_walls(int ball, const Enclosure& end, int end_wall) const;
  /// @param through  the number of the event at `end`
  void exclude_balls(int ball, int partner, const Enclosure& end, long through) const;
  ProvenEvent impact_on_wall(const Meeting& next, const Enclosure& time);
  ProvenEvent impact_of_balls(const Meeting& next, const Enclosure& time);
  void follow(const ProvenEvent& event);
  bool friction_rests(int ball, const Law& law, const Enclosure& time);

  const ExactCase& exact_;
  slong bits_;
  Tools coarse_, fine_;
  std::vector<Track> tracks_;
  Enclosure last_end_;  ///< upper end of the last bracket
  long events_ = 0;
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

/// The file that anybody can check, as JSON lines: the exact case, the events, the flights at the end.
/// docs/certificates.md
void write_certificate(std::ostream& out, const Proof& proof);

/// Where the header of a certificate tells of another case than this one, a line each: "/balls/0/radius:
/// found "1/250", expected "119/25000"". The name of the case, its digest, the bits and the number of events
/// do not count: what is proven follows from the other numbers.
/// @param name  of the file, for messages
/// @throws InputError for what is no certificate, or has a key of the header twice
std::vector<std::string> other_case(std::istream& certificate, const std::string& name,
                                    const ExactCase& exact);

/// CSV for readers: index, time, bodies, approach and slip speed, each with its radius.
void write_events(std::ostream& out, const Proof& proof, int digits);

}  // namespace edmill::prove
