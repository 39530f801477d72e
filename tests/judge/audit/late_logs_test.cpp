// Logs of edmill that begin late, where a double knows the time badly, at many tolerances: no false
// alarm; and a violation well above what the tolerance allows is still found.
#include <gtest/gtest.h>

#include "any_mills.hpp"
#include "audit/audit.hpp"
#include "base/errors.hpp"
#include "program.hpp"

namespace edmill::audit {
namespace {

class LateLogs : public ProgramTest {
 protected:
  static constexpr int impacts = 300;

  /// Runs a mill from this time on. @return whether it can: a run has fewer than 1e15 drive periods
  bool run(const testing::MillText& mill, double start) {
    const std::string begin =
        fmt::format("initial_time = \"{} s\"\nend_time = \"{} s\"\nmax_collisions = {}", start,
            start + 100, impacts);
    const std::string balls =
        "[[balls]]\ncount = 8\ndiameter = \"4.76 mm\"\n[[balls]]\ncount = 2\ndiameter = \"9 mm\"\n"
        "reduced_inertia = 0.5\n";
    spec_text = "[run]\n" + begin + "\n" + mill.gravity + "\n[mill]\n" + mill.mill +
        "\n[vessel]\n" + mill.vessel + "\n[contact]\nfriction = 0.4\nrestitution = 0.53\n" + balls;
    write("case.toml", spec_text);
    std::filesystem::remove_all(scratch / "out");
    const auto made = edmill(
        "run case.toml --quiet --out out --set 'output=[{type=\"collisions\", states=true}]'");
    if (made.code == 2) return false;
    EXPECT_EQ(made.code, 0) << mill.name << " from " << start << " s: " << made.err;
    return made.code == 0;
  }
  Audit judged(double tolerance) const {
    const auto built =
        casefile::build_case<double>(casefile::parse_case(spec_text, "case.toml"), false);
    Options options;
    options.log = scratch / "out";
    options.from_start = true;
    options.tolerance = tolerance;
    return audit(built.the_case, built.states, options);
  }
  std::string spec_text;
};

TEST_F(LateLogs, AreCleanAtEveryStartAndTolerance) {
  int clean = 0, unresolved = 0;
  for (const auto& mill : testing::all_mills) {
    if (mill.own != testing::OwnVessel::none) continue;
    for (const double start : {0.0, 1e5, 3e6, 1e9, 1e11, 1e12, 1e13}) {
      if (!run(mill, start)) continue;
      for (const double tolerance : {1e-9, 1e-6, 1e-3, 1e-2, 3e-2, 0.1}) {
        const auto result = judged(tolerance);
        EXPECT_EQ(result.findings.total(), 0u)
            << mill.name << " from " << start << " s at " << tolerance << "\n"
            << table(result);
        // What is not checked is told.
        const bool told = result.findings.unresolved_number(Check::touch) > 0;
        EXPECT_TRUE(
            result.verdict == Verdict::agree || (result.verdict == Verdict::too_few && told))
            << mill.name << " from " << start << " s";
        (result.verdict == Verdict::agree ? clean : unresolved) += 1;
      }
    }
  }
  EXPECT_GT(clean, 300);
  std::cout << clean << " clean, " << unresolved << " of which most cannot be checked\n";
}

TEST_F(LateLogs, AMillInWhichTheTimeTellsNothingIsNotCalledClean) {
  const testing::MillText drum{"drum", "type = \"drum\"\nspeed = \"6 rpm\"",
      "type = \"sphere\"\ndiameter = \"60 mm\"", "gravity = \"9.8 m/s2\""};
  ASSERT_TRUE(run(drum, 1e15));
  const auto result = judged(1e-9);
  EXPECT_EQ(result.findings.total(), 0u) << table(result);
  EXPECT_NE(table(result).find("could not be checked"), std::string::npos) << table(result);
}

TEST_F(LateLogs, AViolationAboveTheToleranceIsFound) {
  const auto& mill = testing::mill_named("spex_cylinder");
  for (const double start : {0.0, 3e6, 1e9}) {
    ASSERT_TRUE(run(mill, start));
    const auto right = contents(scratch / "out/collisions.csv");
    const auto changed = [&](std::size_t column, double factor) {
      std::istringstream in(right);
      std::string line, text;
      for (int number = 0; std::getline(in, line); ++number) {
        if (number >= 100 && number % 50 == 0) {
          std::vector<std::string> cells;
          std::istringstream parts(line);
          for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
          cells.resize(39);  // those of a wall are empty
          cells[column] = fmt::format("{}", std::stod(cells[column]) * factor);
          line = fmt::format("{}", fmt::join(cells, ","));
        }
        text += line + "\n";
      }
      write("out/collisions.csv", text);
      const double by_time =
          logs::rounding_of(start) * 3000;  // a share of a speed: the normal of the cylinder
      return judged(std::max(1e-9, by_time / 100)).findings;
    };
    // Velocities after an impact, positions and doses that are off by a hundredth.
    EXPECT_GT(changed(18, 1.01).of(Kind::normal_restitution).count +
            changed(18, 1.01).of(Kind::spin_change).count,
        0u)
        << start;
    EXPECT_GT(changed(9, 1.01).of(Kind::non_ballistic).count, 0u) << start;
    // At 1e9 s five hundredths of a dose are within what the rounding of the time allows.
    if (start < 1e9) {
      EXPECT_GT(changed(7, 1.05).of(Kind::milling_dose).count, 0u) << start;
    }
  }
}

}  // namespace
}  // namespace edmill::audit
