// The program of a room's tests: `ROOM_tests [FILE [short|long]]` runs the tests that stand in
// FILE, all of them, those without "Long" in their names or those with it; without FILE, what
// --gtest_filter selects.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <string_view>

namespace {

bool selected(const testing::TestSuite& suite, const testing::TestInfo& test, std::string_view file,
    std::string_view part) {
  if (!std::string_view(test.file()).ends_with(file)) {
    return false;
  }
  // A test with parameters has the name of its list in that of the suite: "LongAll/Names".
  const bool is_long = (std::string(suite.name()) + test.name()).find("Long") != std::string::npos;
  return part.empty() || is_long == (part == "long");
}

std::string names_of(std::string_view file, std::string_view part) {
  std::string names;
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *all.GetTestSuite(i);
    for (int j = 0; j < suite.total_test_count(); ++j) {
      const testing::TestInfo& test = *suite.GetTestInfo(j);
      if (selected(suite, test, file, part)) {
        names += std::string(suite.name()) + "." + test.name() + ":";
      }
    }
  }
  return names;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (argc > 1) {
    const std::string names = names_of(argv[1], argc > 2 ? argv[2] : "");
    if (names.empty()) {
      std::fprintf(stderr, "no such test: %s\n", argv[1]);
      return 1;
    }
    GTEST_FLAG_SET(filter, names);
  }
  return RUN_ALL_TESTS();
}
