#include "identify/assumptions.hpp"

#include <algorithm>
#include <utility>

#include "casefile/check_case.hpp"

namespace edmill::casefile {
extern template model::Mill<double> build_mill<double>(const CaseSpec&);
extern template InitialCase<double> build_case<double>(const CaseSpec&, bool);
}  // namespace edmill::casefile

namespace edmill::identify {

bool LogChange::none() const {
  return time == 1 && positions == 1 && velocities == 1 && spins == 1 && energies == 1 && speeds == 1 &&
         delay == 0 && !states_exchanged && exchanged[0] < 0;
}

void LogChange::apply(audit::LoggedEvent& event) const {
  event.time = event.time * time + delay;
  event.milling_dose *= energies, event.wall_work *= energies;
  event.approach_speed *= speeds, event.slip_speed *= speeds;
  for (auto& body : event.body) {
    body.position *= positions;
    body.velocity_before *= velocities, body.velocity_after *= velocities;
    body.spin_before *= spins, body.spin_after *= spins;
  }
  if (states_exchanged && !event.with_wall) std::swap(event.body[0], event.body[1]);
  if (exchanged[0] < 0) return;
  const auto renamed = [&](int& ball) {
    if (ball == exchanged[0])
      ball = exchanged[1];
    else if (ball == exchanged[1])
      ball = exchanged[0];
  };
  renamed(event.ball);
  if (!event.with_wall) renamed(event.partner);
}

std::optional<model::Case<double>> Assumptions::built() const {
  if (!casefile::problems_of(spec).empty()) return std::nullopt;
  model::Case<double> result;
  result.mill = casefile::build_mill<double>(spec);
  result.balls = balls;
  const auto& vessel = result.mill.vessel;
  const bool room =
      std::ranges::none_of(balls, [&](const auto& ball) { return vessel.inset(ball.radius).is_empty(); });
  if (!room || vessel.wall_count() != walls) return std::nullopt;
  return result;
}

Assumptions assumptions_of(const casefile::CaseSpec& spec) {
  const auto built = casefile::build_case<double>(spec).the_case;
  return {spec, built.balls, {}, built.mill.vessel.wall_count()};
}

casefile::Quantity exactly(double value) { return {boost::multiprecision::cpp_rational(value)}; }

std::vector<BallGroup> ball_groups(const casefile::CaseSpec& spec) {
  std::vector<BallGroup> groups;
  std::size_t next = 0;
  for (std::size_t k = 0; k < spec.balls.size(); ++k, ++next)
    groups.push_back({"ball." + std::to_string(k), next, next + 1, &spec.balls[k]});
  for (std::size_t k = 0; k < spec.batches.size(); ++k) {
    const auto count = static_cast<std::size_t>(spec.batches[k].count);
    groups.push_back({"balls." + std::to_string(k), next, next + count, &spec.batches[k]});
    next += count;
  }
  return groups;
}

}  // namespace edmill::identify
