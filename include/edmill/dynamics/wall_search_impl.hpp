// Implementation of WallSearch; included by the instantiation files only.
#pragma once

#include <array>
#include <type_traits>

#include "edmill/core/errors.hpp"
#include "edmill/dynamics/wall_search.hpp"

namespace edmill::dynamics {

template <class Real>
WallAnswer<Real> WallSearch<Real>::search(const GapFunctions<Real>& functions, const GapSample<Real>& first,
                                          const WallQuery<Real>& query) const {
  EDMILL_REQUIRE(query.length > 0 && query.length <= longest_window() * (1 + Real(1) / 1048576),
                 "window length out of range");
  Real end = query.begin.offset + query.length;
  GapSample<Real> last = functions(end);

  const Vec3<Real> velocity =
      velocity_after(query.flight, constants_.mill.gravity, functions.elapsed(query.begin.offset));
  const Real speed = norm<Real>(velocity) + constants_.gravity * query.length;
  const auto derivatives = bounds_.at(speed, query.length);
  const auto errors = functions.errors(functions.elapsed(end), speed);

  WallAnswer<Real> answer;
  for (int wall = 0; wall < model::wall_count; ++wall) {
    const auto& d = wall == 2 ? derivatives.q : derivatives.y;
    const Curve curve{functions, wall, {d[0], d[1], d[2], errors.gap[wall], errors.rate[wall]}};
    const Bracket found = isolate(curve, curve.of(first), curve.of(last));
    if (found.verdict == Verdict::none) continue;
    if (found.verdict == Verdict::undecided) return {Verdict::undecided};
    const Real root = found.left.t == found.right.t ? found.left.t : polish(curve, found.left, found.right);
    if (answer.verdict == Verdict::contact && root >= end - 2 * resolution()) {
      // Two walls at one time within rounding: a wider scalar decides; at the top the lower id comes first.
      if constexpr (!std::is_void_v<Wider<Real>>) return {Verdict::undecided};
      answer.tie = true;
      continue;
    }
    answer = {Verdict::contact, wall, constants_.clock.instant(query.begin.period, root)};
    if (wall + 1 < model::wall_count) {
      end = root + resolution();  // later walls are of interest up to here
      if (end > query.begin.offset + query.length) end = query.begin.offset + query.length;
      if (!(end > query.begin.offset)) break;
      last = functions(end);
    }
  }
  return answer;
}

template <class Real>
auto WallSearch<Real>::isolate(const Curve& curve, Point left, const Point& right) const -> Bracket {
  const Bounds& b = curve.bounds;
  if (left.value > b.value_error) {
    if (numerics::proven_positive(left, right, b)) return {Verdict::none};
    return isolate_outside(curve, left, right, false);
  }
  if (left.value < -b.value_error) {
    if (left.slope < -b.slope_error) return {Verdict::contact, left, left};
    if (left.slope > b.slope_error) return follow_overlap(curve, left, right);
    return {Verdict::undecided};
  }
  if (numerics::can_depart(left, b)) {
    if (numerics::proven_departure(left, right, b)) return {Verdict::none};
    return isolate_outside(curve, left, right, true);
  }
  if (left.slope < -2 * b.slope_error) return isolate_touching(curve, left, right);
  return {Verdict::undecided};
}

/// Walks the window from the left over intervals that are proven free of contact, splitting where the proof
/// fails, up to one that holds exactly one sign change.
template <class Real>
auto WallSearch<Real>::isolate_outside(const Curve& curve, Point left, const Point& right,
                                       bool departing) const -> Bracket {
  constexpr int deepest = 64;
  std::array<Point, deepest> ends;  // right ends of intervals still to be looked at, nearest last
  int count = 0;
  ends[count++] = right;
  const Bounds& b = curve.bounds;
  while (count > 0) {
    const Point& end = ends[count - 1];
    if (departing ? numerics::proven_departure(left, end, b) : numerics::proven_positive(left, end, b)) {
      left = end;
      departing = false;
      --count;
      continue;
    }
    if (!departing && end.value < -b.value_error && numerics::proven_decreasing(left, end, b))
      return {Verdict::contact, left, end};

    const Real s = end.t - left.t;
    if (count == deepest || s < 16 * resolution()) return {Verdict::undecided};
    Real fraction = Real(1) / 2;
    if (end.value < 0 && end.slope < 0) {
      const Real root = numerics::last_root_hint(left, end);
      if (root > 0 && root < 1) {
        const Real margin = Real(1) / 32;
        if (4 * root < 1)
          fraction = 2 * root;  // a near root in a long window: cut the window first
        else if (departing)
          fraction = root * 7 / 8;
        else
          fraction = root > 2 * margin ? Real(root - margin) : Real(root / 2);
      }
    }
    // A cut within rounding of a root would decide nothing: move off it.
    Point cut = curve.at(left.t + fraction * s);
    for (int tries = 0; tries < 4 && cut.value <= b.value_error && cut.value >= -b.value_error; ++tries) {
      fraction = fraction * 3 / 4;
      cut = curve.at(left.t + fraction * s);
    }
    if (cut.value <= b.value_error && cut.value >= -b.value_error) return {Verdict::undecided};
    if (!(cut.t > left.t && cut.t < end.t)) return {Verdict::undecided};
    ends[count++] = cut;
  }
  return {Verdict::none};
}

/// The start is zero within rounding and falling: the contact is at the start or within rounding after it,
/// once the gap is seen to become negative while it falls.
template <class Real>
auto WallSearch<Real>::isolate_touching(const Curve& curve, const Point& left, Point right) const -> Bracket {
  while (!numerics::proven_decreasing(left, right, curve.bounds)) {
    const Real s = (right.t - left.t) / 2;
    if (s < 16 * resolution()) return {Verdict::undecided};
    right = curve.at(left.t + s);
  }
  if (!(right.value < -curve.bounds.value_error)) return {Verdict::undecided};
  if (left.value <= 0) return {Verdict::contact, left, left};
  return {Verdict::contact, left, right};
}

/// The start is overlapped for certain, by rounding, and leaves. Either the gap opens, and the search goes on
/// outside, or the ball turns back before: the contact is where it begins to approach.
template <class Real>
auto WallSearch<Real>::follow_overlap(const Curve& curve, const Point& start, const Point& right) const
    -> Bracket {
  const Bounds& b = curve.bounds;
  Point left = start;
  Real step = left.slope / (2 * b.second);
  for (int k = 0; k < 400; ++k) {
    Real t = left.t + step;
    const bool last = !(t < right.t);
    const Point next = last ? right : curve.at(t);
    const bool rising = numerics::proven_increasing(left, next, b);
    if (rising) {
      if (next.value > b.value_error) return last ? Bracket{Verdict::none} : isolate(curve, next, right);
      if (last) return {next.value < -b.value_error ? Verdict::none : Verdict::undecided};
      if (!(next.value < -b.value_error) || !(next.t > left.t)) return {Verdict::undecided};
      left = next;
      step = 2 * step;
      continue;
    }
    const bool turned = next.slope < -b.slope_error && next.value < -b.value_error;
    if (turned && step * 65536 < next.t - start.t) return {Verdict::contact, next, next};
    if (step < resolution())
      return turned ? Bracket{Verdict::contact, next, next} : Bracket{Verdict::undecided};
    step = step / 2;
  }
  return {Verdict::undecided};
}

/// The bracket's root to the last digit of the scalar: its end where the gap is not negative.
template <class Real>
Real WallSearch<Real>::polish(const Curve& curve, Point left, Point right) const {
  // Newton from an inverse cubic estimate narrows the bracket to a few ulps.
  if (left.slope < 0 && right.slope < 0 && left.value > 0) {
    Real guess = numerics::inverse_cubic_hint(left, right);
    Real margin = resolution();
    for (int step = 0; step < 8; ++step) {
      if (!(guess > left.t && guess < right.t)) break;
      const Point at_guess = curve.at(guess);
      (at_guess.value < 0 ? right : left) = at_guess;
      if (!(at_guess.slope < 0)) break;
      const Real correction = -at_guess.value / at_guess.slope;
      guess += correction;
      const Real size = correction < 0 ? Real(-correction) : correction;
      if (size * size * 65536 <
          margin * constants_.clock.period()) {  // the next correction is below `margin`
        for (const Real& t : {Real(guess - margin), Real(guess + margin)}) {
          if (!(t > left.t && t < right.t)) continue;
          const Point p = curve.at(t);
          (p.value < 0 ? right : left) = p;
        }
        break;
      }
    }
  }
  if (left.value <= 0) return left.t;
  const auto value = [&](const Real& t) { return Real(curve.at(t).value); };
  const auto adjacent = [](const Real& a, const Real& b) {
    const Real middle = a + (b - a) / 2;
    return middle <= a || middle >= b;
  };
  std::uintmax_t iterations = 500;
  const auto root = boost::math::tools::toms748_solve(value, left.t, right.t, left.value, right.value,
                                                      adjacent, iterations);
  EDMILL_REQUIRE(iterations < 500, "root polishing ran out of iterations");
  EDMILL_REQUIRE(root.first == root.second || (value(root.first) >= 0 && value(root.second) <= 0),
                 "root polishing lost the sign change");
  return root.first;
}

}  // namespace edmill::dynamics
