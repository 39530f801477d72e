// Implementation of WallSearch: what double proves for a wide scalar; included by wall_search_impl.hpp only.
#pragma once

#include "base/errors.hpp"
#include "dynamics/any_wall_search.hpp"

namespace edmill::dynamics {

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
