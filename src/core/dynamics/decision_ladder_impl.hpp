// Implementation of DecisionLadder; included by the instantiation files only.
#pragma once

#include <type_traits>

#include "base/errors.hpp"
#include "base/scalar_list.hpp"
#include "dynamics/decision_ladder.hpp"
#include "dynamics/exact_contact.hpp"

namespace edmill::dynamics {

namespace detail {

template <class Real> std::string text(const Flight<Real>& f) {
  std::string out = "flight from (period " + std::to_string(f.start.period) + ", offset " +
      to_text(f.start.offset) + " s): position";
  for (int k = 0; k < 3; ++k) out += " " + to_text<Real>(f.position[k]);
  out += " m, velocity";
  for (int k = 0; k < 3; ++k) out += " " + to_text<Real>(f.velocity[k]);
  return out + " m/s";
}

}  // namespace detail

template <class Real> struct DecisionLadder<Real>::Above {
  // At the top of the ladder this type is never used.
  using Wide = std::conditional_t<std::is_void_v<Wider<Real>>, Real, Wider<Real>>;
  DecisionLadder<Wide> ladder;
};

template <class Real>
DecisionLadder<Real>::DecisionLadder(
    const model::Mill<Real>& mill, const Real& smallest_sum, const Real& top_speed)
    : mill_(mill), smallest_sum_(smallest_sum), walls_(mill),
      pairs_(mill, smallest_sum, walls_.reach(), top_speed) {
  if constexpr (!std::is_void_v<Wider<Real>>) passed_up_.scalar = scalar_name<Wider<Real>>();
}

template <class Real> DecisionLadder<Real>::~DecisionLadder() = default;
template <class Real> DecisionLadder<Real>::DecisionLadder(DecisionLadder&&) noexcept = default;

template <class Real> auto DecisionLadder<Real>::above() -> Above& {
  using Wide = typename Above::Wide;
  if (!above_)
    above_.reset(new Above{DecisionLadder<Wide>(
        model::mill_cast<Wide>(mill_), Wide(smallest_sum_), Wide(pairs_.top_speed()))});
  return *above_;
}

template <class Real> void DecisionLadder<Real>::raise_top_speed(const Real& speed) {
  pairs_.raise_top_speed(speed);
  if (above_) above_->ladder.raise_top_speed(typename Above::Wide(speed));
}

template <class Real> void DecisionLadder<Real>::archive(Archive& a) {
  bool needed_above = above_ != nullptr;
  a(passed_up_, needed_above);
  if constexpr (!std::is_void_v<Wider<Real>>)
    if (needed_above) a(above().ladder);
}

template <class Real> auto DecisionLadder<Real>::wall_above(const Query& query) -> Answer {
  if constexpr (std::is_void_v<Wider<Real>>) {
    throw UndecidedError("ball-wall contact undecided in the widest scalar: ball of radius " +
        to_text(query.radius) + " m, " + detail::text(query.flight) + ", window from (period " +
        std::to_string(query.begin.period) + ", offset " + to_text(query.begin.offset) +
        " s) for " + to_text(query.length) + " s");
  } else {
    using Wide = Wider<Real>;
    ++passed_up_.wall;
    auto& ladder = above().ladder;
    const Wide length(query.length);
    const auto begin = instant_cast<Wide>(query.begin);
    WallQuery<Wide> rest{flight_cast<Wide>(query.flight), Wide(query.radius), begin, length};
    auto wide = ladder.wall(rest);
    // A border between regions may be closer to the begin than this scalar's clock resolves.
    const Wide least(64 * epsilon<Real>() * pairs_.clock().period());
    Wide proven = wide.searched;
    while (wide.verdict == Verdict::none && proven < least && proven < length) {
      rest.begin = ladder.pairs().clock().after(begin, proven);
      rest.length = length - proven;
      wide = ladder.wall(rest);
      proven += wide.searched;
    }
    auto time = rounded_down<Real>(wide.time);
    if (wide.verdict == Verdict::contact && time < query.begin) time = query.begin;
    Real searched = static_cast<Real>(proven);
    if (Wide(searched) > proven) searched -= searched * epsilon<Real>();
    // A contact that is certain at the begin of the window has the same time in both scalars.
    const bool at_once = wide.time_error == 0 && time == query.begin;
    return {.verdict = wide.verdict,
        .wall = wide.wall,
        .time = time,
        .by_rule = wide.by_rule,
        .searched = searched,
        .time_error = at_once ? Real(0) : Real(static_cast<Real>(wide.time_error) + rounding())};
  }
}

template <class Real>
PairAnswer<Real> DecisionLadder<Real>::pair_above(const Flight<Real>& i, const Flight<Real>& j,
    const Instant<Real>& now, const Real& radius_sum) {
  if constexpr (std::is_void_v<Wider<Real>>) {
    const Real& period = pairs_.clock().period();
    const auto time = exact_contact_time(exact_gap(i, j, now, radius_sum, mill_.gravity, period));
    if (!time) return {};
    const Real delay = time->template rounded_down<Real>();
    return {Verdict::contact, delay, 4 * epsilon<Real>() * (delay + period)};
  } else {
    using Wide = Wider<Real>;
    ++passed_up_.pair;
    const auto wide = above().ladder.pair(
        flight_cast<Wide>(i), flight_cast<Wide>(j), instant_cast<Wide>(now), Wide(radius_sum));
    const auto delay = static_cast<Real>(wide.delay), error = static_cast<Real>(wide.time_error);
    return {wide.verdict, delay, error + rounding() + 4 * epsilon<Real>() * delay};
  }
}

template <class Real> auto DecisionLadder<Real>::time_of(const Contact& contact) -> Timed {
  const auto& clock = pairs_.clock();
  if (!contact.with_wall) {
    const auto& now = contact.flight.start;
    const auto answer = pair(contact.flight, contact.partner, now, contact.radius);
    if (answer.verdict == Verdict::contact)
      return {clock.after(now, answer.delay), answer.time_error};
    return {contact.time, tie_window()};
  }
  // A window that ends just after the predicted time contains the contact.
  const Real length = walls_.longest_window() / 64;
  auto begin = clock.after(contact.time, -length);
  if (begin < contact.flight.start) begin = contact.flight.start;
  Real window = clock.elapsed(begin, contact.time) + length / 64;
  for (;;) {  // a search of bodies may prove a part of its window only
    const auto answer = wall({contact.flight, contact.radius, begin, window});
    if (answer.verdict == Verdict::contact) return {answer.time, answer.time_error};
    if (mill_.bodies.empty() || !(answer.searched > 0 && answer.searched < window))
      return {contact.time, tie_window()};
    begin = clock.after(begin, answer.searched);
    window -= answer.searched;
  }
}

template <class Real> int DecisionLadder<Real>::order(const Contact& a, const Contact& b) {
  const Timed first = time_of(a), second = time_of(b);
  const bool both_at_once = first.time_error == 0 && second.time_error == 0;
  if (both_at_once && first.time == second.time) return 0;
  const auto& clock = pairs_.clock();
  const Real difference = clock.elapsed(first.time, second.time);
  const Real error = first.time_error + second.time_error + 16 * epsilon<Real>() * clock.period();
  if (difference > error) return -1;
  if (difference < -error) return 1;
  if constexpr (std::is_void_v<Wider<Real>>) {
    const Real& period = clock.period();
    // By exact arithmetic; none if a gap is no polynomial.
    const auto exact_time = [&](const Contact& c) -> std::optional<ExactTime> {
      const auto& begin = c.flight.start;
      std::optional<ExactGap> gap;
      if (c.with_wall)
        gap = exact_gap(mill_, Query{c.flight, c.radius, begin, period}, c.wall);
      else
        gap = exact_gap(c.flight, c.partner, begin, c.radius, mill_.gravity, period);
      return gap ? exact_contact_time(*gap) : std::nullopt;
    };
    const auto one = exact_time(a), two = exact_time(b);
    const Dyadic later = exact_elapsed(a.flight.start, b.flight.start, period);
    const int order = one && two ? one->compare(*two, later) : 0;
    passed_up_.order += order == 0;
    return order;
  } else {
    using Wide = Wider<Real>;
    ++passed_up_.order;
    const auto widened = [](const Contact& c) {
      return dynamics::Contact<Wide>{.with_wall = c.with_wall,
          .flight = flight_cast<Wide>(c.flight),
          .partner = flight_cast<Wide>(c.partner),
          .radius = Wide(c.radius),
          .time = instant_cast<Wide>(c.time),
          .wall = c.wall};
    };
    return above().ladder.order(widened(a), widened(b));
  }
}

template <class Real> std::vector<model::Escalations> DecisionLadder<Real>::escalations() const {
  if constexpr (std::is_void_v<Wider<Real>>) {
    return {{"rule", passed_up_.wall, 0, passed_up_.order}};
  } else {
    std::vector<model::Escalations> rows{passed_up_};
    if (above_) {
      const auto more = above_->ladder.escalations();
      rows.insert(rows.end(), more.begin(), more.end());
    } else {  // rungs that were never needed are reported, too
      using Next = Wider<Wider<Real>>;
      if constexpr (!std::is_void_v<Next>) rows.push_back({scalar_name<Next>()});
      rows.push_back({"rule"});
    }
    return rows;
  }
}

}  // namespace edmill::dynamics
