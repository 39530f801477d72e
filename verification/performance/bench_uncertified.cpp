// The benchmarks with an uncertified wall search: what certification costs.
//
// The specialisation stands in for the search of the library once a wall is within reach, and the instances
// made here for the library's own in double, which the linker then leaves out. The program knows nothing of
// this.
#include <cstdlib>

#include "uncertified_search.hpp"

namespace edmill::dynamics {

namespace {
/// Sample points for each longest window; EDMILL_SAMPLES in the environment sets another number.
const int samples = std::getenv("EDMILL_SAMPLES") ? std::atoi(std::getenv("EDMILL_SAMPLES")) : 8;
}  // namespace

template <>
template <>
WallAnswer<double> WallSearch<double>::first_contact<false>(const Functions& functions,
                                                            const GapStart<double>& first, WallSet,
                                                            const double&, const WallQuery<double>& query,
                                                            RoughAnswer*) const {
  return performance::uncertified_search(*this, functions, first, query, samples);
}

}  // namespace edmill::dynamics

#include "instances/implementations.hpp"
#include "subjects.hpp"

EDMILL_INSTANCES(template, double)

int main(int argc, char** argv) {
  edmill::performance::register_spex();
  edmill::performance::register_operations();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
