// A custom stop rule: the run ends when every ball has hit each wall and another ball.
#include <cstdio>
#include <edmill/run.hpp>
#include <vector>

class UntilAllHaveMetAll : public edmill::Observer<double> {
 public:
  UntilAllHaveMetAll(int balls, int walls) : met_(balls, std::vector<bool>(walls + 1)) {}

  void on_impact(const edmill::Impact<double>& impact, edmill::Run<double>& run) override {
    if (impact.with_wall) {
      met_[impact.ball][impact.partner] = true;
    } else {
      met_[impact.ball].back() = met_[impact.partner].back() = true;
    }
    for (const auto& partners : met_)
      for (const bool met : partners)
        if (!met) return;
    run.stop();
  }
 private:
  std::vector<std::vector<bool>> met_;  // of each ball: each wall, and balls at the end
};

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: own_stop_rule CASE.toml\n"), 2;
  try {
    edmill::Run<double> run(edmill::Case::read(argv[1]));
    const auto walls = static_cast<int>(run.summary().partners.size()) - 1;
    UntilAllHaveMetAll rule(run.ball_count(), walls);
    run.attach(rule);
    run.finish();
    std::printf("%s at %.6g s\n", run.summary().end_reason.c_str(), run.time());
  } catch (const edmill::InputError& error) {
    for (const auto& problem : error.problems()) std::fprintf(stderr, "%s\n", problem.c_str());
    return 2;
  }
}
