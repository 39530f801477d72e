#include "rules.hpp"

#include <algorithm>

#include "numbers.hpp"
#include "verdict.hpp"

namespace checker {
namespace {

/// Places on a flight are counted in parts of 2^-24 of its length.
constexpr long finest_depth = 24, whole_flight = 1L << finest_depth;

/// A window is bisected so often in search of a proof.
constexpr int most_bisections = 10;

/// A letter of rule 4 and its interval.
struct Window {
  char letter;
  long begin, end;
};

/// The window of a letter and a depth, as "p2", which begins at this place.
Window read_window(const std::string& text, long begin) {
  const long depth = small_integer(text.substr(1));
  if (depth < 0 || depth > finest_depth) throw Violation("rule 4: a window of another depth");
  const long length = whole_flight >> depth;
  const long end = begin + length;
  if (begin % length != 0 || end > whole_flight)
    throw Violation("rule 4: windows that are no bisection");
  return {text[0], begin, end};
}

/// Whether the claim of a letter is proven from one time to another, at once or on the parts of a
/// bisection.
bool holds(char letter, const Motion& motion, const Contact& contact, const Real& from,
    const Real& to, int bisections) {
  const Real centre = (from + to) / 2;
  const Real all = interval(from, to);
  const Real rate = motion.gap_rate(contact, all);
  // p: f > 0, by the mean value theorem. r: f' > 0. f: f' < 0.
  if (letter == 'p' && (motion.gap(contact, centre) + rate * (all - centre)).positive())
    return true;
  if (letter == 'r' && rate.positive()) return true;
  if (letter == 'f' && rate.negative()) return true;
  return bisections > 0 && holds(letter, motion, contact, from, centre, bisections - 1) &&
      holds(letter, motion, contact, centre, to, bisections - 1);
}

/// Whether the claim of a window is proven for a flight that ends at a time.
bool holds(const Window& window, const Motion& motion, const Contact& contact, const Real& until) {
  const Real& begin = motion.flights[contact.ball].begin;
  const auto time = [&](long place) {
    return begin + (until - begin) * Real(place) / whole_flight;
  };
  return holds(
      window.letter, motion, contact, time(window.begin), time(window.end), most_bisections);
}

/// Whether one of the conditions of rule 5 is proven between the times A and B. The separations r_i
/// - r_j are those at A and B, `velocity` is v_i - v_j, and balls touch at the distance `reach`.
bool are_apart(const Vec& at_A, const Vec& at_B, const Vec& velocity, const Real& reach,
    const Real& duration) {
  const Real f = dot(at_A, at_A) - reach * reach;
  const Real half_rate = dot(at_A, velocity);
  if (f.positive()) {
    if (half_rate >= 0) return true;                             // f' >= 0 at A
    if ((f + 2 * half_rate * duration).positive()) return true;  // f lies above its tangent at A
  }
  if (half_rate * half_rate < dot(velocity, velocity) * f) return true;  // f has no root
  const Real f_at_B = dot(at_B, at_B) - reach * reach;
  return f_at_B.positive() && 0 >= dot(at_B, velocity);  // f' <= 0 at B
}

}  // namespace

void require_contact(const Motion& motion, const Contact& contact, const Real& bracket) {
  if (!motion.gap(contact, lower_end(bracket)).positive())
    throw Violation("rule 2: the bodies are not proven apart at the begin of the bracket");
  if (!motion.gap(contact, upper_end(bracket)).negative())
    throw Violation("rule 2: they are not proven to overlap at its end");
  if (!motion.gap_rate(contact, bracket).negative())
    throw Violation("rule 2: they are not proven to approach on it");
}

void require_no_wall(const Motion& motion, Index ball, Index wall, const std::string& windows,
    const Real& until, bool at_end) {
  const bool at_start = motion.flights[ball].wall == wall;
  const Contact contact{ball, true, wall};
  long place = 0;
  for (Index first = 0, next; first < windows.size(); first = next) {
    next = std::min(windows.find_first_of("prf", first + 1), windows.size());
    const Window window = read_window(windows.substr(first, next - first), place);
    const bool allowed = window.letter == 'p' ||
        (window.letter == 'r' && at_start && window.begin == 0) ||
        (window.letter == 'f' && at_end && window.end == whole_flight);
    if (!allowed) throw Violation("rule 4: a letter in the wrong place");
    const auto holds_in = [&](long bits) {
      const WithPrecision scope(bits);
      return holds(window, motion, contact, until);
    };
    if (!holds_in(few_bits) && !holds_in(precision))
      throw Violation("rule 4: a wall is not excluded");
    place = window.end;
  }
  if (place != whole_flight) throw Violation("rule 4: windows that leave a part of a flight out");
}

void require_no_pair(const Motion& motion, Index i, Index j, const Real& until) {
  const Flight &a = motion.flights[i], &b = motion.flights[j];
  const Real& from = a.event > b.event ? a.begin : b.begin;
  const Real reach = motion.reach(i, j);
  // Gravity acts on both balls alike and is left out of the quick comparison.
  const auto shown_in_few_bits = [&] {
    const WithPrecision scope(few_bits);
    const Vec velocity = a.velocity_at_0 - b.velocity_at_0;
    const Vec separation = a.position_at_0 - b.position_at_0;
    return are_apart(
        separation + velocity * from, separation + velocity * until, velocity, reach, until - from);
  };
  const auto shown = [&] {
    return are_apart(motion.separation(i, j, from), motion.separation(i, j, until),
        motion.relative_velocity(i, j, from), reach, until - from);
  };
  if (!shown_in_few_bits() && !shown()) throw Violation("rule 5: balls are not proven apart");
}

}  // namespace checker
