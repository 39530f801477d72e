// A custom observer: how hard balls hit each other, as a histogram of the approach speed, and their
// mean impact energy.
#include <array>
#include <cstdio>
#include <edmill/run.hpp>

class ApproachSpeeds : public edmill::Observer<double> {
 public:
  void on_impact(const edmill::Impact<double>& impact, edmill::Run<double>& run) override {
    if (impact.with_wall) return;
    const double m = run.properties(impact.ball).mass, n = run.properties(impact.partner).mass;
    energy_ += m * n / (m + n) / 2 * impact.approach_speed * impact.approach_speed;
    ++impacts_;
    const auto bin = static_cast<std::size_t>(impact.approach_speed / width);
    ++counts_[bin < counts_.size() ? bin : counts_.size() - 1];
  }

  void print() const {
    for (std::size_t k = 0; k < counts_.size(); ++k)
      std::printf("%4.1f m/s and more: %lu\n", width * static_cast<double>(k),
          static_cast<unsigned long>(counts_[k]));
    if (impacts_ > 0)
      std::printf(
          "%.3g mJ in an impact, on average\n", 1000 * energy_ / static_cast<double>(impacts_));
  }
 private:
  static constexpr double width = 0.5;  // [m/s]
  std::array<std::uint64_t, 10> counts_{};
  std::uint64_t impacts_ = 0;
  double energy_ = 0;  ///< [J]
};

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: own_observer CASE.toml\n"), 2;
  try {
    const auto mill = edmill::Case::read(argv[1]);
    edmill::Run<double> run(mill);
    ApproachSpeeds speeds;
    run.attach(speeds);
    run.advance_to(2.0);
    speeds.print();
    const auto summary = run.summary();
    std::printf("milling dose %.6g J in %.6g s\n", summary.milling_dose, run.time());
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 2;
  }
}
