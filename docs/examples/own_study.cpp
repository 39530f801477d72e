// A parameter study: the dose rate over the restitution, one run on each core at a time.
#include <cstdio>
#include <edmill/run.hpp>
#include <future>
#include <string>
#include <vector>

double dose_rate(const std::string& file, double restitution) {
  const auto mill = edmill::Case::read(
      file, {"contact.restitution=" + std::to_string(restitution), "run.end_time=\"2 s\""});
  edmill::Run<double> run(mill);  // runs share nothing
  run.finish();
  return run.summary().milling_dose_rate();
}

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: own_study CASE.toml\n"), 2;
  try {
    std::vector<std::pair<double, std::future<double>>> rates;
    for (const double restitution : {0.3, 0.5, 0.7, 0.9})
      rates.emplace_back(restitution,
          std::async(std::launch::async, dose_rate, std::string(argv[1]), restitution));
    for (auto& [restitution, rate] : rates)
      std::printf("e %.1f: %.4g W\n", restitution, rate.get());
  } catch (const edmill::InputError& error) {
    for (const auto& problem : error.problems()) std::fprintf(stderr, "%s\n", problem.c_str());
    return 2;
  }
}
