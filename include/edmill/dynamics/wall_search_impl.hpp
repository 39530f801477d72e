// Implementation of WallSearch; included by the instantiation files only.
#pragma once

#include <array>
#include <type_traits>

#include "edmill/core/errors.hpp"
#include "edmill/dynamics/wall_search.hpp"
#include "edmill/model/nearby_pose.hpp"

namespace edmill::dynamics {

template <class Real>
WallSet WallSearch<Real>::within_reach(const GapFunctions<Real>& functions, const Vec3<Real>& position,
                                       const Real& speed, const Real& length) const {
  // A millionth covers the rounding of all this.
  const Real way =
      (speed + constants_.wall_speed) * length * (1 + Real(1) / 1048576) + constants_.reach / 1048576;
  const Real cap = functions.cap() - way, cylinder = functions.cylinder() - way;
  const Real &x = position[0], &y = position[1], &z = position[2];
  return {!(-y < cap), !(y < cap), !((cylinder > 0) & (x * x + z * z < cylinder * cylinder))};
}

template <class Real>
void WallSearch<Real>::require_length(const WallQuery<Real>& query) const {
  EDMILL_REQUIRE(query.length > 0 && query.length <= longest_window() * (1 + Real(1) / 1048576),
                 "window length out of range");
}

template <class Real>
WallAnswer<Real> WallSearch<Real>::search(const WallQuery<Real>& query) const {
  return search(model::pose_at<Real>(constants_.mill.motion, constants_.angular_speed, constants_.frequency,
                                     query.begin.offset),
                query);
}

template <class Real>
WallAnswer<Real> WallSearch<Real>::search(const model::VesselPose<Real>& pose,
                                          const WallQuery<Real>& query) const {
  require_length(query);
  const Functions functions(constants_, query.flight, query.radius, query.begin.period);
  const Real& begin = query.begin.offset;
  const auto ball = functions.seen(begin, pose);
  const Real speed = top_speed(ball.velocity, query.length);
  const WallSet reachable = within_reach(functions, ball.state.position, speed, query.length);
  if (!(reachable[0] | reachable[1] | reachable[2]))
    return {Verdict::none, -1, {}, false, query.length, Real(0)};
  return first_contact<false>(functions, functions.start(begin, pose, ball), reachable, speed, query,
                              nullptr);
}

template <class Real>
template <bool rounded>
WallAnswer<Real> WallSearch<Real>::first_contact(const Functions& functions, const GapStart<Real>& first,
                                                 WallSet reachable, const Real& speed,
                                                 const WallQuery<Real>& query,
                                                 [[maybe_unused]] RoughAnswer* rough) const {
  const Real begin = query.begin.offset;
  const Real oldest = functions.elapsed(begin + query.length);
  auto errors = functions.errors(oldest, speed);
  [[maybe_unused]] const auto own_errors = errors;
  if constexpr (rounded) errors = errors + functions.state_errors(oldest, speed);
  const auto curve_of = [&](int wall, const DerivativeBounds<Real>& derivatives) {
    const auto& d = wall == 2 ? derivatives.q : derivatives.y;
    return Curve{functions, wall, {d[0], d[1], d[2], errors.gap[wall], errors.rate[wall]}};
  };

  // Of most walls the state at the start alone shows that they are not hit.
  const auto whole = bounds_.at(speed, query.length);
  Real length = query.length;
  bool any = false;
  for (int wall = 0; wall < model::wall_count; ++wall) {
    if (!reachable[wall]) continue;
    const Curve curve = curve_of(wall, whole);
    const Point start = curve.of(first);
    reachable[wall] = !numerics::proven_clear(start, first.curvature[wall], query.length, curve.bounds);
    if (!reachable[wall]) continue;
    any = true;
    // A little beyond the first suspected contact there is nothing to look for.
    const Real hint =
        static_cast<Real>(numerics::first_root_hint(start, first.curvature[wall], query.length) * 9 / 8);
    if (hint < length && hint > 64 * resolution()) length = hint;
  }
  if (!any) return {Verdict::none, -1, {}, false, query.length, Real(0)};

  const auto derivatives = bounds_.at(speed, length);
  Real end = begin + length;
  GapSample<Real> last = functions(end);
  WallAnswer<Real> answer{Verdict::none, -1, {}, false, length, Real(0)};
  Root best{};
  for (int wall = 0; wall < model::wall_count; ++wall) {
    if (!reachable[wall]) continue;
    const Curve curve = curve_of(wall, derivatives);
    const Bracket found = isolate(curve, curve.of(first), curve.of(last));
    if (found.verdict == Verdict::none) continue;
    if (found.verdict == Verdict::undecided) return {Verdict::undecided};
    // Only a start that is outside for certain makes the bracket hold the wide root too.
    if (rounded && !(found.left.value > curve.bounds.value_error)) return {Verdict::undecided};
    const Root root = polish(curve, found.left, found.right);
    if (answer.verdict == Verdict::contact) {
      const Real later = root.t - best.t, doubt = root.doubt + best.doubt;
      if (later > doubt) continue;
      if (later >= -doubt) {
        // Two walls at one time within rounding: a wider scalar decides; at the top the lower id comes first.
        if constexpr (!std::is_void_v<Wider<Real>>) return {Verdict::undecided};
        answer.tie = true;
        continue;
      }
    }
    best = root;
    answer = {Verdict::contact, wall,      constants_.clock.instant(query.begin.period, root.t), false,
              Real(0),          root.doubt};
    if constexpr (rounded)
      *rough = {Verdict::contact, 0, wall, found.left.t, found.right.t, root.t, 0, own_errors.gap[wall]};
    end = root.t + root.doubt;  // later walls are of interest up to here
    if (end > begin + length) end = begin + length;
    const bool more = (wall < 1 && reachable[1]) || (wall < 2 && reachable[2]);
    if (!more || !(end > begin)) break;
    last = functions(end);
  }
  return answer;
}

template <class Real>
RoughAnswer WallSearch<Real>::rough(const WallQuery<Real>& query) const {
  if constexpr (is_wide) {
    return {};
  } else {
    require_length(query);
    const Functions functions(constants_, query.flight, query.radius, query.begin.period);
    const Real begin = query.begin.offset;
    RoughAnswer rough;
    const auto pose = functions.pose(begin);
    const auto ball = functions.seen(begin, pose);
    const auto answer = first_contact<true>(functions, functions.start(begin, pose, ball), {true, true, true},
                                            top_speed(ball.velocity, query.length), query, &rough);
    rough.verdict = answer.verdict;
    // The sum is rounded, and the window was proven up to its exact or its rounded end.
    if (answer.verdict == Verdict::none) rough.until = (begin + answer.searched) * (1 - epsilon<Real>());
    if (answer.verdict == Verdict::contact)
      rough.curvature = functions.start(rough.root).curvature[rough.wall];
    return rough;
  }
}

/// The wide gap is evaluated at the rough root, an error of double away from the root, so that one step of
/// Newton's iteration with the curvature as double knows it gives nearly three times the digits of double.
/// That the place found belongs to the root needs no second sign: the gap falls all along the bracket.
template <class Real>
WallAnswer<Real> WallSearch<Real>::search_by_double(const WallQuery<Real>& query) const {
  if constexpr (!is_wide) {
    return search(query);
  } else {
    EDMILL_REQUIRE(query.length > 0, "window length out of range");
    // The window is rounded outwards, so that nothing of it is left to be asked about again.
    const auto begin_down = rounded_down<double>(query.begin);
    const double length = static_cast<double>(query.length);
    const auto rough =
        rough_.rough({flight_cast<double>(query.flight), static_cast<double>(query.radius), begin_down,
                      length + 4 * epsilon<double>() * (begin_down.offset + length)});
    const Real& begin = query.begin.offset;
    if (rough.verdict == Verdict::none) {
      const Real searched = Real(rough.until) - begin;
      if (searched > 0) return {Verdict::none, -1, {}, false, searched, Real(0)};
    }
    if (rough.verdict != Verdict::contact) return {Verdict::undecided};

    const Functions functions(constants_, query.flight, query.radius, query.begin.period);
    const double unit = static_cast<double>(epsilon<Real>());
    const double ulp = unit * rough_.constants().clock.period();
    const double error = rough.error * (unit / epsilon<double>());  // bounds are proportional to it
    // The bound on the rounding of a gap is several times what it usually is: aim before the root by parts of
    // it, for the event time is where the computed gap is not negative.
    double part = 1.0 / 16;
    Real t(rough.root);
    auto pose = functions.pose(t);
    for (int step = 0; step < 8; ++step) {
      if (!(t > begin && t > rough.left && t < rough.right)) break;
      const auto sample = functions(t, pose);
      const Real &value = sample.gap[rough.wall], &slope = sample.rate[rough.wall];
      const double flatness = static_cast<double>(slope);
      if (!(flatness < 0)) break;
      const Real newton = -value / slope;
      const double size = static_cast<double>(newton), doubt = -error / flatness;
      if (size <= doubt + 4 * ulp && size >= -(doubt + 4 * ulp)) {
        if (value >= 0)
          return {
              Verdict::contact, rough.wall, constants_.clock.instant(query.begin.period, t), false, Real(0),
              Real(doubt),      pose};
        part = 4 * part;
      }
      const Real next =
          t + newton - Real(rough.curvature * (size * size) / (2 * flatness) + (2 * ulp + part * doubt));
      pose = model::pose_nearby<Real>(constants_.mill.motion, constants_.angular_speed, constants_.frequency,
                                      next, pose, t);
      t = next;
    }
    return {Verdict::undecided};
  }
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
    double fraction = 0.5;
    if (end.value < 0 && end.slope < 0) {
      const double root = numerics::last_root_hint(left, end);
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
    // A cut within rounding of a root would decide nothing: move off it.
    Point cut = curve.at(left.t + static_cast<Real>(fraction) * s);
    for (int tries = 0; tries < 4 && cut.value <= b.value_error && cut.value >= -b.value_error; ++tries) {
      fraction = fraction * 3 / 4;
      cut = curve.at(left.t + static_cast<Real>(fraction) * s);
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
///
/// Near the root one evaluation gives a quadratic that is as good as the gap itself; toms748 takes the
/// quadratic's root to adjacent numbers, and the gap's own signs there are checked. Where rounding moves them
/// by some ulps, the bracket is closed on the gap itself.
template <class Real>
auto WallSearch<Real>::polish(const Curve& curve, Point left, Point right) const -> Root {
  const Real t = left.t == right.t ? left.t : polished_root(curve, left, right);
  // The flatter end of what is left of the bracket; a contact at once has no later root to be mistaken for.
  const Real slope = left.slope > right.slope ? left.slope : right.slope;
  return {t, resolution() + (slope < 0 ? Real(-4 * curve.bounds.value_error / slope) : Real(0))};
}

template <class Real>
Real WallSearch<Real>::polished_root(const Curve& curve, Point& left, Point& right) const {
  if (left.value <= 0) return left.t;
  const Real ulp = epsilon<Real>() * constants_.clock.period();
  const auto adjacent = [](const Real& a, const Real& b) {
    const Real middle = a + (b - a) / 2;
    return middle <= a || middle >= b;
  };
  const auto solve = [&](const auto& f, const Point& a, const Point& b) {
    std::uintmax_t iterations = 500;
    const auto root = boost::math::tools::toms748_solve(f, a.t, b.t, a.value, b.value, adjacent, iterations);
    EDMILL_REQUIRE(iterations < 500, "root polishing ran out of iterations");
    return root;
  };
  if (left.slope < 0 && right.slope < 0) {
    const Real curvature = (right.slope - left.slope) / (right.t - left.t);
    const Real width = right.t - left.t;
    Real guess = numerics::inverse_cubic_hint(left, right);
    for (int step = 0; step < 12 && guess > left.t && guess < right.t; ++step) {
      const Point near = curve.at(guess);
      (near.value < 0 ? right : left) = near;
      if (!(near.slope < 0) || near.value == 0) break;
      const Real newton = -near.value / near.slope;
      const Real correction = newton - curvature * (newton * newton) / (2 * near.slope);
      const Real size = correction < 0 ? Real(-correction) : correction;
      guess = near.t + correction;
      // The curvature is off by at most sup|third derivative| times the width of the bracket.
      if (curve.bounds.third * (size * size) * (width + size) > -near.slope * ulp) continue;
      const auto quadratic = [&](const Real& t) {
        const Real d = t - near.t;
        return Real(near.value + d * (near.slope + d * (curvature / 2)));
      };
      const Real reach = epsilon<Real>() * guess;  // one or two ulps of this very number
      Real low = guess - reach, high = guess + reach;
      if (!(low > left.t && high < right.t)) break;
      if (!(quadratic(low) > 0 && quadratic(high) < 0)) break;
      while (!adjacent(low, high)) {
        const Real middle = low + (high - low) / 2;
        (quadratic(middle) >= 0 ? low : high) = middle;
      }
      // The quadratic changes sign here, so the gap does within its rounding error; what is left is to find
      // the side on which the computed gap is not negative.
      // The bound on that error is several times what it usually is: step back by parts of it.
      const Real doubt = -curve.bounds.value_error / near.slope;
      for (const Real& t : {low, Real(low - (2 * ulp + doubt / 16)), Real(low - (2 * ulp + doubt / 4)),
                            Real(low - (2 * ulp + doubt))}) {
        if (!(t > left.t && t < right.t)) continue;
        const Point p = curve.at(t);
        (p.value < 0 ? right : left) = p;
        if (p.value >= 0) return p.t;
      }
      break;
    }
  }
  if (left.value == 0 || adjacent(left.t, right.t)) return left.t;
  // One end is near, the other may still be far: bring it in by doubling steps.
  const bool from_left = left.value < -right.value;
  for (Real step = ulp; step < right.t - left.t; step = 2 * step) {
    const Point p = curve.at(from_left ? Real(left.t + step) : Real(right.t - step));
    (p.value < 0 ? right : left) = p;
    if (from_left == (p.value < 0)) break;
  }
  if (left.value == 0 || adjacent(left.t, right.t)) return left.t;
  const auto root = solve([&](const Real& t) { return Real(curve.at(t).value); }, left, right);
  EDMILL_REQUIRE(
      root.first == root.second || (curve.at(root.first).value >= 0 && curve.at(root.second).value <= 0),
      "root polishing lost the sign change");
  return root.first;
}

}  // namespace edmill::dynamics
