// A vessel of one's own: a hexagonal jar with the round vial's size, moved as the case says, beside
// the vial.
#include <cmath>
#include <cstdio>
#include <edmill/run.hpp>

/// Walls 0 to 5 around the y axis at `apothem` from it, 6 and 7 the ends.
edmill::Planes<double> hexagonal_jar(double apothem, double half_height) {
  edmill::Planes<double> walls;
  const double half = 0.5, root = std::sqrt(3.0) / 2;
  for (const double side : {1.0, -1.0}) {
    walls.push_back({{side, 0, 0}, apothem});
    walls.push_back({{side * half, 0, side * root}, apothem});
    walls.push_back({{-side * half, 0, side * root}, apothem});
  }
  walls.push_back({{0, -1, 0}, half_height});
  walls.push_back({{0, 1, 0}, half_height});
  return walls;
}

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: own_vessel CASE.toml\n"), 2;
  try {
    const auto mill = edmill::Case::read(argv[1]);
    const auto jar = hexagonal_jar(0.019, 0.0285);
    for (const auto& vessel : {edmill::Planes<double>{}, jar}) {
      edmill::Run<double> run(mill, {}, vessel);
      run.advance_to(2.0);
      const auto summary = run.summary();
      std::printf("%s: %.4g W, %zu kinds of partners\n",
          vessel.empty() ? "vessel of the case" : "hexagonal jar", summary.milling_dose_rate(),
          summary.partners.size());
    }
  } catch (const edmill::InputError& error) {
    for (const auto& problem : error.problems()) std::fprintf(stderr, "%s\n", problem.c_str());
    return 2;
  }
}
