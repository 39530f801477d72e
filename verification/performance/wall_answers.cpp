// What an uncertified wall search costs and misses, on states of certified runs.
#include <algorithm>
#include <memory>

#include "subjects.hpp"
#include "uncertified_search.hpp"

namespace edmill::performance {

namespace {

/// A ball just after an impact.
struct State {
  dynamics::Flight<double> flight;
  double radius;
  Instant<double> begin;
  double until;  ///< the wait for its next pair contact, at most one drive period [s]
};

class StateHarvest : public engine::Observer<double> {
 public:
  StateHarvest(const dynamics::PairSearch<double>& pairs, std::size_t wanted)
      : pairs_(pairs), wanted_(wanted) {}

  void on_impact(const engine::Impact<double>& impact, engine::Simulation<double>& s) override {
    if (states.size() >= wanted_) return s.request_stop(engine::EndReason::interrupted);
    take(impact.ball, s);
    if (!impact.with_wall) take(impact.partner, s);
  }

  std::vector<State> states;
 private:
  void take(int ball, const engine::Simulation<double>& s) {
    const auto own = pairs_.state(s.flight(ball), s.now());
    double until = s.clock().period();
    for (int other = 0; other < s.ball_count(); ++other) {
      if (other == ball) continue;
      const auto answer = pairs_(
          own, s.flight(other), s.now(), s.properties(ball).radius + s.properties(other).radius);
      if (answer.verdict == dynamics::Verdict::contact) until = std::min(until, answer.delay);
    }
    states.push_back({s.flight(ball), s.properties(ball).radius, s.now(), until});
  }

  const dynamics::PairSearch<double>& pairs_;
  std::size_t wanted_;
};

using Query = dynamics::WallQuery<double>;

/// The wait for a state's first wall contact before its next pair contact, or for that one [s]:
/// window after window as the engine asks.
template <class Search>
double first_contact(const State& state, const SpexSearch& walls, const Search& search) {
  const auto& clock = walls.mill().clock;
  const double longest = walls.longest_window();
  for (double done = 0; done < state.until;) {
    const auto begin = clock.after(state.begin, done);
    const double length = std::clamp(state.until - done, longest / 4096, longest);
    const auto answer = search(Query{state.flight, state.radius, begin, length});
    if (answer.verdict == dynamics::Verdict::contact)
      return std::min(clock.elapsed(state.begin, answer.time), state.until);
    done += answer.searched;
  }
  return state.until;
}

/// States of a run past its transient, with the certified answers.
struct Source {
  explicit Source(const casefile::InitialCase<double>& built)
      : ladder(built.the_case.mill, 2 * built.the_case.balls.front().radius, 20.0),
        walls(spex_search(built.the_case.mill)) {
    Run<double> run(built);
    run.until(0.5);
    StateHarvest harvest(ladder.pairs(), wanted);
    run.simulation().attach(harvest);
    run.until(100);
    states = std::move(harvest.states);
    states.resize(wanted);
    for (const auto& s : states)
      answers.push_back(first_contact(s, walls, [&](const Query& q) { return ladder.wall(q); }));
  }
  static constexpr int wanted = 400000;
  dynamics::DecisionLadder<double> ladder;
  SpexSearch walls;
  std::vector<State> states;
  std::vector<double> answers;
};

Source& source_of(const SpexSubject& subject) {
  static const char* name = nullptr;
  static std::unique_ptr<Source> source;
  if (name != subject.name)
    source = std::make_unique<Source>(
        casefile::build_case<double>(casefile::parse_case(spex_text(subject), "bench.toml")));
  name = subject.name;
  return *source;
}

/// Times the answers to all states and counts those that are wrong by more than a nanosecond.
template <class Search>
void wall_answers(benchmark::State& state, const Source& source, const Search& search) {
  std::vector<double> found;
  found.reserve(source.states.size());
  for (auto _ : state)
    found.push_back(first_contact(source.states[found.size()], source.walls, search));
  int late = 0, early = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    late += found[k] > source.answers[k] + 1e-9;
    early += found[k] < source.answers[k] - 1e-9;
  }
  state.counters["late"] = late;
  state.counters["early"] = early;
}

void certified(benchmark::State& state, Source& source) {
  wall_answers(state, source, [&](const Query& query) { return source.ladder.wall(query); });
}

void uncertified(benchmark::State& state, Source& source, int samples) {
  const auto& walls = source.walls;
  wall_answers(state, source, [&](const Query& query) {
    const SpexFunctions functions(walls.mill(), query.flight, query.radius, query.begin.period);
    return uncertified_search(
        walls, functions, functions.start(query.begin.offset), query, samples);
  });
}

}  // namespace

void register_wall_answers() {
  for (const auto& subject : spex_subjects) {
    const auto add = [&](const std::string& search, const auto& function) {
      const std::string name = std::string("operation/wall_answer/") + subject.name + "/" + search;
      benchmark::RegisterBenchmark(name.c_str(), function)->Iterations(Source::wanted);
    };
    add("certified", [&](benchmark::State& s) { certified(s, source_of(subject)); });
    for (const int samples : {1, 2, 8, 32})
      add("uncertified_" + std::to_string(samples),
          [&, samples](benchmark::State& s) { uncertified(s, source_of(subject), samples); });
  }
}

}  // namespace edmill::performance
