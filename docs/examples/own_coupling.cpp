// A coupling: the dose that the powder has taken changes the restitution of the next run, which
// continues from the balls' final states. The fall of the restitution with the dose is an example,
// not a measurement.
#include <cmath>
#include <cstdio>
#include <edmill/run.hpp>
#include <filesystem>
#include <string>
#include <vector>

int main(int argc, char** argv) {
  if (argc != 3) return std::fprintf(stderr, "usage: own_coupling CASE.toml FOLDER\n"), 2;
  try {
    // A relative path in a case counts from the case's file.
    const auto place = std::filesystem::absolute(argv[2]);
    double dose = 0;  // [J]
    std::vector<std::string> goes_on{"run.start_time=\"0 s\""};
    for (int second = 1; second <= 3; ++second) {
      auto settings = goes_on;
      const double restitution = 0.3 + 0.23 * std::exp(-dose / 10);
      settings.push_back("contact.restitution=" + std::to_string(restitution));
      settings.push_back("run.end_time=\"" + std::to_string(second) + " s\"");

      edmill::Run<double> run(edmill::Case::read(argv[1], settings));
      const std::string folder = (place / std::to_string(second)).string();
      run.write_to(folder);
      run.finish();
      run.commit();
      dose += run.summary().milling_dose;
      std::printf("until %d s with e %.3f: %.4g J\n", second, restitution, dose);
      // In single quotes TOML takes a text as it is.
      goes_on = {"run.start_time=\"0 s\"", "run.initial_state='" + folder + "/final_state.csv'"};
    }
  } catch (const edmill::InputError& error) {
    for (const auto& problem : error.problems()) std::fprintf(stderr, "%s\n", problem.c_str());
    return 2;
  }
}
