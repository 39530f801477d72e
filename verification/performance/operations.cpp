// Nanoseconds of the single operations of the loop, on states taken from real runs.
#include <algorithm>
#include <memory>
#include <numeric>
#include <random>

#include "subjects.hpp"

namespace edmill::performance {

namespace {

struct PairQuestion {
  dynamics::Flight<double> one, two;
  Instant<double> now;
  double radius_sum;
};

/// The questions that the loop asks just after an impact.
struct Questions {
  std::vector<dynamics::WallQuery<double>> walls;  ///< up to the ball's nearest pair contact
  std::vector<PairQuestion> pairs;                 ///< partners nearer than three diameters
};

class Harvest : public engine::Observer<double> {
 public:
  explicit Harvest(std::size_t walls) : ladder_(nullptr), wanted_(walls) {}
  void begin(const dynamics::DecisionLadder<double>& ladder) { ladder_ = &ladder; }

  void on_impact(const engine::Impact<double>& impact, engine::Simulation<double>& s) override {
    if (questions.walls.size() >= wanted_) return s.request_stop(engine::EndReason::interrupted);
    take(impact.ball, s);
    if (!impact.with_wall) take(impact.partner, s);
  }

  Questions questions;
 private:
  void take(int ball, const engine::Simulation<double>& s) {
    const auto& pairs = ladder_->pairs();
    const auto now = s.now();
    const auto own = pairs.state(s.flight(ball), now);
    double length = ladder_->walls().longest_window();
    for (int other = 0; other < s.ball_count(); ++other) {
      if (other == ball) continue;
      const double sum = s.properties(ball).radius + s.properties(other).radius;
      const auto seen = pairs.state(s.flight(other), now);
      if (norm<double>(own.position - seen.position) > 3 * sum) continue;
      const auto answer = pairs(own, s.flight(other), now, sum);
      if (answer.verdict == dynamics::Verdict::contact) length = std::min(length, answer.delay);
      if (questions.pairs.size() < 4 * wanted_)
        questions.pairs.push_back({s.flight(ball), s.flight(other), now, sum});
    }
    length = std::max(length, ladder_->walls().longest_window() / 4096);
    questions.walls.push_back({s.flight(ball), s.properties(ball).radius, now, length});
  }

  const dynamics::DecisionLadder<double>* ladder_;
  std::size_t wanted_;
};

/// A run past its transient and what it asks next.
struct Source {
  explicit Source(const casefile::InitialCase<double>& built, double warm_up)
      : ladder(built.the_case.mill, 2 * built.the_case.balls.front().radius, 20.0), harvest(4096) {
    Run<double> run(built);
    run.until(warm_up);
    harvest.begin(ladder);
    run.simulation().attach(harvest);
    run.until(warm_up + 100);
  }
  dynamics::DecisionLadder<double> ladder;
  Harvest harvest;
};

Source& shaken() {
  static Source source(
      casefile::build_case<double>(casefile::parse_case(spex_text(spex_subjects[1]), "bench.toml")),
      0.5);
  return source;
}
Source& gas() {
  static Source source(still_gas(1000, 0.26), 0.05);
  return source;
}

void wall_query(benchmark::State& state, Source& source, bool whole_window) {
  auto questions = source.harvest.questions.walls;
  if (whole_window)
    for (auto& q : questions) q.length = source.ladder.walls().longest_window();
  std::size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(source.ladder.wall(questions[k]));
    if (++k == questions.size()) k = 0;
  }
}

void pair_query(benchmark::State& state, Source& source) {
  const auto& questions = source.harvest.questions.pairs;
  std::vector<dynamics::PairSearch<double>::State> seen;
  for (const auto& q : questions) seen.push_back(source.ladder.pairs().state(q.one, q.now));
  std::size_t k = 0;
  for (auto _ : state) {
    const auto& q = questions[k];
    benchmark::DoNotOptimize(source.ladder.pair(seen[k], q.one, q.two, q.now, q.radius_sum));
    if (++k == questions.size()) k = 0;
  }
}

/// The earliest ball gets a new time: what every event costs the queue.
void queue_operation(benchmark::State& state, int balls) {
  const DriveClock<double> clock(0.05);
  engine::EventQueue<double> queue(balls, clock.period());
  std::mt19937_64 random(20110101);
  std::exponential_distribution<double> wait;
  std::vector<double> waits(1 << 16);
  for (auto& w : waits) w = wait(random) * 1e-3;
  for (int i = 0; i < balls; ++i) queue.set(i, {0, wait(random) * 1e-3});
  std::size_t k = 0;
  for (auto _ : state) {
    const int ball = queue.top();
    const auto time = queue.time(ball);
    queue.set(ball, clock.after(time, waits[k++ & (waits.size() - 1)]));
  }
}

struct alignas(64) Line {
  std::uint32_t next;
};

/// A cache line from anywhere in so much memory: where the one before it says, or wherever, so that
/// many come at once.
void memory_line(benchmark::State& state, std::size_t megabytes, bool one_by_one) {
  LargeVector<Line> lines((megabytes << 20) / sizeof(Line));
  std::vector<std::uint32_t> order(lines.size());
  std::iota(order.begin(), order.end(), 0);
  std::mt19937_64 random(20110101);
  std::shuffle(order.begin(), order.end(), random);
  for (std::size_t k = 0; k < order.size(); ++k)
    lines[order[k]].next = order[(k + 1) % order.size()];
  std::uint32_t at = 0, sum = 0;
  std::uint64_t draw = 1;
  for (auto _ : state) {
    draw = draw * 6364136223846793005u + 1442695040888963407u;
    if (one_by_one)
      at = lines[at].next;
    else
      sum += lines[(draw >> 33) & (lines.size() - 1)].next;
  }
  benchmark::DoNotOptimize(at + sum);
}

template <class Function> void add(const std::string& name, Function function) {
  benchmark::RegisterBenchmark(("operation/" + name).c_str(), function)->MinTime(0.1);
}

}  // namespace

void register_operations() {
  add("wall_query/spex_111/to_next_pair",
      [](benchmark::State& s) { wall_query(s, shaken(), false); });
  add("wall_query/spex_111/whole_window",
      [](benchmark::State& s) { wall_query(s, shaken(), true); });
  add("wall_query/gas_1000/to_next_pair", [](benchmark::State& s) { wall_query(s, gas(), false); });
  add("wall_query/gas_1000/whole_window", [](benchmark::State& s) { wall_query(s, gas(), true); });
  add("pair_query/spex_111", [](benchmark::State& s) { pair_query(s, shaken()); });
  add("pair_query/gas_1000", [](benchmark::State& s) { pair_query(s, gas()); });
  for (const int balls : {28, 1000, 100000})
    add("queue/" + std::to_string(balls), [=](benchmark::State& s) { queue_operation(s, balls); });
  for (const std::size_t size : {1, 4, 16, 64})
    for (const bool one_by_one : {true, false})
      add("memory/" + std::to_string(size) + (one_by_one ? "/one_by_one" : "/at_once"),
          [=](benchmark::State& s) { memory_line(s, size, one_by_one); });
}

}  // namespace edmill::performance
