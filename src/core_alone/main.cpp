// A run of a case by the core alone, for machines that have none of the libraries of the whole program.
#include <cstdio>
#include <string>

#include "edmill/run.hpp"
#include "edmill/scalars.hpp"

namespace {

template <class Real>
void run(const edmill::Case& the_case, const char* folder) {
  edmill::Run<Real> run(the_case);
  run.write_to(folder);
  run.finish();
  run.commit();
  const auto summary = run.summary();
  std::printf("%s, %.3f s of processor time\n", summary.end_reason.c_str(), summary.cpu_seconds);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4)
    return std::fprintf(stderr, "usage: %s CASE.toml FOLDER double|float128 [key=value ...]\n", argv[0]), 2;
  try {
    const auto the_case = edmill::Case::read(argv[1], {argv + 4, argv + argc});
    const std::string precision = argv[3];
    if (precision == "double") return run<double>(the_case, argv[2]), 0;
    if (precision == "float128") return run<edmill::float128>(the_case, argv[2]), 0;
    std::fprintf(stderr, "found precision '%s', expected double or float128\n", argv[3]);
    return 2;
  } catch (const edmill::InputError& error) {
    for (const auto& problem : error.problems()) std::fprintf(stderr, "%s\n", problem.c_str());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
