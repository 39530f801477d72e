// A custom contact law: balls that rebound less the faster they meet, as viscoelastic ones do, with
// Coulomb's friction; compared with the law of the case.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <edmill/run.hpp>

/// e_n = 1 / (1 + a g_n^(1/5)), a formula with the trend of Ramirez et al. 1999, and (2.24').
class Viscoelastic : public edmill::CustomLaw<double> {
 public:
  Viscoelastic(double loss, double friction) : loss_(loss), friction_(friction) {}

  double restitution(const double& approach_speed) const override {
    return 1 / (1 + loss_ * std::pow(approach_speed, 0.2));
  }
  double restitution_of_slip(const double& normal_change, const double& slip_speed,
      const double& compliance) const override {
    const double stopped =
        friction_ * compliance * normal_change;  // slip that friction can take away
    return slip_speed > 0 ? std::max(-1.0, 1 - stopped / slip_speed) : 1;
  }
 private:
  double loss_, friction_;
};

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: own_contact_law CASE.toml\n"), 2;
  try {
    const auto mill = edmill::Case::read(argv[1]);
    const auto law = std::make_shared<Viscoelastic>(0.9, 0.4);
    for (const auto& laws : {edmill::Laws<double>{}, edmill::Laws<double>{law, law}}) {
      edmill::Run<double> run(mill, laws);
      run.advance_to(2.0);
      std::printf("%s: %.4g W\n", laws.ball_ball ? "viscoelastic" : "law of the case",
          run.summary().milling_dose_rate());
    }
  } catch (const edmill::InputError& error) {
    for (const auto& problem : error.problems()) std::fprintf(stderr, "%s\n", problem.c_str());
    return 2;
  }
}
