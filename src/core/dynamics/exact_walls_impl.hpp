// Implementation of WallSearch: what its own bounds do not decide, exactly or by a rule; included by
// wall_search_impl.hpp only.
#pragma once

#include <bit>

#include "base/interruption.hpp"
#include "dynamics/exact_contact.hpp"
#include "dynamics/wall_search.hpp"

namespace edmill::dynamics {

/// The first contact with one wall up to `end` where bounds do not decide, and in the widest scalar where the
/// ball touches: in exact arithmetic, else in the widest scalar by a rule.
/// @param found  by bounds
template <model::Motion M, model::Vessel V>
auto WallSearch<M, V>::isolate_further(const Curve& curve, const Start& first, const Sample& last,
                                       const WallQuery<Real>& query, const Real& end,
                                       const Bracket& found) const -> Bracket {
  const Point start = curve.of(first);
  const bool undecided = found.verdict == Verdict::undecided;
  // What exact arithmetic knows needs no rule for what is zero within rounding.
  if (undecided || start.value <= curve.bounds.value_error) {
    const auto exact = isolate_exactly(curve, query, end);
    if (exact.verdict != Verdict::undecided) return exact;
  }
  if constexpr (is_widest)
    if (undecided) return isolate_by_rule(curve, start, curve.of(last));
  return found;
}

/// Whether a wall is hit before another one. At one time within rounding exact arithmetic decides, or a wider
/// scalar: then nothing. The other one comes first, by the rule, where they are equal or the widest scalar
/// does not separate them.
template <model::Motion M, model::Vessel V>
template <bool rounded>
std::optional<bool> WallSearch<M, V>::comes_first(const WallQuery<Real>& query, int wall, const Root& root,
                                                  int other, const Root& other_root, bool& by_rule) const {
  const Real later = root.t - other_root.t, error = root.time_error + other_root.time_error;
  if (later > error) return false;
  if (later < -error) return true;
  std::optional<int> order;
  if constexpr (!rounded) order = exact_order(query, wall, root.at_once, other, other_root.at_once);
  if (!order && !is_widest) return std::nullopt;
  by_rule |= (!order || *order == 0) && wall < mill_.vessel.wall_count();
  return order && *order < 0;
}

/// For gaps that the widest scalar does not decide and that are no polynomials, so that exact arithmetic
/// does not apply: they are zero within rounding, or change too slowly to be excluded. The rule is that a gap
/// which does not measurably fall does not fall. It is evaluated at times after the start that grow by
/// factors of 16; if it falls before it has opened, the contact is at the evaluation before.
template <model::Motion M, model::Vessel V>
auto WallSearch<M, V>::isolate_by_rule(const Curve& curve, const Point& start, const Point& right) const
    -> Bracket {
  const Bounds& b = curve.bounds;
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
      auto found = last.value > b.value_error ? isolate(curve, last, next) : Bracket{Verdict::undecided};
      if (found.verdict == Verdict::undecided)
        found = {.verdict = Verdict::contact, .left = last, .right = last, .time_error = next.t - last.t};
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

template <model::Motion M, model::Vessel V>
bool WallSearch<M, V>::has_exact_gap(int wall) const {
  const Vec3<Real> zero = Vec3<Real>::Zero();
  const WallQuery<Real> any{{zero, zero, {}}, Real(0), {}, Real(0)};
  return exact_gap(mill_.motion, mill_.vessel, mill_.gravity, any, wall).has_value();
}

/// Up to `end`, in exact arithmetic. Undecided where the gap is no polynomial.
template <model::Motion M, model::Vessel V>
auto WallSearch<M, V>::isolate_exactly(const Curve& curve, const WallQuery<Real>& query,
                                       const Real& end) const -> Bracket {
  if (curve.wall >= mill_.vessel.wall_count()) return {Verdict::undecided};
  const auto gap = exact_gap(mill_.motion, mill_.vessel, mill_.gravity, query, curve.wall);
  if (!gap) return {Verdict::undecided};
  const auto time = exact_contact_time(*gap);
  if (!time) return {Verdict::none};
  const Real delay = time->template rounded_down<Real>();
  const Point at{query.begin.offset + delay, Real(0), Real(0)};
  if (at.t > end) return {Verdict::none};
  return {.verdict = Verdict::contact,
          .left = at,
          .right = at,
          .time_error = resolution(),
          .at_once = time->compare({}) == 0};
}

/// Which of two walls is hit first, by exact arithmetic: negative `one`, positive `other`, zero at one time.
/// Nothing where it does not know the time of one of them.
template <model::Motion M, model::Vessel V>
std::optional<int> WallSearch<M, V>::exact_order(const WallQuery<Real>& query, int one, bool one_at_once,
                                                 int other, bool other_at_once) const {
  const auto time_of = [&](int wall, bool at_once) -> std::optional<ExactTime> {
    if (at_once) return ExactTime{};
    if (wall >= mill_.vessel.wall_count()) return std::nullopt;
    const auto gap = exact_gap(mill_.motion, mill_.vessel, mill_.gravity, query, wall);
    return gap ? exact_contact_time(*gap) : std::nullopt;
  };
  const auto first = time_of(one, one_at_once);
  if (!first) return std::nullopt;
  const auto second = time_of(other, other_at_once);
  return second ? std::optional(first->compare(*second)) : std::nullopt;
}

}  // namespace edmill::dynamics
