// The benchmarks with an uncertified wall search: what certification costs.
#include <cstdlib>
#include <memory>

#include "subjects.hpp"
#include "uncertified_search.hpp"

namespace edmill::performance {
namespace {

/// Sample points for each longest window; EDMILL_SAMPLES in the environment sets another number.
const int samples = std::getenv("EDMILL_SAMPLES") ? std::atoi(std::getenv("EDMILL_SAMPLES")) : 8;

/// As the program's own search begins: nothing is sampled while no wall is within reach.
dynamics::AnyWallSearch<double>::Policy sampled(const model::Mill<double>& mill) {
  const auto walls = std::make_shared<const SpexSearch>(spex_search(mill));
  return [walls](const model::AnyPose<double>& any, const dynamics::WallQuery<double>& query) {
    const auto& pose = model::pose_of<model::SpexMotion<double>>(any);
    const SpexFunctions functions(walls->mill(), query.flight, query.radius, query.begin.period);
    const auto ball = functions.seen(query.begin.offset, pose);
    const double speed = norm<double>(ball.velocity) + walls->mill().gravity_size * query.length;
    if (!dynamics::any_from(
            walls->within_reach(functions, ball.state.position, speed, query.length), 0))
      return dynamics::WallAnswer<double>{dynamics::Verdict::none, -1, {}, false, query.length, 0};
    return uncertified_search(
        *walls, functions, functions.start(query.begin.offset, pose, ball), query, samples);
  };
}

}  // namespace
}  // namespace edmill::performance

int main(int argc, char** argv) {
  edmill::performance::wall_policy = edmill::performance::sampled;
  edmill::performance::register_spex();
  edmill::performance::register_operations();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
