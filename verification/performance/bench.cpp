// The benchmarks; docs/benchmarks.md says what each compares.
#include "subjects.hpp"

int main(int argc, char** argv) {
  edmill::performance::register_spex();
  edmill::performance::register_still_gas();
  edmill::performance::register_operations();
  edmill::performance::register_wall_answers();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
