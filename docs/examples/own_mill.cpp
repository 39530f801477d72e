// A machine of one's own: a conical jar on a table that shakes and tilts, neither of which a case
// file can name.
#include <cmath>
#include <cstdio>
#include <edmill/run.hpp>

using Form = edmill::Polynomial<double>;

/// Narrows by `growth` with each metre upwards from `radius` in its middle. Each wall is positive
/// where the centre of a ball of radius r is inside, and zero where the ball touches.
edmill::CurvedVessel<double> conical_jar(double radius, double growth, double half_height) {
  const auto x = Form::x(), y = Form::y(), z = Form::z(), r = Form::r();
  const auto room = radius - growth * y - std::sqrt(1 + growth * growth) * r;
  const double widest = 1.01 * (radius + growth * half_height);
  return {{room * room - x * x - z * z, half_height + y - r, half_height - y - r},
      {widest, 1.01 * half_height, widest}};
}

/// Up and down once in a drive period, to and fro three times in two, and tilted by a hundredth of
/// a turn.
edmill::Joints<double> table() {
  edmill::Joint<double> shake{false, {0, 1, 0}}, sway{false, {1, 0, 0}}, tilt{true, {0, 0, 1}};
  shake.harmonics = {{0.008, {1, 1}}};
  sway.harmonics = {{0.003, {3, 2}, 0.25}};
  tilt.harmonics = {{0.01, {1, 1}, 0.1}};
  return {shake, sway, tilt};
}

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: own_mill CASE.toml\n"), 2;
  try {
    edmill::OwnParts<double> own;
    own.vessel = conical_jar(0.019, 0.2, 0.0285);
    own.joints = table();
    edmill::Run<double> run(edmill::Case::read(argv[1]), own);
    run.advance_to(2.0);
    const auto summary = run.summary();
    std::printf("conical jar: %.4g W, %zu kinds of partners\n", summary.milling_dose_rate(),
        summary.partners.size());
  } catch (const edmill::InputError& error) {
    for (const auto& problem : error.problems()) std::fprintf(stderr, "%s\n", problem.c_str());
    return 2;
  }
}
