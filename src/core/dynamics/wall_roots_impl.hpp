// Implementation of WallSearch: from a bracket, or from what double proves for a wide scalar, to the root;
// included by wall_search_impl.hpp only.
#pragma once

#include <type_traits>
#include <utility>

#include "base/errors.hpp"
#include "dynamics/wall_search.hpp"

namespace edmill::dynamics {

/// The bracket's root to the last digit of the scalar: the end of the last bracket where the gap is not
/// negative.
template <model::Motion M, model::Vessel V>
auto WallSearch<M, V>::polish(const Curve& curve, const Bracket& bracket) const -> std::optional<Root> {
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
    const auto root =
        close_in(curve.functions, curve.wall, left.t, right.t,
                 {hop ? bracket.guess : numerics::inverse_cubic_hint(left, right),
                  static_cast<double>((right.slope - left.slope) / width),
                  static_cast<double>(curve.bounds.third * width), static_cast<double>(curve.bounds.third)},
                 curve.bounds.value_error);
    if (root) return root;
  }
  if (hop) {  // the peak is so low that rounding hides it: cut it off
    const Bracket behind = isolate_outside(curve, left, right, true);
    if (behind.verdict != Verdict::contact) return std::nullopt;
    return polish(curve, behind);
  }
  const auto gap = [&](const Real& t) { return Real(curve.at(t).value); };
  const auto closed = [this](const Real& low, const Real& high) { return is_closed(low, high); };
  std::uintmax_t iterations = 500;
  const auto root =
      boost::math::tools::toms748_solve(gap, left.t, right.t, left.value, right.value, closed, iterations);
  EDMILL_REQUIRE(iterations < 500, "root polishing ran out of iterations");
  const Point end = curve.at(root.first);
  EDMILL_REQUIRE(end.value >= 0, "root polishing lost the sign change");
  return Root{root.first, time_error_at(end.slope)};
}

/// The digits of Newton's iteration from a root of double on, where there are many.
template <class Real>
auto digits_of_step(int step) {
  ChosenDigits<Real> digits;
  if constexpr (requires { digits.digits; }) {
    constexpr unsigned first = 64;  // of the step from 16 to 45 right digits
    if (step < 15 && !double_hints<Real>()) digits.digits = std::min(digits.digits, first << step);
  }
  return digits.use();
}

/// The root of a gap that is proven to fall through zero in (from, to): Newton's iteration, which knows the
/// curvature, up to where one step more would change nothing; then toms748 on the gap itself, in a bracket of
/// a few units of the clock. Nothing when rounding does not let the signs at such a bracket be seen.
template <model::Motion M, model::Vessel V>
auto WallSearch<M, V>::close_in(const Functions& functions, int wall, const Real& from, const Real& to,
                                const Approach& approach, const Real& value_error) const
    -> std::optional<Root> {
  const Real unit = epsilon<Real>() * mill_.clock.period();
  const bool few_digits = double_hints<Real>();
  Real t = approach.guess;
  const int all_digits = binary_digits<Real>();
  auto pose = [&] {
    [[maybe_unused]] const auto few = digits_of_step<Real>(0);
    return functions.pose(t);
  }();
  const auto pose_at = [&](const Real& time) { return functions.pose_nearby(time, pose, t); };
  const int steps = few_digits ? 8 : 40;  // each doubles the digits
  for (int step = 0; step < steps; ++step) {
    if (!(t > from && t < to)) return std::nullopt;
    // A step that finds twice the digits that the last one left needs no more of them.
    [[maybe_unused]] const auto few = digits_of_step<Real>(step);
    if (!few_digits) pose = functions.pose(t);
    const auto sample = functions(t, pose);
    const Real& slope = sample.rate[wall];
    const double flatness = static_cast<double>(slope);
    if (!(flatness < 0)) return std::nullopt;
    const Real newton = -sample.gap[wall] / slope;
    // The curvature's part of the step, and whether one more would change the time.
    const auto bent = [&](const auto& size) -> std::pair<Real, bool> {
      using Size = std::decay_t<decltype(size)>;
      const Size square = size * size;
      const Size off = (approach.curvature_error + approach.third * (size < 0 ? -size : size)) * square;
      return {Real(approach.curvature * square / (2 * flatness)), off > -flatness * static_cast<Size>(unit)};
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
    const auto closed = [this](const Real& low, const Real& high) { return is_closed(low, high); };
    const Real time_error = -value_error / slope;
    // Rounding moves the place where the computed gap changes its sign: step on until both signs are seen.
    Real low = centre - 4 * unit, high = centre + 4 * unit, at_low = gap(low), at_high = gap(high);
    for (Real reach = 16 * unit; !(at_low >= 0 && at_high <= 0); reach = 4 * reach) {
      if (reach > 32 * (unit + time_error)) return std::nullopt;
      if (at_low < 0) {
        high = low, at_high = at_low;
        low = centre - reach, at_low = gap(low);
      } else {
        low = high, at_low = at_high;
        high = centre + reach, at_high = gap(high);
      }
    }
    if (!(low > from && high < to)) return std::nullopt;
    std::uintmax_t iterations = 100;
    const Real root =
        boost::math::tools::toms748_solve(gap, low, high, at_low, at_high, closed, iterations).first;
    Root found{root, resolution() + 4 * time_error};
    if constexpr (is_wide) found.pose = pose_at(root);
    return found;
  }
  return std::nullopt;
}

template <model::Motion M, model::Vessel V>
auto WallSearch<M, V>::rough(const WallQuery<Real>& query) const -> RoughAnswer {
  if constexpr (is_wide) {
    return {};
  } else {
    require_length(query);
    const Functions functions(mill_, query.flight, query.radius, query.begin.period);
    const Real begin = query.begin.offset;
    RoughAnswer rough;
    const auto pose = functions.pose(begin);
    const auto ball = functions.seen(begin, pose);
    const Real speed = top_speed(ball.velocity, query.length);
    const auto answer =
        first_contact<true>(functions, functions.start(begin, pose, ball),
                            model::active_functions(functions.room(), ball.state.position), speed,
                            smooth(query, functions, ball.state.position, speed), &rough);
    rough.verdict = answer.verdict;
    // The sum is rounded, and the window was proven up to its exact or its rounded end.
    if (answer.verdict == Verdict::none) rough.until = (begin + answer.searched) * (1 - epsilon<Real>());
    if (answer.verdict == Verdict::contact) {
      const auto derivatives = bounds_.at(speed, query.length);
      rough.curvature = functions.start(rough.root).curvature[rough.wall];
      rough.curvature_error =
          functions.errors(functions.elapsed(begin + query.length), speed).curvature[rough.wall];
      rough.third = derivatives[mill_.vessel.kind_of(rough.wall)][1];
    }
    return rough;
  }
}

/// The wide gap is evaluated at the rough root, an error of double away from the root, so that one step of
/// Newton's iteration with the curvature as double knows it gives nearly three times the digits of double.
/// That the root found is the bracket's needs no more: the gap falls all along it.
template <model::Motion M, model::Vessel V>
auto WallSearch<M, V>::search_by_double(const WallQuery<Real>& query) const -> WallAnswer<Real> {
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
      if (searched > 0) return WallAnswer<Real>::none(searched);
    }
    if (rough.verdict != Verdict::contact) return {Verdict::undecided};

    const Functions functions(mill_, query.flight, query.radius, query.begin.period);
    const Real left(rough.left);
    const auto unit = static_cast<Hint<Real>>(epsilon<Real>()) / epsilon<double>();
    const auto root = close_in(functions, rough.wall, left > begin ? left : begin, Real(rough.right),
                               {Real(rough.root), rough.curvature, rough.curvature_error, rough.third},
                               Real(rough.error * unit));  // bounds are proportional to epsilon
    if (!root) return {Verdict::undecided};
    if constexpr (model::HasRegions<V>)  // this scalar's regions are sharper
      if (!functions.room().is_valid(rough.wall,
                                     functions.seen(root->t, functions.pose(root->t)).state.position))
        return {Verdict::undecided};
    return {Verdict::contact, rough.wall, mill_.clock.instant(query.begin.period, root->t), false, Real(0),
            root->time_error, root->pose};
  }
}

}  // namespace edmill::dynamics
