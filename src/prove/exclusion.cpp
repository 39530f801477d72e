#include "prove/exclusion.hpp"

namespace edmill::prove {

auto WallExclusion::window(int depth, long index) -> const Window& {
  const auto found = windows_.find({depth, index});
  if (found != windows_.end()) return found->second;
  const auto at = [&](long k) {
    Enclosure share(static_cast<double>(k));
    arb_mul_2exp_si(share.arb(), share.arb(), -depth);
    return span_.begin + (span_.end - span_.begin) * share;
  };
  const Enclosure from = at(index), to = at(index + 1), middle = (from + to) / 2;
  Enclosure all;
  arb_union(all.arb(), from.arb(), to.arb(), Precision::bits());
  const auto seen = [&](const Enclosure& time) {
    return Motion::in_vessel(motion_.pose(time), span_.flight.position_at(time, gravity_),
                             span_.flight.velocity_at(time, gravity_), gravity_);
  };
  return windows_.emplace(std::pair(depth, index), Window{all - middle, seen(middle), seen(all)})
      .first->second;
}

bool WallExclusion::bisect(std::size_t wall, int depth, long index, std::string& text) {
  const Window& w = window(depth, index);
  const Gap middle = walls_.gap(wall, w.middle);
  const Enclosure second = walls_.gap(wall, w.all).second, &s = w.length_from_middle;
  Enclosure square;
  arb_sqr(square.arb(), s.arb(), Precision::bits());
  const Enclosure value = middle.value + middle.rate * s + second * square / 2,
                  rate = middle.rate + second * s;
  const bool first = index == 0, last = index + 1 == 1L << depth;
  const auto leaf = [&](char kind) {
    text += kind + std::to_string(depth);
    return true;
  };
  if (value.is_positive()) return leaf('p');
  if (first && span_.begin_wall == static_cast<int>(wall) && rate.is_positive()) return leaf('r');
  if (last && span_.end_wall == static_cast<int>(wall) && rate.is_negative()) return leaf('f');
  if (depth == deepest) return false;
  return bisect(wall, depth + 1, 2 * index, text) && bisect(wall, depth + 1, 2 * index + 1, text);
}

std::string WallExclusion::windows(std::size_t wall) {
  std::string text;
  return bisect(wall, 0, 0, text) ? text : "";
}

PairGap pair_gap(const Flight& one, const Flight& two, const Enclosure& reach, const Vector& gravity,
                 const Enclosure& time) {
  return {one.position_at(time, gravity) - two.position_at(time, gravity),
          one.velocity_at(time, gravity) - two.velocity_at(time, gravity), reach * reach};
}

bool apart(const Flight& one, const Flight& two, const Enclosure& reach, const Vector& gravity,
           const Enclosure& begin, const Enclosure& end) {
  const auto at_begin = pair_gap(one, two, reach, gravity, begin),
             at_end = pair_gap(one, two, reach, gravity, end);
  const Enclosure value = at_begin.value(), half_rate = at_begin.half_rate();
  if (value.is_positive() && half_rate.is_not_negative()) return true;
  if (at_end.value().is_positive() && at_end.half_rate().is_not_positive()) return true;
  // The tangent of a convex function lies below it.
  if (value.is_positive() && (value + 2 * half_rate * (end - begin)).is_positive()) return true;
  return less(half_rate * half_rate, squared_norm<Enclosure>(at_begin.relative) * value);
}

}  // namespace edmill::prove
