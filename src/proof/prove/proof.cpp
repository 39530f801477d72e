#include "prove/proof.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "base/errors.hpp"
#include "base/interruption.hpp"
#include "model/mill.hpp"
#include "run/event_source.hpp"

namespace edmill::prove {

namespace {

constexpr slong coarse_bits = 64, guard_bits = 64;

std::string name_of(const auto& next) {
  const auto* kind = next.with_wall ? "wall" : "ball";
  return fmt::format("ball {} and {} {}", next.ball, kind, next.partner);
}

/// Adds the radius 2^-bits; with `may_vanish` an exact zero is left unchanged.
Enclosure blurred(Enclosure value, slong bits, bool may_vanish) {
  if (may_vanish && value.is_zero()) return value;
  arb_add_error_2exp_si(value.arb(), -bits);
  return value;
}
Vector blurred(const Vector& v, slong bits, bool may_vanish) {
  return each(v, [&](const Enclosure& component) { return blurred(component, bits, may_vanish); });
}

using Law = ContactLaw<Enclosure>;

/// max(e_n a, v_s)
Enclosure separation_speed(const Law& law, const Enclosure& approach) {
  Enclosure by_restitution = law.restitution * approach;
  if (law.least_separation.is_zero() || less(law.least_separation, by_restitution))
    return by_restitution;
  if (less(by_restitution, law.least_separation)) return law.least_separation;
  throw Undecided{"whether the restitution or the least separation speed decides"};
}

/// (1 - e_t)/c
Enclosure slip_gain(
    const Law& law, const Enclosure& change, const Enclosure& slip, const Enclosure& compliance) {
  const Enclosure reversed = 1 - law.tangential;
  if (!law.coulomb) return reversed / compliance;
  if (law.friction.is_zero()) return Enclosure();
  const Enclosure available = law.friction * compliance * change, needed = reversed * slip;
  if (arb_ge(available.arb(), needed.arb())) return reversed / compliance;
  if (less(available, needed)) return law.friction * change / slip;
  throw Undecided{"whether the contact slides or sticks"};
}

/// True if the flight was long enough for its ball to move, by the stall rule. @throws Undecided
bool has_moved(const Law& law, const Enclosure& flight_time) {
  const Enclosure reached = flight_time * Enclosure(model::StallRule().acceleration);
  if (law.least_separation.is_zero() || less(law.least_separation, reached)) return true;
  if (less(reached, law.least_separation)) return false;
  throw Undecided{"whether a ball has had time to move"};
}

/// The effect of an impact. (2.23'), (2.24'), (2.28'); docs/certificates.md, "Impulse"
struct Impulse {
  Vector push;  ///< P: change of velocity of a body of the effective mass [m/s]
  Vector turn;  ///< Q: n x S gain [m/s]
  Enclosure approach_speed, slip_speed;
};

/// @param normal      n, unit, from the partner to ball i
/// @param contact     G, relative velocity of the surfaces at the contact [m/s]
/// @param compliance  c = 1 + M/(m_i J_i) + M/(m_j J_j)
/// @param in_stall    the impact is frictionless
/// @throws Undecided
Impulse impulse(const Law& law, const Vector& normal, const Vector& contact,
    const Enclosure& compliance, bool in_stall) {
  const Enclosure approach = -dot<Enclosure>(contact, normal);
  if (!approach.is_positive()) throw Undecided{"whether the bodies approach each other"};
  const Enclosure change = approach + separation_speed(law, approach);
  const Vector slip = contact + normal * approach;
  const Enclosure slip_speed = norm<Enclosure>(slip);
  const Enclosure gain = in_stall ? Enclosure() : slip_gain(law, change, slip_speed, compliance);
  return {
      normal * change - slip * gain, cross<Enclosure>(normal, slip) * gain, approach, slip_speed};
}

/// The state of a proof after some events: all balls in flights that enclose the true ones.
class Prover {
 public:
  /// @param bits  of the numbers that are kept; arithmetic has 64 more
  Prover(const ExactCase& exact, slong bits)
      : exact_(exact), bits_(bits), coarse_(tools(exact, coarse_bits)),
        fine_(tools(exact, bits + guard_bits)) {
    const Precision scope(fine_.bits);
    const Pose pose = fine_.motion.pose(Enclosure());
    for (const auto& ball : exact.balls) {
      Vector position = enclosure_of(ball.position);
      const Vector velocity = enclosure_of(ball.velocity), spin = enclosure_of(ball.spin);
      if (ball.in_vessel) position = pose.centre + turned(pose.axes, position);
      Track& track = tracks_.emplace_back();
      track.flight = {Enclosure(), blurred(position, bits, false), blurred(velocity, bits, true),
          blurred(spin, bits, true)};
      track.coarse = coarse(track.flight);
    }
  }

  /// Proves that this is the next event, and continues with the states after it. @throws Undecided
  ProvenEvent take(const Meeting& next) {
    const Precision scope(fine_.bits);
    const Enclosure time = bracket(next);
    if (!less(last_end_, time.low()))
      throw Undecided{"whether " + name_of(next) + " meet after the event before"};
    const Enclosure end = time.high();
    std::vector<std::vector<std::string>> windows;
    windows.push_back(exclude_walls(next.ball, end, next.with_wall ? next.partner : -1));
    exclude_balls(next.ball, next.with_wall ? -1 : next.partner, end, events_);
    if (!next.with_wall) {
      windows.push_back(exclude_walls(next.partner, end, -1));
      exclude_balls(next.partner, next.ball, end, events_);
    }
    ProvenEvent event = next.with_wall ? impact_on_wall(next, time) : impact_of_balls(next, time);
    event.windows = std::move(windows);
    for (auto& flight : event.after)
      flight = flight.with_each([&](const Enclosure& x) { return rounded_out(x, bits_); });
    follow(event);
    return event;
  }

  /// Proves that the flights that have not ended meet nothing up to the end of the last bracket.
  /// @return by ball, the windows by wall; none for the balls of the last event
  std::vector<std::vector<std::string>> finish() {
    const Precision scope(fine_.bits);
    std::vector<std::vector<std::string>> windows(tracks_.size());
    for (int k = 0; k < static_cast<int>(tracks_.size()); ++k) {
      if (tracks_[k].event + 1 == events_ && events_ > 0) continue;
      windows[k] = exclude_walls(k, last_end_, -1);
      exclude_balls(k, -1, last_end_, events_ - 1);
    }
    return windows;
  }

  /// Accuracy of the least accurate velocity, in bits after the point.
  slong accuracy() const {
    slong least = bits_;
    for (const auto& track : tracks_)
      for (int k = 0; k < 3; ++k) {
        const auto& component = track.flight.velocity[k];
        if (!arb_is_exact(component.arb()))
          least = std::min(least, -arf_abs_bound_lt_2exp_si(arb_midref(component.radius().arb())));
      }
    return least;
  }
 private:
  /// The model in one precision.
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
    int wall = -1, with = -1;  ///< partner in that impact; -1 for none
    Enclosure since;           ///< when the flight began
    int unmoved = 0;           ///< impacts in a row before which the ball had no time to move
  };

  static Tools tools(const ExactCase& exact, slong bits) {
    const Precision scope(bits);
    Tools result{bits, Motion(exact), enclosure_of(exact.gravity), {}, {}};
    for (const auto& ball : exact.balls)
      result.balls.push_back({Walls(exact, ball), enclosure_of(ball.radius),
          enclosure_of(ball.density), enclosure_of(ball.reduced_inertia)});
    for (const auto& law : exact.laws)
      result.laws.push_back(
          {law.coulomb, enclosure_of(law.restitution), enclosure_of(law.tangential),
              enclosure_of(law.friction), enclosure_of(law.least_separation)});
    return result;
  }

  static Flight coarse(const Flight& flight) {
    return flight.with_each([](const Enclosure& x) { return rounded(x, coarse_bits); });
  }

  Pose pose_of_wall(int wall, const Enclosure& time) const {
    return fine_.motion.pose(time, fine_.motion.frame_of(wall));
  }

  Gap gap_at(const Meeting& next, const Enclosure& time) const {
    const Flight& one = tracks_[next.ball].flight;
    const Tools::Ball& ball = fine_.balls[next.ball];
    const int partner = next.partner;
    if (next.with_wall)
      return ball.walls.gap(partner, one.seen(pose_of_wall(partner, time), time, fine_.gravity));
    const Flight& two = tracks_[partner].flight;
    // The relative motion is uniform: it is extrapolated from the middle of a bracket.
    const Enclosure middle = time.middle(), reach = ball.radius + fine_.balls[partner].radius;
    PairGap pair(one, two, reach, fine_.gravity, middle);
    pair.between += pair.relative * Enclosure(time - middle);
    return {pair.value(), 2 * pair.half_rate(), 2 * squared_norm<Enclosure>(pair.relative)};
  }

  /// Newton's method to the width of the flights, then an interval that provably has the contact.
  Enclosure bracket(const Meeting& next) const {
    Enclosure time = next.time, wide;
    for (slong bits = 256;; bits = std::min(2 * bits, fine_.bits)) {
      const Precision scope(std::min(bits, fine_.bits));
      const Gap gap = gap_at(next, time);
      const Enclosure step = gap.value / gap.rate;
      if (!arb_is_finite(step.arb()) || !gap.rate.is_negative())
        throw Undecided{"whether " + name_of(next) + " meet"};
      time = Enclosure(time - step).middle();
      wide = step;
      if (bits < fine_.bits) continue;
      if (less(wide.middle() * wide.middle(), wide.radius() * wide.radius())) break;
      if (arb_is_exact(wide.arb())) break;
    }
    // The last step moved to its midpoint; its radius remains.
    Enclosure half = wide.radius() * Enclosure(1 + 0x1p-7);
    for (const double factor : {1.0, 1.25, 2.0}) {
      const auto room = half * Enclosure(factor);
      const slong kept = arf_abs_bound_lt_2exp_si(arb_midref(time.arb())) -
          arf_abs_bound_lt_2exp_si(arb_midref(room.arb())) + 14;
      Enclosure found = rounded(time, std::max<slong>(kept, 8)).middle();
      arb_add_error(found.arb(), room.arb());
      found = rounded_out(found, fine_.bits);
      if (gap_at(next, found.low()).value.is_positive() &&
          gap_at(next, found.high()).value.is_negative() && gap_at(next, found).rate.is_negative())
        return found;
    }
    throw Undecided{"when " + name_of(next) + " meet"};
  }

  std::vector<std::string> exclude_walls(int ball, const Enclosure& end, int end_wall) const {
    const Track& track = tracks_[ball];
    const auto exclusion = [&](const Tools& tools, const Flight& flight) {
      return WallExclusion(tools.motion, tools.balls[ball].walls, tools.gravity,
          {flight, track.begin, end, track.wall, end_wall});
    };
    auto first = exclusion(coarse_, track.coarse), second = exclusion(fine_, track.flight);
    std::vector<std::string> texts;
    for (std::size_t wall = 0; wall < exact_.walls.size(); ++wall) {
      auto& text = texts.emplace_back(first.windows(wall, coarse_.bits));
      if (text.empty()) text = second.windows(wall, fine_.bits);
      if (text.empty())
        throw Undecided{fmt::format("whether ball {} meets wall {} before", ball, wall)};
    }
    return texts;
  }

  /// Excludes all other balls whose flights have not ended; the others have excluded this one.
  void exclude_balls(int ball, int partner, const Enclosure& end, long through) const {
    const Track& track = tracks_[ball];
    for (int k = 0; k < static_cast<int>(tracks_.size()); ++k) {
      const Track& other = tracks_[k];
      if (k == ball || k == partner) continue;
      if (std::max(track.event, other.event) >= through) continue;
      // Balls that have just left each other: their distance grows for ever.
      if (track.with == k && other.with == ball && track.event == other.event) continue;
      const Enclosure& begin = track.event > other.event ? track.begin : other.begin;
      const auto proven_in = [&](const Tools& tools, Flight Track::*flight) {
        const Precision scope(tools.bits);
        return apart(track.*flight, other.*flight, tools.balls[ball].radius + tools.balls[k].radius,
            tools.gravity, begin, end);
      };
      if (!proven_in(coarse_, &Track::coarse) && !proven_in(fine_, &Track::flight))
        throw Undecided{fmt::format("whether balls {} and {} meet before", ball, k)};
    }
  }

  /// Counts the ball's impacts in a row without time to move. @return true if this is frictionless
  bool friction_rests(int ball, const Law& law, const Enclosure& time) {
    Track& track = tracks_[ball];
    if (has_moved(law, time - track.since)) {
      track.unmoved = 0;
      return false;
    }
    return ++track.unmoved > model::StallRule().impacts;
  }

  ProvenEvent impact_on_wall(const Meeting& next, const Enclosure& time) {
    const int own = next.ball, wall = next.partner;
    const Flight& flight = tracks_[own].flight;
    const Tools::Ball& ball = fine_.balls[own];
    const Enclosure middle = time.middle(), d = time - middle;
    const Vector& g = fine_.gravity;
    const Vector position = flight.position_at(middle, g), velocity = flight.velocity_at(middle, g);
    const Vector fast = velocity + g * d;
    const Pose pose = pose_of_wall(wall, time), mid_pose = pose_of_wall(wall, middle);
    const auto seen = pose.seen(position + fast * d, fast, g);
    const Vector place = turned_back(mid_pose.axes, position - mid_pose.centre) + seen.velocity * d;
    const Vector inward = ball.walls.normal(wall, place), normal = turned(pose.axes, inward);
    const Vector arm = turned(pose.axes, place - inward * ball.radius);
    const Vector surface = pose.velocity + cross<Enclosure>(pose.omega, arm);
    const Vector contact = fast - surface - cross<Enclosure>(flight.spin * ball.radius, normal);
    const Law& law = fine_.laws[exact_.law_of_walls[own][wall]];
    const bool rests = friction_rests(own, law, time);
    const auto hit = impulse(law, normal, contact, 1 + 1 / ball.inertia, rests);
    const Flight after{middle, position - hit.push * d, velocity + hit.push,
        flight.spin + hit.turn * Enclosure(1 / (ball.radius * ball.inertia))};
    return {{next.ball, true, next.partner, time}, hit.approach_speed, hit.slip_speed, {after}, {}};
  }

  ProvenEvent impact_of_balls(const Meeting& next, const Enclosure& time) {
    const int i = next.ball, j = next.partner;
    const Flight &one = tracks_[i].flight, &two = tracks_[j].flight;
    const Enclosure middle = time.middle(), d = time - middle;
    const Vector& g = fine_.gravity;
    const Vector position[2] = {one.position_at(middle, g), two.position_at(middle, g)};
    const Vector velocity[2] = {one.velocity_at(middle, g), two.velocity_at(middle, g)};
    const Vector relative = velocity[0] - velocity[1];
    const auto& [walls_i, R_i, density_i, J_i] = fine_.balls[i];
    const auto& [walls_j, R_j, density_j, J_j] = fine_.balls[j];
    const Vector normal = (position[0] - position[1] + relative * d) / Enclosure(R_i + R_j);
    // Masses without 4/3 pi: only their ratios count.
    const Enclosure m_i = density_i * (R_i * R_i * R_i), m_j = density_j * (R_j * R_j * R_j);
    const Enclosure share_i = m_j / (m_i + m_j), share_j = m_i / (m_i + m_j);
    const Enclosure compliance = 1 + share_i / J_i + share_j / J_j;
    const Vector contact = relative - cross<Enclosure>(one.spin * R_i + two.spin * R_j, normal);
    const Law& law = fine_.laws[exact_.law_of_balls[i][j]];
    const bool i_rests = friction_rests(i, law, time), j_rests = friction_rests(j, law, time);
    const auto hit = impulse(law, normal, contact, compliance, i_rests || j_rests);
    const Vector push_i = hit.push * share_i, push_j = hit.push * share_j;
    const Flight after_i{middle, position[0] - push_i * d, velocity[0] + push_i,
        one.spin + hit.turn * Enclosure(share_i / (R_i * J_i))};
    const Flight after_j{middle, position[1] + push_j * d, velocity[1] - push_j,
        two.spin + hit.turn * Enclosure(share_j / (R_j * J_j))};
    return {{next.ball, false, next.partner, time}, hit.approach_speed, hit.slip_speed,
        {after_i, after_j}, {}};
  }

  void follow(const ProvenEvent& event) {
    const Enclosure begin = event.time.low();
    for (std::size_t k = 0; k < event.after.size(); ++k) {
      Track& track = tracks_[k == 0 ? event.ball : event.partner];
      track.flight = event.after[k];
      track.coarse = coarse(track.flight);
      track.begin = begin;
      track.since = event.time;
      track.event = events_;
      track.wall = event.with_wall ? event.partner : -1;
      track.with = event.with_wall ? -1 : k == 0 ? event.partner : event.ball;
    }
    if (!event.with_wall &&
        !gap_at({event.ball, false, event.partner, {}}, event.time).rate.is_positive())
      throw Undecided{
          fmt::format("whether balls {} and {} leave each other", event.ball, event.partner)};
    last_end_ = event.time.high();
    ++events_;
  }

  const ExactCase& exact_;
  slong bits_;
  Tools coarse_, fine_;
  std::vector<Track> tracks_;
  Enclosure last_end_;  ///< upper end of the last bracket
  long events_ = 0;
};

constexpr slong first_bits = 128, spare_bits = 96;

/// Thrown if there is no proof: no number of bits would help, or too many would be needed.
struct Impossible {
  std::string why;
};

/// Proves events with this number of bits until one is undecided. @return true if all are proven
bool attempt(
    Proof& proof, const std::vector<Meeting>& next, slong bits, const ProofOptions& options) {
  Prover prover(proof.exact, bits);
  Attempt& result = proof.attempts.emplace_back(Attempt{bits, 0, ""});
  proof.events.clear();
  try {
    for (const auto& candidate : next) {
      Interruption::check();
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
  Interruption::check();
  return result.undecided.empty();
}

/// Candidates to be proven: the first events of a run. @throws InputError when the case ends before
std::vector<Meeting> candidates(const casefile::CaseSpec& spec, const ProofOptions& options) {
  const std::size_t collisions = options.collisions;
  const auto source = run::make_source("mpfr:" + std::to_string(placing_digits), spec, false);
  std::vector<run::Event> events;
  while (events.size() < collisions) {
    const auto taken = source->next(std::min<std::size_t>(64, collisions - events.size()));
    events.insert(events.end(), taken.begin(), taken.end());
    Interruption::check();
    if (taken.empty())
      throw InputError(fmt::format("{}: the case ends after {} collisions, {} are requested",
          spec.file, events.size(), collisions));
  }
  const Precision scope(1024);
  const Enclosure start = enclosure_of(spec.initial_time);
  std::vector<Meeting> list;
  for (const auto& event : events) {
    if (event.by_rule)
      throw Impossible{fmt::format(
          "event {}, {} at {} s, has another contact of its ball at the same time: the equations "
          "do not say what comes next",
          list.size(), name_of(event), event.time.str(17))};
    Enclosure time;
    arf_set_mpfr(arb_midref(time.arb()), event.time.data());
    list.push_back({event.ball, event.with_wall, event.partner, Enclosure(time - start).middle()});
  }
  return list;
}

}  // namespace

Proof prove(const casefile::CaseSpec& spec, const ProofOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  Proof proof;
  proof.exact = exact_case(spec);
  const Interruption scope(options.interrupt);
  try {
    const auto next = candidates(spec, options);
    for (slong bits = first_bits; !attempt(proof, next, bits, options); bits *= 2)
      if (2 * bits > options.most_bits)
        throw Impossible{fmt::format(
            "event {}: {} bits do not decide {}; the contacts may be simultaneous, or the widest "
            "scalar has lost the sequence",
            proof.attempts.back().events, bits, proof.attempts.back().undecided)};
    // A certificate need not be longer than the proof requires.
    const slong sure = proof.bits, enough = (sure - proof.accuracy + spare_bits + 31) / 32 * 32;
    if (enough < sure && enough > first_bits && !attempt(proof, next, enough, options))
      attempt(proof, next, sure, options);
  } catch (const InterruptedError&) {
    proof.interrupted = true;
  } catch (const Impossible& found) {
    proof.impossible = found.why;
  }
  proof.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return proof;
}

}  // namespace edmill::prove
