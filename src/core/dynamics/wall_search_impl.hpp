// Implementation of WallSearch; included by the instantiation files only.
#pragma once

#include <array>
#include <bit>
#include <type_traits>
#include <utility>

#include "base/errors.hpp"
#include "base/interruption.hpp"
#include "dynamics/exact_contact.hpp"
#include "dynamics/wall_search.hpp"

namespace edmill::dynamics {

[[gnu::noinline]] bool has_exact_gap(const auto& mill, int wall) {
  using Real = std::decay_t<decltype(mill.reach)>;
  const Vec3<Real> zero = Vec3<Real>::Zero();
  return exact_gap(mill, WallQuery<Real>{{zero, zero, {}}, Real(0), {}, Real(0)}, wall).has_value();
}

/// Orders the contacts with two walls by exact arithmetic: negative if `one` is hit first, positive
/// if `other` is, zero if both are hit at one time. Empty if an exact time is unknown.
[[gnu::noinline]] std::optional<int> exact_order(
    const auto& mill, const auto& query, int one, bool one_at_once, int other, bool other_at_once) {
  const auto time_of = [&](int wall, bool at_once) -> std::optional<ExactTime> {
    if (at_once) return ExactTime{};
    const auto gap = exact_gap(mill, query, wall);
    return gap ? exact_contact_time(*gap) : std::nullopt;
  };
  const auto first = time_of(one, one_at_once);
  if (!first) return std::nullopt;
  const auto second = time_of(other, other_at_once);
  return second ? std::optional(first->compare(*second)) : std::nullopt;
}

template <Motion M, Vessel V>
WallSearch<M, V>::WallSearch(const M& motion, const V& vessel, const Vec3<Real>& gravity)
    : mill_(motion, vessel, gravity), bounds_(mill_),
      rough_(motion.template cast<double>(), vessel.template cast<double>(),
          vector_cast<double>(gravity)) {
  if constexpr (is_body) own_speed_ = motion.wall_speed(vessel.size());
}

template <Motion M, Vessel V>
auto WallSearch<M, V>::within_reach(const Functions& functions, const Vec3<Real>& position,
    const Real& speed, const Real& length) const -> Walls {
  const Real margin = rounding_margin<Real>();
  const Real way = (speed + mill_.wall_speed) * length * (1 + margin) + mill_.reach * margin;
  auto near = functions.room().within(position, way);
  if (const auto* pistons = model::pistons_of(mill_.vessel))
    for (std::size_t k = 0; k < pistons->count(); ++k) near[pistons->wall(k)] = true;
  return near;
}

/// For so long a ball certainly does not reach a body [s]: their distance changes by no more than
/// both move. 0 if that is short, compared with the `length` of the search.
template <Motion M, Vessel V>
auto WallSearch<M, V>::clear_time(const Functions& functions, const Vec3<Real>& position,
    const Real& speed, const Real& length) const -> Real {
  if constexpr (is_body) {
    const Real margin = rounding_margin<Real>(), clearance = functions.room().clearance(position);
    const Real leap = (clearance - mill_.reach * margin) / ((speed + own_speed_) * (1 + margin));
    if (16 * leap > length) return leap < length ? leap : length;
  }
  return Real(0);
}

template <Motion M, Vessel V> void WallSearch<M, V>::require_length(const Query& query) const {
  EDMILL_REQUIRE(
      query.length > 0 && query.length <= longest_window() * (1 + rounding_margin<Real>()),
      "window length out of range");
}

template <Motion M, Vessel V>
decltype(auto) WallSearch<M, V>::smooth(const Query& query, const Functions& functions,
    const Vec3<Real>& position, const Real& speed) const {
  if constexpr (model::HasRegions<V>) {
    auto shorter = query;
    const auto way = functions.room().smooth_way(position);
    if (way && *way < (speed + mill_.wall_speed) * query.length)
      shorter.length = *way / (speed + mill_.wall_speed);
    return shorter;
  } else {
    return (query);
  }
}

template <Motion M, Vessel V>
auto WallSearch<M, V>::search(const Pose& pose, const Query& query) const -> Answer {
  require_length(query);
  Functions functions(mill_, query.flight, query.radius, query.begin.period);
  const Real& begin = query.begin.offset;
  const auto ball = functions.seen(begin, pose);
  functions.enter(ball.state.position);
  const Real speed = top_speed(ball.velocity, query.length);
  if constexpr (is_body)
    if (const Real clear = clear_time(functions, ball.state.position, speed, query.length);
        clear > 0)
      return Answer::none(clear);
  const Walls reachable = within_reach(functions, ball.state.position, speed, query.length);
  if (!any_from(reachable, 0)) return Answer::none(query.length);
  return first_contact<false>(functions, functions.start(begin, pose, ball), reachable, speed,
      smooth(query, functions, ball.state.position, speed), nullptr);
}

/// Removes the walls, most of them, that the start proves not to be hit within `length`.
/// @return true if any wall is left; `length` is then shortened to the window that must be searched
template <Motion M, Vessel V>
bool WallSearch<M, V>::drop_clear(const auto& curve_of, Walls& reachable, Real& length,
    const DerivativeBounds<V>& derivatives) const {
  const Real whole = length;
  bool any = false;
  for (int wall = 0; wall < model::function_count(mill_.vessel); ++wall) {
    if (!reachable[wall]) continue;
    const Curve curve = curve_of(wall, derivatives);
    const Point& start = curve.start;
    reachable[wall] = !proven_clear(start, curve.curvature, whole, curve.bounds);
    if (!reachable[wall]) continue;
    any = true;
    // The window can end a little after the first possible contact, but not so early that rounding
    // hides the contact of a ball that touches the wall.
    Point hinted = start;
    const Real& error = curve.bounds.value_error;
    if (start.slope < 0 && start.value < 8 * error) hinted.value += 4 * error;
    const auto hint = static_cast<Real>(first_root_hint(hinted, curve.curvature, whole) * 9 / 8);
    if (hint < length && hint > 64 * resolution()) length = hint;
  }
  return any;
}

template <Motion M, Vessel V>
template <bool rounded>
auto WallSearch<M, V>::first_contact(const Functions& functions, const Start& first,
    Walls reachable, const Real& speed, const Query& query, RoughAnswer* rough) const -> Answer {
  const Real begin = query.begin.offset, oldest = functions.elapsed(begin + query.length);
  const auto own_errors = functions.errors(oldest, speed, reachable);
  auto errors = own_errors;
  if constexpr (rounded) errors = errors + functions.state_errors(oldest, speed);
  const auto curve_of = [&](int wall, const DerivativeBounds<V>& derivatives) {
    const auto& d = derivatives[functions.room().kind_of(wall)];
    const Bounds bounds{
        d[0], d[1], d[2], errors.gap[wall], errors.rate[wall], errors.curvature[wall]};
    const Point start{first.offset, first.gap[wall], first.rate[wall]};
    return Curve{functions, wall, bounds, start, first.curvature[wall]};
  };
  Real length = query.length;
  if (!drop_clear(curve_of, reachable, length, bounds_.at(speed, query.length)))
    return Answer::none(query.length);

  const auto derivatives = bounds_.at(speed, length);
  Real end = begin + length;
  Sample last = sample_of_end(functions, reachable, errors, begin, end);
  auto answer = Answer::none(end - begin);
  Root best{};
  bool by_rule = false;
  for (int wall = 0; wall < model::function_count(mill_.vessel); ++wall) {
    if (!reachable[wall]) continue;
    const Curve curve = curve_of(wall, derivatives);
    const Point right = curve.of(last);
    Bracket found = isolate_from_start<rounded>(curve, right);
    if (!rounded && (found.verdict == Verdict::undecided || is_widest)) [[unlikely]]
      found = isolate_further(curve, right, query, end, found);
    by_rule |= found.by_rule;
    if (found.verdict == Verdict::none) continue;
    // The bracket contains the root of the wide gap, too, only if the gap is positive at the start.
    const bool doubtful = rounded && !(found.left.value > curve.bounds.value_error);
    if (found.verdict == Verdict::undecided || doubtful) return {Verdict::undecided};
    auto root = polish(curve, found);
    if (is_widest && !root) {
      root = Root{found.left.t, found.right.t - found.left.t};
      by_rule = true;
    }
    if (!root) return {Verdict::undecided};
    if (answer.verdict == Verdict::contact) {
      const auto before = comes_first<rounded>(query, wall, *root, answer.wall, best, by_rule);
      if (!before) return {Verdict::undecided};
      if (!*before) continue;
    }
    best = *root;
    const auto time = mill_.clock.instant(query.begin.period, best.t);
    answer = Answer::contact(wall, time, best.time_error);
    if constexpr (rounded)
      *rough = {.wall = wall,
          .left = found.left.t,
          .right = found.right.t,
          .root = root->t,
          .error = own_errors.gap[wall]};
    if (!any_from(reachable, wall + 1)) break;
    // Later walls matter up to a little past this root.
    const Real behind = root->t + root->time_error + longest_window() * rounding_margin<Real>();
    if (behind < end) {
      end = behind;
      last = sample_of_end(functions, reachable, errors, root->t, end);
    }
  }
  answer.by_rule = by_rule;
  if constexpr (model::HasRegions<V>)
    if (answer.verdict == Verdict::contact && answer.wall >= mill_.vessel.wall_count())
      return Answer::none(best.t - begin);  // another region: must be searched again
  return answer;
}

/// Samples the gaps at the end of a window. One that is zero within rounding there would leave the
/// window undecided in every scalar: the end is moved towards `from`. One that is zero at two
/// successive ends stays zero for long, so that a shorter window does not help.
template <Motion M, Vessel V>
auto WallSearch<M, V>::sample_of_end(const Functions& functions, const Walls& reachable,
    const Errors& errors, const Real& from, Real& end) const -> Sample {
  const auto touches = [&](const Sample& sample, int wall) {
    const Real &gap = sample.gap[wall], &error = errors.gap[wall];
    return reachable[wall] & (gap <= error) & (gap >= -error);
  };
  const int count = model::function_count(mill_.vessel);
  const Real whole = end;
  Sample sample = functions(end);
  for (int tries = 0; tries < 8; ++tries) {
    bool touched = false;
    for (int wall = 0; wall < count; ++wall) touched |= touches(sample, wall);
    if (!touched) break;
    end = from + (end - from) * 3 / 4;
    const Sample shorter = functions(end);
    bool again = false, new_one = false;
    for (int wall = 0; wall < count; ++wall) {
      again |= touches(shorter, wall);
      new_one |= touches(shorter, wall) & !touches(sample, wall);
    }
    if (again && !new_one) return functions(end = whole);
    sample = shorter;
  }
  return sample;
}

/// Isolates a root in the first part of a window, where the second derivative is known too.
template <Motion M, Vessel V>
template <bool rounded>
auto WallSearch<M, V>::isolate_from_start(const Curve& curve, const Point& right) const -> Bracket {
  const Point& start = curve.start;
  const Bounds& b = curve.bounds;
  if (start.value > b.value_error) return isolate(curve, start, right);
  const bool level = start.slope <= 2 * b.slope_error && start.slope >= -2 * b.slope_error;
  if (level) return isolate_resting(curve, right);
  if constexpr (!rounded)
    if (const auto hop = isolate_hop(curve, right)) return *hop;
  if constexpr (is_widest && !rounded)
    if (start.slope > b.slope_error && curve.curvature > b.curvature_error)
      return isolate_rising(curve, right);
  return isolate(curve, start, right);
}

/// A rising gap keeps rising while its second derivative is positive: one long step suffices at
/// first, also from an overlap; where the third derivative is zero, for the whole window.
template <Motion M, Vessel V>
auto WallSearch<M, V>::isolate_rising(const Curve& curve, const Point& right) const -> Bracket {
  const Bounds& b = curve.bounds;
  const Real t = curve.start.t + (curve.curvature - b.curvature_error) / (2 * b.third);
  return t < right.t ? isolate(curve, curve.at(t), right) : Bracket{Verdict::none};
}

/// Isolates the root for a ball that has just left the wall and whose gap is provably concave
/// throughout the window: the gap has one maximum and one root after it.
template <Motion M, Vessel V>
auto WallSearch<M, V>::isolate_hop(const Curve& curve, const Point& right) const
    -> std::optional<Bracket> {
  const Bounds& b = curve.bounds;
  const Point& left = curve.start;
  const Real length = right.t - left.t;
  const bool bends = curve.curvature + b.curvature_error + b.third * length < 0;
  const bool ends_below = right.value < -b.value_error && right.slope < -b.slope_error;
  if (!(bends & ends_below) || left.value < -b.value_error || !can_depart(left, b))
    return std::nullopt;
  const auto fraction = static_cast<Real>(last_root_hint(left, right, 1e-4));
  return Bracket{Verdict::contact, left, right, Real(0), left.t + fraction * length};
}

template <Motion M, Vessel V>
auto WallSearch<M, V>::isolate(const Curve& curve, Point left, const Point& last) const -> Bracket {
  const Bounds& b = curve.bounds;
  if (left.value > b.value_error) {
    if (proven_positive(left, last, b)) return {Verdict::none};
    return isolate_outside(curve, left, last, false);
  }
  if (left.value < -b.value_error) {
    if (left.slope < -b.slope_error)
      return {.verdict = Verdict::contact, .left = left, .right = left, .at_once = true};
    if (left.slope > b.slope_error) return follow_overlap(curve, left, last);
    return {Verdict::undecided};
  }
  if (can_depart(left, b)) {
    // A window that another wall has shortened may end before the gap is provably open.
    if (proven_departure(left, last, b) || proven_increasing(left, last, b)) return {Verdict::none};
    return isolate_outside(curve, left, last, true);
  }
  if (left.slope < -2 * b.slope_error) return isolate_touching(curve, left, last);
  return {proven_increasing(left, last, b) ? Verdict::none : Verdict::undecided};
}

/// Walks the window from the left over intervals that are proven free of contact, splitting where
/// the proof fails, up to one that contains exactly one sign change.
template <Motion M, Vessel V>
auto WallSearch<M, V>::isolate_outside(
    const Curve& curve, Point left, const Point& right, bool departing) const -> Bracket {
  constexpr int deepest = 64;
  std::array<Point, deepest> ends;  // right ends of intervals still to be searched, nearest last
  int count = 0;
  ends[count++] = right;
  const Bounds& b = curve.bounds;
  for (int steps = 1; count > 0; ++steps) {
    if (steps % 32 == 0) {
      Interruption::check();
      // A gap that hardly changes is excluded on short windows only.
      if (steps >= curve.most_steps) return {Verdict::undecided};
      if (steps == 64 && has_exact_gap(mill_, curve.wall)) return {Verdict::undecided};
    }
    const Point& end = ends[count - 1];
    if (departing ? proven_departure(left, end, b) : proven_positive(left, end, b)) {
      left = end;
      departing = false;
      --count;
      continue;
    }
    if (!departing && end.value < -b.value_error && proven_decreasing(left, end, b))
      return {Verdict::contact, left, end};

    const Real s = end.t - left.t;
    if (count == deepest || s < 16 * resolution()) return {Verdict::undecided};
    double fraction = 0.5;
    if (end.value < 0 && end.slope < 0) {
      const double root = last_root_hint(left, end);
      if (root > 0 && root < 1) {
        constexpr double margin = 1.0 / 32;
        if (4 * root < 1)
          fraction = 2 * root;  // a near root in a long window: cut the window first
        else if (departing)
          fraction = root * 7 / 8;
        else
          fraction = root > 2 * margin ? root - margin : root / 2;
      }
    }
    // A cut at which the gap is zero within rounding decides nothing: move it.
    const auto vanishes = [&](const Point& p) {
      return p.value <= b.value_error && p.value >= -b.value_error;
    };
    Point cut = curve.at(left.t + static_cast<Real>(fraction) * s);
    for (int tries = 0; tries < 4 && vanishes(cut); ++tries) {
      fraction = fraction * 3 / 4;
      cut = curve.at(left.t + static_cast<Real>(fraction) * s);
    }
    if (vanishes(cut) || !(cut.t > left.t && cut.t < end.t)) return {Verdict::undecided};
    ends[count++] = cut;
  }
  return {Verdict::none};
}

/// The gap is zero within rounding and falling at the start: the contact is at the start or within
/// rounding after it, provided that the gap provably falls to a negative value.
template <Motion M, Vessel V>
auto WallSearch<M, V>::isolate_touching(const Curve& curve, const Point& left, Point right) const
    -> Bracket {
  const Bounds& b = curve.bounds;
  // If another wall has shortened the window, extend it to where this gap is certainly negative.
  if (const Real s = 16 * resolution() - 8 * b.value_error / left.slope; right.t - left.t < s)
    right = curve.at(left.t + s);
  while (!proven_decreasing(left, right, b)) {
    const Real s = (right.t - left.t) / 2;
    if (s < 16 * resolution()) return {Verdict::undecided};
    right = curve.at(left.t + s);
  }
  if (!(right.value < -b.value_error)) return {Verdict::undecided};
  // The widest scalar treats a value that is zero within rounding as zero.
  if (is_widest || left.value <= 0) return {Verdict::contact, left, left};
  return {Verdict::contact, left, right};
}

/// The gap is zero within rounding at the start and neither falls nor rises: the second derivative
/// decides. A ball pressed against the wall is in contact at once. One that accelerates away may
/// approach at first; for the widest scalar values within rounding are zero, so that it leaves.
template <Motion M, Vessel V>
auto WallSearch<M, V>::isolate_resting(const Curve& curve, const Point& right) const -> Bracket {
  using std::sqrt;
  const Bounds& b = curve.bounds;
  const Point& left = curve.start;
  if (b.second == 0 && b.slope_error == 0) return {Verdict::none};  // at rest for ever
  const Real bend = (magnitude(curve.curvature) - b.curvature_error) / 2;
  if (!(bend > 0)) return {Verdict::undecided};
  // From `until` on, bend s^2/2 exceeds the rounding of value and slope, while |f''| > bend.
  const bool overlaps = left.value < -b.value_error;
  const Real slope = magnitude(left.slope) + b.slope_error,
             value = overlaps ? Real(0) : Real(magnitude(left.value) + b.value_error);
  const Real until = (slope + sqrt(slope * slope + 4 * bend * value)) / bend;
  if (!(b.third * (2 * until) <= bend)) return {Verdict::undecided};
  if (curve.curvature < 0) return {Verdict::contact, left, left, until + resolution()};
  if constexpr (!is_widest) return {Verdict::undecided};
  return isolate_rising(curve, right);
}

/// Follows a ball that certainly overlaps the wall at the start, by rounding, and moves away: the
/// gap opens, and the search continues from outside, or the ball turns back: this is the contact.
template <Motion M, Vessel V>
auto WallSearch<M, V>::follow_overlap(
    const Curve& curve, const Point& start, const Point& right) const -> Bracket {
  using std::sqrt;
  const Bounds& b = curve.bounds;
  // See PairSearch::tie_window.
  const Real sharp = sqrt(epsilon<Real>()) * mill_.clock.period() / 8;
  Point left = start;
  Real step = left.slope / (2 * b.second);
  Real before = step;
  bool rose = false;
  int setbacks = 0;  // if the gap hardly changes, steps neither grow nor shrink
  for (int k = 0; k < 5 * curve.most_steps && setbacks < 16; ++k) {
    if constexpr (is_wide) Interruption::check();
    const Real t = left.t + step;
    const bool last = !(t < right.t);
    const Point next = last ? right : curve.at(t);
    if (proven_increasing(left, next, b)) {
      if (last) return {Verdict::none};
      if (!(next.value < -b.value_error)) return isolate(curve, next, right);
      if (!(next.t > left.t)) return {Verdict::undecided};
      left = next;
      step = 2 * step;
      rose = true;
      continue;
    }
    setbacks += rose;
    rose = false;
    if (step < before * 3 / 4 || step > before * 4 / 3) setbacks = 0;
    before = step;
    const bool turned = next.slope < -b.slope_error && next.value < -b.value_error;
    if (turned && step * 65536 < next.t - start.t && step < sharp)
      return {Verdict::contact, next, next, step + resolution()};
    if (step < resolution())
      return turned ? Bracket{Verdict::contact, next, next, 2 * resolution()}
                    : Bracket{Verdict::undecided};
    step = step / 2;
  }
  return {Verdict::undecided};
}

/// Refines the root in the bracket to the last digit of the scalar; the result is the end of the
/// final bracket at which the gap is not negative.
template <Motion M, Vessel V>
auto WallSearch<M, V>::polish(const Curve& curve, const Bracket& bracket) const
    -> std::optional<Root> {
  const Point &left = bracket.left, &right = bracket.right;
  if (bracket.at_once) return Root{.t = left.t, .time_error = Real(0), .at_once = true};
  if (bracket.time_error > 0) return Root{.t = left.t, .time_error = bracket.time_error};
  const auto time_error_at = [&](const Real& slope) {
    return resolution() + (slope < 0 ? Real(-4 * curve.bounds.value_error / slope) : Real(0));
  };
  const bool hop = bracket.guess > 0;
  if (!hop && (left.t == right.t || left.value <= 0))
    return Root{.t = left.t, .time_error = time_error_at(left.slope)};
  if (hop || (left.slope < 0 && right.slope < 0)) {
    const Real width = right.t - left.t;
    const Real& third = curve.bounds.third;
    const Approach approach{hop ? bracket.guess : inverse_cubic_hint(left, right),
        static_cast<double>((right.slope - left.slope) / width), static_cast<double>(third * width),
        static_cast<double>(third)};
    if (const auto root = close_in(
            curve.functions, curve.wall, left.t, right.t, approach, curve.bounds.value_error))
      return root;
  }
  if (hop) {  // the peak is so low that rounding hides it: cut it off
    const Bracket behind = isolate_outside(curve, left, right, true);
    if (behind.verdict != Verdict::contact) return std::nullopt;
    return polish(curve, behind);
  }
  const auto gap = [&](const Real& t) { return Real(curve.at(t).value); };
  std::uintmax_t iterations = 500;
  const auto root = boost::math::tools::toms748_solve(
      gap, left.t, right.t, left.value, right.value, closed(), iterations);
  EDMILL_REQUIRE(iterations < 500, "root polishing ran out of iterations");
  const Point end = curve.at(root.first);
  EDMILL_REQUIRE(end.value >= 0, "root polishing lost the sign change");
  return Root{root.first, time_error_at(end.slope)};
}

/// Sets the digits, where a scalar has many, for a step of Newton's iteration from a double root.
template <class Real> auto digits_of_step(int step) {
  ChosenDigits<Real> digits;
  if constexpr (requires { digits.digits; }) {
    constexpr unsigned first = 64;  // of the step from 16 to 45 right digits
    if (step < 15 && !double_hints<Real>()) digits.digits = std::min(digits.digits, first << step);
  }
  return digits.use();
}

/// Finds the root of a gap that provably falls through zero in (from, to): by Newton's iteration
/// with the curvature until another step would change nothing, then by toms748 in a bracket of a
/// few units of the clock. Empty if rounding hides the signs at the ends of such a bracket.
template <Motion M, Vessel V>
auto WallSearch<M, V>::close_in(const Functions& functions, int wall, const Real& from,
    const Real& to, const Approach& approach, const Real& value_error) const
    -> std::optional<Root> {
  const Real unit = epsilon<Real>() * mill_.clock.period();
  const bool few_digits = double_hints<Real>();
  const int all_digits = binary_digits<Real>();
  Real t = approach.guess;
  auto pose = [&] {
    [[maybe_unused]] const auto few = digits_of_step<Real>(0);
    return functions.pose(t);
  }();
  const auto pose_at = [&](const Real& time) { return functions.pose_nearby(time, pose, t); };
  const int steps = few_digits ? 8 : 40;  // each doubles the digits
  for (int step = 0; step < steps; ++step) {
    if (!(t > from && t < to)) return std::nullopt;
    // A step that doubles the correct digits needs no more digits than these.
    [[maybe_unused]] const auto few = digits_of_step<Real>(step);
    if (!few_digits) pose = functions.pose(t);
    const auto sample = functions(t, pose);
    const Real& slope = sample.rate[wall];
    const double flatness = static_cast<double>(slope);
    if (!(flatness < 0)) return std::nullopt;
    const Real newton = -sample.gap[wall] / slope;
    // The contribution of the curvature to the step; true if another step would change the time.
    const auto bent = [&](const auto& size) -> std::pair<Real, bool> {
      using Size = std::decay_t<decltype(size)>;
      const Size square = size * size, length = size < 0 ? -size : size;
      const Size off = (approach.curvature_error + approach.third * length) * square;
      const bool goes_on = off > -flatness * static_cast<Size>(unit);
      return {Real(approach.curvature * square / (2 * flatness)), goes_on};
    };
    const auto [bend, goes_on] =
        few_digits ? bent(static_cast<double>(newton)) : bent(static_cast<Hint<Real>>(newton));
    const Real centre = t + (newton - bend);
    if (goes_on || binary_digits<Real>() < all_digits) {
      if (few_digits) pose = pose_at(centre);
      t = centre;
      continue;
    }
    const auto gap = [&](const Real& time) { return functions.gap_nearby(wall, time, pose, t); };
    const Real time_error = -value_error / slope;
    // Rounding shifts the sign change of the computed gap: widen until both signs occur.
    Real low = centre - 4 * unit, high = centre + 4 * unit, at_low = gap(low), at_high = gap(high);
    for (Real reach = 16 * unit; !(at_low >= 0 && at_high <= 0); reach = 4 * reach) {
      if (reach > 32 * (unit + time_error)) return std::nullopt;
      if (at_low < 0) {
        high = low;
        at_high = at_low;
        low = centre - reach;
        at_low = gap(low);
      } else {
        low = high;
        at_low = at_high;
        high = centre + reach;
        at_high = gap(high);
      }
    }
    if (!(low > from && high < to)) return std::nullopt;
    using boost::math::tools::toms748_solve;
    std::uintmax_t iterations = 100;
    const auto bracket = toms748_solve(gap, low, high, at_low, at_high, closed(), iterations);
    Root found{bracket.first, resolution() + 4 * time_error};
    if constexpr (is_wide) found.pose = pose_at(found.t);
    return found;
  }
  return std::nullopt;
}

template <Motion M, Vessel V> RoughAnswer WallSearch<M, V>::rough(const Query& query) const {
  if constexpr (is_wide) {
    return {};
  } else {
    require_length(query);
    Functions functions(mill_, query.flight, query.radius, query.begin.period);
    RoughAnswer rough;
    const Real begin = query.begin.offset;
    const auto pose = functions.pose(begin);
    const auto ball = functions.seen(begin, pose);
    const int region = functions.enter(ball.state.position);
    const Real speed = top_speed(ball.velocity, query.length);
    auto reachable = model::active_functions(functions.room(), ball.state.position);
    if constexpr (is_body) {
      const Real clear = clear_time(functions, ball.state.position, speed, query.length);
      if (clear > 0)
        return {.verdict = Verdict::none, .until = (begin + clear) * (1 - epsilon<Real>())};
      reachable = within_reach(functions, ball.state.position, speed, query.length);
    }
    const auto answer = first_contact<true>(functions, functions.start(begin, pose, ball),
        reachable, speed, smooth(query, functions, ball.state.position, speed), &rough);
    rough.region = region;
    rough.verdict = answer.verdict;
    // The sum is rounded, and the window was proven up to its exact or its rounded end.
    if (answer.verdict == Verdict::none)
      rough.until = (begin + answer.searched) * (1 - epsilon<Real>());
    if (answer.verdict == Verdict::contact) {
      const auto derivatives = bounds_.at(speed, query.length);
      const auto errors = functions.errors(functions.elapsed(begin + query.length), speed);
      rough.curvature = functions.start(rough.root).curvature[rough.wall];
      rough.curvature_error = errors.curvature[rough.wall];
      rough.third = derivatives[functions.room().kind_of(rough.wall)][1];
    }
    return rough;
  }
}

/// Evaluates the wide gap at the root found in double, whose error is of the order of double's
/// rounding: one step of Newton's iteration with the curvature in double yields nearly three times
/// the digits. The result is the root in the bracket, because the gap falls throughout it.
template <Motion M, Vessel V>
auto WallSearch<M, V>::search_by_double(const Query& query) const -> Answer {
  if constexpr (!is_wide) {
    return search(query);
  } else {
    EDMILL_REQUIRE(query.length > 0, "window length out of range");
    // The window is rounded outwards, so that no part of it must be searched again.
    const auto begin_down = rounded_down<double>(query.begin);
    const auto length = static_cast<double>(query.length);
    const double longer = length + 4 * epsilon<double>() * (begin_down.offset + length);
    const auto rough = rough_.rough(
        {flight_cast<double>(query.flight), static_cast<double>(query.radius), begin_down, longer});
    const Real& begin = query.begin.offset;
    if (rough.verdict == Verdict::none) {
      const Real searched = Real(rough.until) - begin;
      if (searched > 0) return Answer::none(searched);
    }
    if (rough.verdict != Verdict::contact) return {Verdict::undecided};

    Functions functions(mill_, query.flight, query.radius, query.begin.period);
    const auto place = [&](const Real& t) {
      return functions.seen(t, functions.pose(t)).state.position;
    };
    if constexpr (is_body)
      if (functions.enter(place(Real(rough.root))) != rough.region) return {Verdict::undecided};
    const Real left(rough.left);
    const auto unit = static_cast<Hint<Real>>(epsilon<Real>()) / epsilon<double>();
    const Real error(rough.error * unit);  // bounds are proportional to epsilon
    const Approach approach{Real(rough.root), rough.curvature, rough.curvature_error, rough.third};
    const auto root = close_in(
        functions, rough.wall, left > begin ? left : begin, Real(rough.right), approach, error);
    if (!root) return {Verdict::undecided};
    if constexpr (model::HasRegions<V>)  // this scalar's regions are sharper
      if (!functions.room().is_valid(rough.wall, place(root->t))) return {Verdict::undecided};
    const auto time = mill_.clock.instant(query.begin.period, root->t);
    auto answer = Answer::contact(rough.wall, time, root->time_error);
    answer.pose = root->pose;
    return answer;
  }
}

// Decisions that bounds cannot make: by exact arithmetic or by a rule.

/// Finds the first contact with one wall up to `end` where the bounds do not decide, or, in the
/// widest scalar, the ball touches: exactly, where possible, or by a rule. @param found  by bounds
template <Motion M, Vessel V>
auto WallSearch<M, V>::isolate_further(const Curve& curve, const Point& right, const Query& query,
    const Real& end, const Bracket& found) const -> Bracket {
  const bool undecided = found.verdict == Verdict::undecided;
  // Exact arithmetic needs no rule for values that are zero within rounding.
  if (undecided || curve.start.value <= curve.bounds.value_error)
    if (const auto gap = exact_gap(mill_, query, curve.wall)) {
      const auto time = exact_contact_time(*gap);
      if (!time) return {Verdict::none};
      const Point at{query.begin.offset + time->template rounded_down<Real>(), Real(0), Real(0)};
      if (at.t > end) return {Verdict::none};
      const bool at_once = time->compare({}) == 0;
      return {Verdict::contact, at, at, resolution(), Real(0), at_once};
    }
  if constexpr (is_widest)
    if (undecided) return isolate_by_rule(curve, right);
  return found;
}

/// True if `wall` is hit before `other`. If the times agree within rounding, exact arithmetic
/// decides; if it does not apply, the result is empty and a wider scalar must decide. If the times
/// are equal, or the widest scalar does not separate them, the rule puts `other` first.
template <Motion M, Vessel V>
template <bool rounded>
std::optional<bool> WallSearch<M, V>::comes_first(const Query& query, int wall, const Root& root,
    int other, const Root& other_root, bool& by_rule) const {
  const Real later = root.t - other_root.t, error = root.time_error + other_root.time_error;
  if (later > error) return false;
  if (later < -error) return true;
  std::optional<int> order;
  if constexpr (!rounded)
    order = exact_order(mill_, query, wall, root.at_once, other, other_root.at_once);
  if (!order && !is_widest) return std::nullopt;
  by_rule |= (!order || *order == 0) && wall < mill_.vessel.wall_count();
  return order && *order < 0;
}

/// For gaps that neither the widest scalar nor, since they are no polynomials, exact arithmetic
/// decides: they are zero within rounding, or change too slowly. By the rule a gap which does not
/// measurably fall does not fall. It is evaluated at times after the start that grow by factors of
/// 16; if it falls before it has opened, the contact is at the evaluation before.
template <Motion M, Vessel V>
auto WallSearch<M, V>::isolate_by_rule(const Curve& curve, const Point& right) const -> Bracket {
  const Bounds& b = curve.bounds;
  const Point& start = curve.start;
  Curve rest = curve;
  rest.most_steps = 2;
  Point last = start;
  unsigned openings = 0;
  for (Real step = 16 * resolution(); last.t < right.t; step = 16 * step) {
    Interruption::check();
    const Real t = start.t + step;
    const Point next = t < right.t ? curve.at(t) : right;
    const bool opens = next.value > b.value_error || next.slope > 2 * b.slope_error;
    if (next.slope < -2 * b.slope_error && !opens) {
      Bracket found{Verdict::undecided};
      if (last.value > b.value_error) found = isolate(curve, last, next);
      if (found.verdict == Verdict::undecided)
        found = {.verdict = Verdict::contact,
            .left = last,
            .right = last,
            .time_error = next.t - last.t};
      found.by_rule = true;
      return found;
    }
    if (opens && next.t < right.t && std::has_single_bit(++openings)) {  // can the rest be decided?
      auto found = isolate(rest, next, right);
      found.by_rule = true;
      if (found.verdict != Verdict::undecided) return found;
    }
    last = next;
  }
  return {.verdict = Verdict::none, .by_rule = true};
}

/// The first contact with the vessel or a body. Each body is searched window by window as far as
/// the others have been. Where the times of two contacts are closer than their errors a wider
/// scalar decides; in the widest, the lower id goes first by a rule.
/// @param first  answer for the vessel
template <class Real>
auto AnyWallSearch<Real>::with_bodies(const Query& query, Answer first) const -> Answer {
  const auto& mill = bodies_.front().mill();
  const DriveClock<Real>& clock = mill.clock;
  const Real dt = clock.elapsed(query.flight.start, query.begin);
  const Real speed =
      norm<Real>(velocity_after(query.flight, mill.gravity, dt)) + mill.gravity_size * query.length;
  const auto clear = groups_.clear_times(instant_cast<double>(query.begin),
      vector_cast<double>(position_after(query.flight, mill.gravity, dt)),
      static_cast<double>(query.radius), static_cast<double>(speed));
  for (std::size_t k = 0; k < bodies_.size() && first.verdict != Verdict::undecided; ++k) {
    // Contacts up to a little past the first one matter.
    const bool none_yet = first.verdict == Verdict::none;
    const Real needed = none_yet ? std::min(query.length, first.searched)
                                 : Real(clock.elapsed(query.begin, first.time) + first.time_error);
    const Real beyond = needed + longest_window_ * rounding_margin<Real>();
    const Real whole = none_yet ? needed : std::min(query.length, beyond);
    if (clear[k] >= whole) continue;
    const auto found = first_with_body(k, query, whole, Real(clear[k]));
    if (found.verdict == Verdict::undecided) return found;
    const bool by_rule = first.by_rule || found.by_rule;
    if (found.verdict == Verdict::none) {
      if (found.searched < needed) first = Answer::none(found.searched);
    } else if (none_yet) {
      first = found;
    } else {
      const Real later = clock.elapsed(first.time, found.time),
                 error = found.time_error + first.time_error;
      const bool tied = !(later > error) && !(later < -error);
      if (tied && !std::is_void_v<Wider<Real>>) return {Verdict::undecided};
      if (later < -error) first = found;
      first.by_rule = by_rule || tied;
      continue;
    }
    first.by_rule = by_rule;
  }
  return first;
}

/// The first contact with a body within `length` of the begin of a query. None, too, if it takes
/// too many windows to find. @param clear  so long it is out of reach [s]
template <class Real>
auto AnyWallSearch<Real>::first_with_body(
    std::size_t body, const Query& query, const Real& length, const Real& clear) const -> Answer {
  constexpr int most_windows = 64;
  const DriveClock<Real>& clock = bodies_.front().mill().clock;
  auto rest = query;
  Real searched = clear > length / 64 ? clear : Real(0);
  if (searched > 0) rest.begin = clock.after(query.begin, searched);
  rest.length = length - searched;
  bool by_rule = false;
  for (int windows = 0; windows < most_windows && rest.length > 0; ++windows) {
    auto found = [&] {
      if constexpr (is_double)
        return bodies_[body].search(rest);
      else
        return bodies_[body](rest);
    }();
    found.by_rule = by_rule = by_rule || found.by_rule;
    if (found.verdict == Verdict::contact) {
      found.wall = walls_ + static_cast<int>(body);
      found.pose = {};
    }
    if (found.verdict != Verdict::none) return found;
    // A border so near that the next search would begin before it: a wider scalar goes beyond it.
    if (found.searched < rest.length && found.searched < 64 * epsilon<Real>() * clock.period()) {
      if (!std::is_void_v<Wider<Real>>) return {Verdict::undecided};
      break;
    }
    searched += found.searched;
    rest.begin = clock.after(query.begin, searched);
    rest.length = length - searched;
  }
  auto none = Answer::none(rest.length > 0 ? searched : length);
  none.by_rule = by_rule;
  return none;
}

}  // namespace edmill::dynamics
