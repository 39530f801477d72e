// The table of keys is what the readers look up: no more and no less.
#include "casefile/keys.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <string>

#include "base/errors.hpp"
#include "casefile/case_spec.hpp"
#include "casefile/study_spec.hpp"

namespace edmill::casefile {
namespace {

/// `name = nonsense` where a file of the key's kind has its section; a table suits no key but those
/// of tables.
std::string of_joint(const Key& key, const std::string& nonsense) {
  return std::string(key.name == "distance" || key.name == "translate" ? "translate = \"x\"\n"
                                                                       : "rotate = \"x\"\n") +
      (key.name == "rotate" || key.name == "translate" ? "" : nonsense);
}
std::string file_with(const Key& key) {
  const auto nonsense = "\"" + key.name + "\" = { nonsense = 1 }\n";
  const auto first = key.of.substr(0, key.of.find(','));
  const std::string type = first.empty()
      ? ""
      : (key.section == "contact" ? "model" : "type") + (" = \"" + first + "\"\n");
  const auto& s = key.section;
  if (s == "run" || s == "powder" || s == "audit" || s == "audit.columns" ||
      s == "vessel.materials" || s == "sweep" || s == "optimize" || s == "sweep.grid")
    return "[" + s + "]\n" + nonsense;
  if (s == "mill" || s == "vessel" || s == "contact")
    return "[" + s + "]\n" + (key.name == "type" || key.name == "model" ? "" : type) + nonsense;
  if (s == "mill.joint")
    return "[mill]\ntype = \"chain\"\n[[mill.joint]]\n" + of_joint(key, nonsense);
  if (s == "mill.joint.swing")
    return "[mill]\ntype = \"chain\"\n[[mill.joint]]\nrotate = \"x\"\n[[mill.joint.swing]]\n" +
        nonsense;
  if (s == "body" || s == "body.joint" || s == "body.joint.swing")
    return "[[body]]\nsize = [\"1 mm\", \"1 mm\", \"1 mm\"]\n" +
        (s == "body" ? nonsense
                     : "[[body.joint]]\n" +
                    of_joint(key, s == "body.joint" ? nonsense : "[[" + s + "]]\n" + nonsense));
  if (s == "vessel.plane" || s == "vessel.vertex")
    return "[vessel]\ntype = \"polyhedron\"\n[[" + s + "]]\n" + nonsense;
  if (s == "vessel.piston" || s == "vessel.piston.swing")
    return "[vessel]\ndiameter = \"38 mm\"\nheight = \"57 mm\"\n[[vessel.piston]]\n" +
        (s == "vessel.piston" ? "" : "[[" + s + "]]\n") + nonsense;
  if (s == "material" || s == "balls" || s == "ball" || s == "contact.pair" || s == "sweep.point" ||
      s == "optimize.variable")
    return "[[" + s + "]]\n" + nonsense;
  if (s == "sweep.point.set") return "[[sweep.point]]\n[sweep.point.set]\n" + nonsense;
  if (s == "output")
    return "[[output]]\n" +
        (key.name == "type"     ? ""
                : first.empty() ? "type = \"trends\"\n"
                                : type) +
        nonsense;
  if (s == "output.only") return "[[output]]\ntype = \"trends\"\n[output.only]\n" + nonsense;
  if (s == "output.columns")
    return "[[output]]\ntype = \"" + (first.empty() ? "trends" : first) +
        "\"\n[[output.columns]]\nvariable = \"collision\"\n" +
        (key.name == "variable" ? "" : nonsense);
  if (s == "output.contact_point")
    return "[[output]]\ntype = \"snapshot\"\n[output.contact_point]\n" + nonsense;
  ADD_FAILURE() << "a section " << s << " that this test does not know";
  return "";
}

std::vector<std::string> problems_of(const std::string& section, const std::string& text) {
  try {
    if (section.starts_with("sweep") || section.starts_with("optimize")) {
      const auto file = std::filesystem::temp_directory_path() / "edmill_keys_test.toml";
      std::ofstream(file) << text;
      if (section.starts_with("sweep"))
        read_sweep(file.string());
      else
        read_optimize(file.string());
    } else {
      parse_case(text, "case.toml");
    }
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

TEST(Keys, EachIsLookedUp) {
  for (const auto& section : key_sections())
    for (const auto& key : section.keys) {
      const auto text = file_with(key);
      for (const auto& problem : problems_of(key.section, text))
        EXPECT_TRUE(problem.find(key.name + "': found an unknown key") == std::string::npos)
            << key.section << "." << key.name << " of " << key.of << ": " << problem << "\nin\n"
            << text;
    }
}

TEST(Keys, OthersAreNotLookedUp) {
  EXPECT_TRUE(is_key("output.3.columns.1", "variable"));
  EXPECT_TRUE(is_key("contact.pair.0", "friction"));
  EXPECT_TRUE(is_key("", "run"));
  EXPECT_FALSE(is_key("run", "friction"));
  EXPECT_FALSE(is_key("", "runs"));
  EXPECT_FALSE(is_key("output.3", "variables"));
}

TEST(Keys, HaveMeaningsAndAreListedOnce) {
  std::set<std::string> seen;
  for (const auto& section : key_sections()) {
    EXPECT_TRUE(seen.insert(section.name).second) << section.name << " again";
    EXPECT_FALSE(section.heading.empty()) << section.name;
    EXPECT_FALSE(section.meaning.empty()) << section.name;
    EXPECT_FALSE(section.keys.empty()) << section.name;
  }
  for (const auto& section : key_sections())
    for (const auto& key : section.keys) {
      EXPECT_EQ(key.section, section.name);
      EXPECT_FALSE(key.kind.empty()) << key.section << "." << key.name;
      EXPECT_TRUE(seen.insert(key.section + "." + key.name + " of " + key.of).second)
          << key.name << " again";
    }
}

}  // namespace
}  // namespace edmill::casefile
