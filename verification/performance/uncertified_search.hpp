// Ball-wall times without certificates: what an ordinary event-driven code does for a moving wall.
// It is used for comparison only, and not part of the program.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "dynamics/wall_search.hpp"

namespace edmill::performance {

using SpexSearch = dynamics::AnyWallSearch<double>::Spex;
using SpexFunctions = SpexSearch::Functions;

inline SpexSearch spex_search(const model::Mill<double>& mill) {
  return {*mill.motion.get_if<model::SpexMotion<double>>(),
      *mill.vessel.get_if<model::CylinderVessel<double>>(), mill.gravity};
}

/// Answers the question of WallSearch by the signs of the gaps at sample points. A contact whose
/// gap is negative between two points only is missed.
/// @param samples  points for each longest window
inline dynamics::WallAnswer<double> uncertified_search(const SpexSearch& walls,
    const SpexFunctions& functions, const dynamics::GapStart<model::CylinderVessel<double>>& first,
    const dynamics::WallQuery<double>& query, int samples) {
  using dynamics::Verdict;
  constexpr int wall_count = model::CylinderVessel<double>::wall_count();
  const auto& clock = walls.mill().clock;
  const double begin = query.begin.offset, ulp = 0x1p-52 * clock.period();
  const auto contact = [&](int wall, double t) {
    return dynamics::WallAnswer<double>{
        Verdict::contact, wall, clock.instant(query.begin.period, t), false, 0, ulp};
  };

  // Where the parabola through the start meets each wall; the search ends a little beyond the
  // first.
  std::array<double, wall_count> predicted;
  double length = query.length;
  for (int wall = 0; wall < wall_count; ++wall) {
    if (first.gap[wall] <= 0 && first.rate[wall] < 0) return contact(wall, begin);
    const double root = numerics::first_root_hint<double>(
        {begin, first.gap[wall], first.rate[wall]}, first.curvature[wall], query.length);
    predicted[wall] = begin + root;
    if (root * 9 / 8 > 64 * ulp) length = std::min(length, root * 9 / 8);
  }

  // Newton from the prediction, or from the right end when that is outside of where the sign
  // changes: near the left end may be the contact that the ball just leaves.
  const auto root_between = [&](int wall, dynamics::GapSample<model::CylinderVessel<double>> left,
                                dynamics::GapSample<model::CylinderVessel<double>> right) {
    double t = predicted[wall];
    if (!(t > left.offset && t < right.offset))
      t = right.offset - right.gap[wall] / right.rate[wall];
    for (int step = 0; step < 100 && right.offset - left.offset > ulp; ++step) {
      if (!(t > left.offset && t < right.offset)) t = (left.offset + right.offset) / 2;
      const auto here = functions(t);
      (here.gap[wall] < 0 ? right : left) = here;
      const double change = -here.gap[wall] / here.rate[wall];
      if (std::abs(change) < ulp) break;
      t += change;
    }
    return std::min(std::max(t, left.offset), right.offset);
  };

  const double end = begin + length, spacing = walls.longest_window() / samples;
  dynamics::GapSample<model::CylinderVessel<double>> left = first;
  while (left.offset < end) {
    const auto right = functions(std::min(left.offset + spacing, end));
    dynamics::WallAnswer<double> answer;
    double earliest = right.offset;
    for (int wall = 0; wall < wall_count; ++wall) {
      if (right.gap[wall] >= 0) continue;
      const double root = root_between(wall, left, right);
      if (root > earliest) continue;
      earliest = root;
      answer = contact(wall, root);
    }
    if (answer.verdict == Verdict::contact) return answer;
    left = right;
  }
  return {Verdict::none, -1, {}, false, length, 0};
}

}  // namespace edmill::performance
