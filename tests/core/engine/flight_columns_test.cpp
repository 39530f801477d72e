// The pair filter for many flights gives for each ball the result of PairSearch for this ball
// alone.
#include "engine/flight_columns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "casefile/random.hpp"
#include "spex_case.hpp"

namespace edmill::engine {
namespace {

using dynamics::Flight;
using dynamics::PairSearch;
using dynamics::Verdict;

/// Balls in flight since up to two periods, some of them just collided with the one before.
struct Swarm {
  std::vector<Flight<double>> flights;
  std::vector<double> radii;
  Instant<double> now{7, 0.01};

  Swarm(
      casefile::Random& random, int balls, bool alike, const Vec3<double>& gravity, double period) {
    const auto somewhere = [&](double size) {
      return Vec3<double>(size * (2 * random.uniform<double>() - 1),
          size * (2 * random.uniform<double>() - 1), size * (2 * random.uniform<double>() - 1));
    };
    const DriveClock<double> clock(period);
    for (int i = 0; i < balls; ++i) {
      radii.push_back(alike ? 0.002 : 0.001 + 0.003 * random.uniform<double>());
      Flight<double> f{somewhere(0.02), somewhere(3), now};
      if (i > 0 && random.uniform<double>() < 0.3) {
        // Touching the ball before, up to rounding, and flying off or at it.
        const auto& other = flights.back();
        const double age = clock.elapsed(other.start, now);
        Vec3<double> direction = somewhere(1);
        direction /= norm<double>(direction);
        f.position = dynamics::position_after(other, gravity, age) +
            direction *
                ((radii[i] + radii[i - 1]) * (1 + 4e-16 * (random.uniform<double>() - 0.5)));
        f.velocity = dynamics::velocity_after(other, gravity, age) +
            direction * (2 * random.uniform<double>() - 1);
      } else {
        const double age = 2 * period * random.uniform<double>();
        f.start = clock.after(now, -age);
        f.position -= age * (f.velocity + age / 2 * gravity);  // where it was then
      }
      flights.push_back(f);
    }
  }
};

/// Delays of the contacts with candidates [s], by their balls; negative where only the search can
/// decide.
using Delays = std::map<int, double>;

template <class Real> model::Mill<Real> mill_with(const Vec3<double>& gravity) {
  auto mill = testing::spex_mill<Real>();
  mill.gravity = vector_cast<Real>(gravity);
  return mill;
}

/// One ball of a swarm and whom it may meet.
class Trial {
 public:
  Trial(casefile::Random& random, int balls, bool alike, const Vec3<double>& gravity)
      : mill_(mill_with<double>(gravity)),
        swarm_(random, balls, alike, gravity, mill_.motion.period()), alike_(alike),
        search_(mill_, 0.002, 0.1, 10),
        wide_(mill_with<float128>(gravity), float128(0.002), float128(0.1), float128(10)),
        self_(static_cast<int>(random.uniform<double>() * balls)),
        own_(search_.state(swarm_.flights[self_], swarm_.now)) {}

  Delays among_all() const {
    FlightColumns table(balls(), alike_);
    for (int i = 0; i < balls(); ++i) table.set(i, swarm_.flights[i], swarm_.radii[i]);
    PairFilterResult result;
    const auto all = delays(result, table.filter(query(), result), [](int place) { return place; });
    EXPECT_EQ(all.count(self_), 0u);
    EXPECT_TRUE(all.empty() || all.rbegin()->first < balls());
    return all;
  }

  Delays among(std::vector<int> list) const {
    const int count = static_cast<int>(list.size());
    list.resize(list.size() + 3);
    PairFilterResult result;
    result.make_room(count);
    const int found = filter_pairs(swarm_.flights.data(), swarm_.radii.data(), alike_ ? 0 : 1,
        query(), self_, list.data(), count, result);
    return delays(result, found, [&](int place) { return list[place]; });
  }

  /// What the filter found of another ball against PairSearch for this ball alone.
  /// @return the kind of the result
  const char* compare(const Delays& found, int other) const {
    const double sum = swarm_.radii[self_] + swarm_.radii[other];
    const auto& flight = swarm_.flights[other];
    const bool candidate = search_.may_meet(own_, flight, swarm_.now, sum);
    EXPECT_EQ(found.count(other) == 1, candidate);
    if (!candidate) {
      // The proof holds in the wide scalar, too.
      const auto now = dynamics::instant_cast<float128>(swarm_.now);
      const auto own = wide_.state(dynamics::flight_cast<float128>(swarm_.flights[self_]), now);
      const auto truth = wide_(own, dynamics::flight_cast<float128>(flight), now, float128(sum));
      EXPECT_NE(truth.verdict, Verdict::contact);
      return "passed";
    }
    if (found.at(other) < 0) return "left open";
    const auto answer = search_(own_, flight, swarm_.now, sum);
    EXPECT_EQ(answer.verdict, Verdict::contact);
    EXPECT_EQ(found.at(other), answer.delay);
    return "timed";
  }

  int balls() const { return static_cast<int>(swarm_.flights.size()); }
  int self() const { return self_; }
 private:
  PairFilterQuery query() const {
    return {own_, swarm_.radii[self_], swarm_.now, search_.filter()};
  }

  template <class BallAt>
  static Delays delays(PairFilterResult& result, int found, const BallAt& ball_at) {
    Delays delays;
    for (int k = 0; k < found; ++k)
      delays[ball_at(result.candidates()[k])] = result.delay(result.candidates()[k]);
    EXPECT_EQ(static_cast<int>(delays.size()), found);
    return delays;
  }

  model::Mill<double> mill_;
  Swarm swarm_;
  bool alike_;
  PairSearch<double> search_;
  PairSearch<float128> wide_;
  int self_;
  PairSearch<double>::State own_;
};

TEST(FlightColumns, DecidesAsPairSearchDoes) {
  const std::vector<Vec3<double>> gravities{
      testing::spex_mill<double>().gravity, {0, 0, 0}, {1, -9, 0.5}};
  casefile::Random random(20110101);
  std::map<std::string, int> seen;
  for (int turn = 0; turn < 400 && !::testing::Test::HasFailure(); ++turn) {
    const int balls = 1 + static_cast<int>(random.uniform<double>() * (turn % 5 == 0 ? 200 : 40));
    const Trial trial(random, balls, turn % 2 == 0, gravities[turn % gravities.size()]);
    const auto all = trial.among_all();
    for (int other = 0; other < balls; ++other)
      if (other != trial.self()) ++seen[trial.compare(all, other)];

    std::vector<int> list;  // some of the balls, out of order
    for (int i = balls - 1; i >= 0; --i)
      if (random.uniform<double>() < 0.8) list.push_back(i);
    auto expected = all;
    std::erase_if(expected, [&](const auto& candidate) {
      return std::find(list.begin(), list.end(), candidate.first) == list.end();
    });
    EXPECT_EQ(trial.among(list), expected);
  }
  for (const char* kind : {"passed", "left open", "timed"}) EXPECT_GT(seen[kind], 50) << kind;
}

/// What is found of a ball at rest and one more.
struct Pair {
  int candidates;
  double delay;  ///< of the candidate, if any
};
Pair filter_pair(const Vec3<double>& position, const Vec3<double>& velocity) {
  auto mill = testing::spex_mill<double>();
  mill.gravity = Vec3<double>::Zero();
  const PairSearch<double> search(mill, 0.004, 0.1, 10);
  const Instant<double> now{3, 0.02};
  const std::vector<Flight<double>> flights{{{0, 0, 0}, {0, 0, 0}, now}, {position, velocity, now}};
  const std::vector<double> radii{0.002, 0.002};
  const auto own = search.state(flights[0], now);
  std::vector<int> list{0, 1, 0, 0, 0};
  PairFilterResult result;
  result.make_room(2);
  const int found = filter_pairs(flights.data(), radii.data(), 0,
      {own, 0.002, now, search.filter()}, 0, list.data(), 2, result);
  return {found, found == 0 ? 0.0 : result.delay(result.candidates()[0])};
}

TEST(FlightColumns, TwoThatHaveJustCollidedAndSeparateAreNoCandidates) {
  EXPECT_EQ(filter_pair({0.004, 0, 0}, {0.1, 0.5, 0}).candidates, 0);
}

TEST(FlightColumns, WhatTouchesOrGrazesIsLeftToTheSearch) {
  for (const auto& [position, velocity] : std::vector<std::pair<Vec3<double>, Vec3<double>>>{
           {{0.004, 0, 0}, {-0.1, 0.5, 0}},                // touch and approach
           {{0.004 * (1 + 1e-15), 0, 0}, {-0.1, 0.5, 0}},  // the same, with a gap by rounding
           {{0.004, 0, 0}, {0, 0.5, 0}},                   // touch and slide
           {{-0.01, 0.004, 0}, {1, 0, 0}}}) {              // will graze
    const auto [candidates, delay] = filter_pair(position, velocity);
    EXPECT_EQ(candidates, 1);
    EXPECT_LT(delay, 0);
  }
  EXPECT_EQ(filter_pair({-0.01, 0.004 * (1 + 1e-5), 0}, {1, 0, 0}).candidates, 0);  // passes
  // r.v = -0.01 and v.v = 1: at the contact the centres are 0.004 apart across 0.0039. (3.1)
  const double contact = 0.01 - std::sqrt(0.004 * 0.004 - 0.0039 * 0.0039);
  EXPECT_NEAR(filter_pair({-0.01, 0.0039, 0}, {1, 0, 0}).delay, contact, 1e-15);
}

}  // namespace
}  // namespace edmill::engine
