// Every type of output stands in one row, by which it is read and made.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "base/errors.hpp"
#include "casefile/output_entry.hpp"
#include "core.hpp"
#include "program.hpp"
#include "spex_case.hpp"

namespace edmill {
namespace {

/// An entry of a type with the keys that it needs.
std::string entry_of(std::string_view type) {
  std::string keys;
  if (type == "frequency")
    keys = "variable = \"milling_dose\"\nlow = \"0 J\"\nhigh = \"1 J\"\n";
  else if (type == "statistics" || type == "trends")
    keys = "columns = [{ variable = \"milling_dose\", statistics = [\"sum\"] }]\n";
  else if (type == "treatment")
    keys = "share_per_impact = 1e-5\n";
  else if (type == "trends_instant")
    keys = "columns = [{ variable = \"milling_dose\" }]\n";
  else if (type == "trends_balls")
    keys = "columns = [{ variable = \"speed\", statistics = [\"sum\"] }]\n";
  return "[[output]]\ntype = \"" + std::string(type) + "\"\n" + keys;
}

casefile::CaseSpec case_with(const std::string& outputs) {
  return casefile::parse_case(testing::spex_text("end_time = \"1 ms\"", "restitution = 0.5",
                                  testing::batch(1, "9.52 mm") + outputs),
      "case.toml");
}

class OutputRegistry : public ProgramTest {
 protected:
  template <class Real> void commit_all(const casefile::CaseSpec& spec) const {
    output::Outputs<Real> outputs(spec, casefile::build_mill<Real>(spec), scratch, Real(0));
    for (io::WholeFile* file : outputs.complete(false)) file->commit();
  }
};

TEST_F(OutputRegistry, EveryTypeIsReadAndMade) {
  std::set<std::string_view> names;
  for (const auto& type : casefile::output_types()) {
    EXPECT_TRUE(names.insert(type.name).second) << type.name << " stands there twice";
    const auto spec = case_with(entry_of(type.name));
    ASSERT_EQ(spec.outputs.size(), 1u);
    const auto& output = spec.outputs.front();
    EXPECT_EQ(output.file, std::string(type.name) + std::string(type.extension));
    commit_all<double>(spec);
    // A snapshot is made of an impact.
    EXPECT_EQ(std::filesystem::exists(scratch / output.file), type.name != "snapshot") << type.name;
    std::filesystem::remove(scratch / output.file);
    commit_all<mpfr>(spec);
    EXPECT_EQ(std::filesystem::exists(scratch / output.file), type.name != "snapshot") << type.name;
  }
}

TEST_F(OutputRegistry, ATypeThatIsNotThereIsNotDropped) {
  auto spec = case_with(entry_of("trace"));
  spec.outputs.front().type = "tracks";
  EXPECT_THROW(commit_all<double>(spec), ContractError);
}

TEST(OutputsPage, EveryTypeSaysWhatItWrites) {
  for (const auto& type : casefile::output_types())
    EXPECT_FALSE(type.what.empty()) << type.name;  // docs/reference.md is made from it
}

}  // namespace
}  // namespace edmill
