// The collision log of a case in double, and on standard error its summary: extending_test builds
// it with changed sources.
//
// usage: collision_bits CASE.toml COLLISIONS [SETTING...]
#include <cstdlib>
#include <iostream>

#include "base/scalar_list.hpp"
//
#include "../support/simulated.hpp"
#include "output/collision_log.hpp"

namespace {

using edmill::engine::Simulation;

class Log : public edmill::engine::Observer<double> {
 public:
  explicit Log(std::uint64_t collisions) : collisions_(collisions) {}

  void on_impact(
      const edmill::engine::Impact<double>& impact, Simulation<double>& simulation) override {
    std::cout << edmill::output::collision_line(impact, simulation, false) << '\n';
    if (impact.index + 1 == collisions_)
      simulation.request_stop(edmill::engine::EndReason::stopped);
  }
 private:
  std::uint64_t collisions_;
};

}  // namespace

int main(int argc, char** argv) {
  const auto spec = edmill::casefile::read_case(argv[1], {argv + 3, argv + argc});
  const auto built = edmill::casefile::build_case<double>(spec);
  Log log(std::strtoull(argv[2], nullptr, 10));
  std::cout << edmill::output::collision_log_header(false) << '\n';
  std::cerr << edmill::io::summary_json(edmill::simulated(spec, built, &log));
}
