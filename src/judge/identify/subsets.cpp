#include <fmt/format.h>

#include "identify/assumptions.hpp"

namespace edmill::identify {

namespace {

using audit::LoggedEvent;

bool takes_part(const LoggedEvent& event, int ball) {
  return event.ball == ball || (!event.with_wall && event.partner == ball);
}

}  // namespace

std::vector<SharedSubset> subsets_of(const model::Case<double>& the_case,
                                     const std::vector<LoggedEvent>& events,
                                     const std::vector<Branches>& branches) {
  std::vector<SharedSubset> list;
  const auto add = [&](std::string name, bool of_impacts, bool of_flights,
                       std::function<bool(const RowPlace&)> holds) {
    list.push_back(
        std::make_shared<Subset>(Subset{std::move(name), std::move(holds), of_impacts, of_flights}));
  };
  const auto of_impacts = [&](std::string name, auto holds) {
    add(std::move(name), true, false,
        [&events, holds](const RowPlace& at) { return !at.of_flight && holds(events[at.event], at.event); });
  };
  of_impacts("with walls", [](const LoggedEvent& e, std::size_t) { return e.with_wall; });
  of_impacts("between balls", [](const LoggedEvent& e, std::size_t) { return !e.with_wall; });
  const auto walls = the_case.mill.vessel.walls();
  for (int wall = 0; wall < static_cast<int>(walls.size()); ++wall)
    of_impacts("at " + walls[wall].meaning,
               [wall](const LoggedEvent& e, std::size_t) { return e.with_wall && e.partner == wall; });
  of_impacts("where contacts stick",
             [&](const LoggedEvent&, std::size_t k) { return branches[k].known && branches[k].sticks; });
  of_impacts("where contacts slide",
             [&](const LoggedEvent&, std::size_t k) { return branches[k].known && !branches[k].sticks; });
  of_impacts("where the least separation speed applies", [&](const LoggedEvent&, std::size_t k) {
    return branches[k].known && branches[k].at_least_separation;
  });
  of_impacts("where the restitution applies", [&](const LoggedEvent&, std::size_t k) {
    return branches[k].known && !branches[k].at_least_separation;
  });
  const auto& balls = the_case.balls;
  of_impacts("between balls that are not alike", [&balls](const LoggedEvent& e, std::size_t) {
    return !e.with_wall && !(balls[e.ball] == balls[e.partner]);
  });
  // Rows of both bodies, those of the energy, follow from what happens to either.
  add("on the partner", true, false,
      [&events](const RowPlace& at) { return !at.of_flight && at.body != 0 && !events[at.event].with_wall; });
  add("on the ball, not its partner", true, false,
      [&events](const RowPlace& at) { return !at.of_flight && at.body != 1 && !events[at.event].with_wall; });
  constexpr int most_balls = 40;
  const int count = static_cast<int>(balls.size());
  for (int ball = 0; ball < count && count <= most_balls && count > 1; ++ball) {
    of_impacts(fmt::format("in impacts of ball {}", ball),
               [ball](const LoggedEvent& e, std::size_t) { return takes_part(e, ball); });
    add(fmt::format("on ball {}", ball), true, true, [&events, ball](const RowPlace& at) {
      const auto& event = events[at.event];
      return at.body < 0 ? takes_part(event, ball) : event.ball_at(at.body) == ball;
    });
  }
  return list;
}

}  // namespace edmill::identify
