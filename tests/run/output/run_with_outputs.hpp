// Runs whose outputs are checked.
#pragma once

#include <vector>

#include "csv_table.hpp"
#include "program.hpp"

namespace edmill {

class Outputs : public ProgramTest {
 protected:
  std::vector<Row> read(const std::string& file) const {
    return table(contents(scratch / "out" / file));
  }
};

/// The program of the thesis's chapter 4 with all of its outputs.
class Chapter4 : public Outputs {
 protected:
  static constexpr double end = 40;

  void SetUp() override {
    ProgramTest::SetUp();
    std::string text =
        contents(std::filesystem::path(EDMILL_SOURCE_DIR) / "docs/examples/thesis_chapter4.toml");
    text += "\n[[output]]\ntype = \"collisions\"\n";
    write("case.toml", text);
    const auto outcome = edmill(
        "run case.toml --quiet --out out --set run.end_time='\"40 s\"' --set "
        "contact.least_separation='\"3 "
        "cm/s\"'");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const auto& row : read("collisions.csv"))
      if (number(row, "time") >= 30) recorded.push_back(row);
    ASSERT_GT(recorded.size(), 100u);
  }

  /// Sums a column of the collision log from 30 s on, with one wall or with any.
  double sum(const std::string& column, const std::string& wall = "") const {
    double total = 0;
    for (const auto& row : recorded)
      if (wall.empty() || row.at("partner") == wall)
        total += column.empty() ? 1 : number(row, column);
    return total;
  }

  std::vector<Row> recorded;
};

/// Five balls for a fifth of a second.
inline const char* const small_case =
    "[run]\nend_time = \"0.2 s\"\ngravity = \"9.8 m/s2\"\n[mill]\nspeed = \"1054 rpm\"\n"
    "[vessel]\ndiameter = \"38 mm\"\nheight = \"57 mm\"\n[contact]\nrestitution = 0.53\nfriction = "
    "0.4\n"
    "[[balls]]\ncount = 5\ndiameter = \"9.52 mm\"\n";

}  // namespace edmill
