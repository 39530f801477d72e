// What a message says: the key that is wrong and no other, and what a mistyped word was meant to
// be.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "base/errors.hpp"
#include "casefile/case_spec.hpp"
#include "casefile/keys.hpp"
#include "casefile/nearest.hpp"

namespace edmill::casefile {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string text_of(const std::vector<std::string>& lines) {
  std::string text;
  for (const auto& line : lines) text += line + "\n";
  return text;
}

std::vector<std::string> problems_of(const std::string& text) {
  try {
    parse_case(text, "case.toml");
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

/// The key that a message is about; empty when it names none.
std::string key_of(const std::string& message) {
  const std::string mark = "key '";
  const auto begin = message.find(mark);
  if (begin == std::string::npos) return "";
  return message.substr(
      begin + mark.size(), message.find('\'', begin + mark.size()) - begin - mark.size());
}

/// Cases with every motion and vessel, late times, materials and outputs.
std::vector<std::string> cases() {
  std::vector<std::string> texts;
  for (const char* name :
      {"demo", "planetary", "materials", "shaken_box", "thesis_chapter4", "files"}) {
    std::ifstream in(
        std::filesystem::path(EDMILL_SOURCE_DIR) / "docs/examples" / (std::string(name) + ".toml"));
    texts.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  const std::string rest =
      "[contact]\nrestitution = 0.5\nfriction = 0.4\n[[balls]]\ncount = 2\ndiameter = \"5 mm\"\n";
  const std::string run = "[run]\ninitial_time = \"1 s\"\nend_time = \"2 s\"\n";
  texts.push_back(
      run + "[vessel]\ntype = \"capsule\"\ndiameter = \"38 mm\"\nheight = \"57 mm\"\n" + rest);
  texts.push_back(run + "[vessel]\ntype = \"sphere\"\ndiameter = \"46 mm\"\n" + rest);
  texts.push_back(run +
      "[mill]\ntype = \"drum\"\nspeed = \"60 rpm\"\n[vessel]\ndiameter = \"38 mm\"\nheight = \"57 "
      "mm\"\n"
      "[[vessel.piston]]\nwall = \"cap +y\"\ndistance = \"2 mm\"\n" +
      rest);
  texts.push_back(run +
      "[mill]\ntype = \"chain\"\n[[mill.joint]]\nrotate = \"y\"\nspeed = \"60 "
      "rpm\"\n[[mill.joint]]\n"
      "translate = \"x\"\ndistance = \"75 mm\"\nspeed = \"1 mm/s\"\n[vessel]\n"
      "diameter = \"38 mm\"\nheight = \"57 mm\"\n" +
      rest);
  return texts;
}

/// Calls f(line, path) with each line of a case that gives a key.
template <class F> void for_each_key(const std::vector<std::string>& lines, F&& f) {
  std::string section;
  std::map<std::string, int> entries;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const auto& line = lines[k];
    if (line.starts_with("[[")) {
      const auto name = line.substr(2, line.find("]]") - 2);
      section = name + "." + std::to_string(entries[name]++);
    } else if (line.starts_with("[")) {
      section = line.substr(1, line.find(']') - 1);
    } else if (const auto equals = line.find(" = ");
               equals != std::string::npos && line[0] != '#' && line[0] != ' ') {
      f(k, section + "." + line.substr(0, equals));
    }
  }
}

/// Keys that decide which other keys there are, or that others refer to.
bool decides(const std::string& path) {
  static const std::set<std::string> names{
      "type", "model", "rotate", "translate", "name", "material", "materials"};
  const auto name = path.substr(path.rfind('.') + 1);
  return names.contains(name) || path.starts_with("vessel.materials");
}

TEST(Messages, AKeyThatIsMissingIsTheOnlyOneThatIsNamed) {
  for (const auto& text : cases()) {
    ASSERT_TRUE(problems_of(text).empty()) << problems_of(text)[0];
    const auto lines = lines_of(text);
    for_each_key(lines, [&](std::size_t k, const std::string& path) {
      if (decides(path) || lines[k].ends_with("[")) return;
      auto without = lines;
      without[k] = "";
      // A ball may lack what its material lacks, and an entry is about all of its keys. A
      // translation needs an end.
      const auto entry = path.substr(0, path.rfind('.'));
      const auto name = path.substr(path.rfind('.') + 1);
      for (const auto& message : problems_of(text_of(without)))
        EXPECT_TRUE(key_of(message).starts_with(path) || key_of(message).ends_with("." + name) ||
            (entry.find('.') != std::string::npos && key_of(message).starts_with(entry)) ||
            message.ends_with(path))
            << message << "\nwithout " << path;
    });
  }
}

TEST(Messages, AValueThatIsWrongIsNamedByItsKeyAndNoKeyThatIsNotGiven) {
  int refused = 0;
  for (const auto& text : cases()) {
    const auto lines = lines_of(text);
    std::set<std::string> given;
    for_each_key(lines, [&](std::size_t, const std::string& path) { given.insert(path); });
    for_each_key(lines, [&](std::size_t k, const std::string& path) {
      const auto begin = lines[k].find_first_of("0123456789", lines[k].find(" = "));
      if (decides(path) || begin == std::string::npos || lines[k].find('[') != std::string::npos)
        return;
      const auto end = lines[k].find_first_not_of("0123456789.", begin);
      const auto rest = end == std::string::npos ? "" : lines[k].substr(end);
      for (const auto* number : {"1e20", "-1", "0", "1e-20", "4e9", "1,5", "x"}) {
        auto wrong = lines;
        wrong[k] = lines[k].substr(0, begin) + number + rest;
        for (const auto& message : problems_of(text_of(wrong))) {
          ++refused;
          EXPECT_EQ(message.find("': missing"), std::string::npos) << wrong[k] << ": " << message;
          const auto key = key_of(message);
          const auto is_of = [&](const auto& g) {
            return g.starts_with(key) || key.starts_with(g);
          };
          EXPECT_TRUE(std::any_of(given.begin(), given.end(), is_of))
              << wrong[k] << ": " << message;
        }
      }
    });
  }
  EXPECT_GT(refused, 200);
}

TEST(Messages, AnEmptyListIsNoOutputAndElseAMistake) {
  const std::string demo = cases().front();
  EXPECT_EQ(problems_of("output = []\n" + demo), std::vector<std::string>{});
  for (const char* key : {"ball", "material"})
    EXPECT_EQ(problems_of(key + std::string(" = []\n") + demo).size(), 1u) << key;
}

TEST(Messages, ALateBeginningIsNamedByTheInitialTimeAlone) {
  const auto problems = problems_of(
      "[run]\ninitial_time = \"1e15 s\"\nmax_collisions = 5\n[vessel]\ndiameter = \"38 "
      "mm\"\nheight = \"57 "
      "mm\"\n"
      "[contact]\nrestitution = 0.5\nfriction = 0.4\n[[balls]]\ndiameter = \"5 mm\"\n");
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(key_of(problems[0]), "run.initial_time");
}

TEST(Nearest, WordsThatAreKnownToBeMistyped) {
  const std::vector<std::string> keys{
      "end_time", "initial_time", "seed", "height", "diameter", "least_separation", "type"};
  for (const auto& [word, meant] : std::map<std::string, std::string>{{"endTime", "end_time"},
           {"end-time", "end_time"}, {"end", "end_time"}, {"heigth", "height"}, {"dia", "diameter"},
           {"least_separation_speed", "least_separation"}, {"Seed", "seed"}, {"tpye", "type"},
           {"x", ""}, {"to", ""}, {"mass", ""}, {"", ""}, {"colour", ""}})
    EXPECT_EQ(nearest(word, keys), meant) << word;
  EXPECT_EQ(nearest_of("heigth", {"height", "type"}), "'height', or another of: height, type");
  EXPECT_EQ(nearest_of("x", {"height", "type"}), "one of: height, type");
}

/// Whether two words are one replacement, insertion, deletion or swap of neighbours apart, by
/// trying each.
bool one_mistake_apart(const std::string& a, const std::string& b) {
  const auto& longer = a.size() < b.size() ? b : a;
  const auto& shorter = a.size() < b.size() ? a : b;
  for (std::size_t k = 0; k < longer.size(); ++k) {
    std::string without = longer, replaced = longer, swapped = longer;
    without.erase(k, 1);
    if (k < shorter.size()) replaced[k] = shorter[k];
    if (k + 1 < longer.size()) std::swap(swapped[k], swapped[k + 1]);
    if (without == shorter || replaced == shorter || swapped == shorter) return true;
  }
  return false;
}

/// A key with a letter that is wrong, missing, doubled or swapped with the next is found among
/// those of its section, unless another is as near.
RC_GTEST_PROP(Nearest, FindsEveryKeyWithAMistake, ()) {
  const auto sections = key_sections();
  const auto& keys = sections[*rc::gen::inRange<std::size_t>(0, sections.size())].keys;
  const auto& key = *rc::gen::elementOf(keys);
  RC_PRE(key.name.size() > 3);
  std::vector<std::string> section;
  for (const auto& other : keys) section.push_back(other.name);
  const auto at = *rc::gen::inRange<std::size_t>(0, key.name.size() - 1);
  std::string word = key.name;
  switch (*rc::gen::inRange(0, 4)) {
    case 0: word[at] = *rc::gen::inRange('a', 'z'); break;
    case 1: word.erase(at, 1); break;
    case 2: word.insert(at, 1, word[at]); break;
    default: std::swap(word[at], word[at + 1]);
  }
  const auto found = nearest(word, section);
  RC_ASSERT(found == key.name || one_mistake_apart(word, found));
}

}  // namespace
}  // namespace edmill::casefile
