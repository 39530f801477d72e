// CSV is read as it is written, by edmill and by others.
#include "io/csv_reader.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <random>

#include "base/errors.hpp"
#include "io/table.hpp"

namespace edmill::io {
namespace {

using Rows = std::vector<std::vector<std::string>>;

class CsvFile {
 public:
  explicit CsvFile(const std::string& text)
      : place_(std::filesystem::temp_directory_path() /
            ("edmill-csv-" + std::to_string(getpid()) + ".csv")) {
    std::ofstream(place_, std::ios::binary) << text;
  }
  ~CsvFile() { std::filesystem::remove(place_); }
  CsvReader reader() const { return {place_, "a table"}; }
  Rows rows() const {
    auto csv = reader();
    Rows rows{csv.header()};
    while (csv.next_row()) {
      rows.emplace_back();
      for (std::size_t k = 0; k < csv.header().size(); ++k) rows.back().emplace_back(csv.field(k));
    }
    csv.throw_problems();
    return rows;
  }
 private:
  std::filesystem::path place_;
};

TEST(CsvReader, ReadsBackEveryTextOfATable) {
  std::mt19937 random(1);
  const std::string characters = "ab #\"\",;\t\n\r'x";
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<std::string> texts;
    for (int k = 0; k < 12; ++k) {
      std::string text(random() % 7, ' ');
      for (char& c : text) c = characters[random() % characters.size()];
      texts.push_back(text + std::to_string(k));  // names of columns differ
      if (random() % 2 == 0) texts.back() += ' ';
    }
    const std::vector<std::string> names(texts.begin(), texts.begin() + 3);
    Table<double> table({{names[0], Column::Type::text}, {names[1], Column::Type::text},
                            {names[2], Column::Type::text}},
        {"a comment\nin lines"});
    for (std::size_t k = 3; k < texts.size(); k += 3)
      table.put(texts[k], texts[k + 1], texts[k + 2]);
    Rows expected;
    for (std::size_t k = 0; k < texts.size(); k += 3)
      expected.push_back({texts.begin() + static_cast<std::ptrdiff_t>(k),
          texts.begin() + static_cast<std::ptrdiff_t>(k + 3)});
    EXPECT_EQ(CsvFile(table.csv()).rows(), expected) << table.csv();
  }
}

TEST(CsvReader, ReadsNumbersAndNamesInQuotes) {
  const CsvFile file("# of R\r\n\"time\",\"x\"\r\n\"1.5\", \"-2e3\" \r\n1,\"\"\r\n");
  auto csv = file.reader();
  EXPECT_EQ(csv.column("time"), 0u);
  ASSERT_TRUE(csv.next_row());
  EXPECT_EQ(csv.finite(0), 1.5);
  EXPECT_EQ(csv.finite(1), -2000);
  ASSERT_TRUE(csv.next_row());
  EXPECT_EQ(csv.field(1), "");
}

TEST(CsvReader, ReadsTablesOfOtherPrograms) {
  const Rows expected{{"time", "x"}, {"0.5", "1e3"}};
  for (const auto* text :
      {"time,x\n0.5,1e3\n", "time ; x\r\n0.5;1e3\r\n", "  time   x\n 0.5\t1e3 \n",
          "\"time\" \"x\"\n0.5 1e3\n", "\xef\xbb\xbftime\tx\n0.5\t1e3\n"})
    EXPECT_EQ(CsvFile(text).rows(), expected) << text;
  const CsvFile numbers("a,b,c,d\n1.5D-3,+2,-3d0,+-4\n");
  auto csv = numbers.reader();
  ASSERT_TRUE(csv.next_row());
  EXPECT_EQ(csv.finite(0), 1.5e-3);
  EXPECT_EQ(csv.finite(1), 2);
  EXPECT_EQ(csv.finite(2), -3);
  EXPECT_FALSE(csv.finite(3));
  const auto problem = [](const std::string& text) {
    try {
      const CsvFile file(text);
      auto reader = file.reader();
      reader.needed_column("time");
      reader.throw_problems();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(problem(std::string("\xff\xfet\0i\0", 6)).find("iconv"), std::string::npos);
  EXPECT_NE(
      problem("0.5,1\n").find("the header has numbers, but no column 'time'"), std::string::npos);
  EXPECT_NE(problem("ITEM: TIMESTEP\n0\n").find("edmill import"), std::string::npos);
}

TEST(CsvReader, CountsTheLinesOfTextsInQuotes) {
  const CsvFile file("a,b\n\"1\n2\n3\",4\n5,6\n");
  auto csv = file.reader();
  ASSERT_TRUE(csv.next_row());
  EXPECT_EQ(csv.line(), 2u);
  ASSERT_TRUE(csv.next_row());
  EXPECT_EQ(csv.line(), 5u);
}

TEST(CsvReader, QuotesWithinATextAreItsCharacters) {
  EXPECT_EQ(CsvFile("a,b\n5\" pipe,x \"y\"\n").rows(), (Rows{{"a", "b"}, {"5\" pipe", "x \"y\""}}));
}

TEST(CsvReader, AQuoteThatNothingClosesIsReported) {
  for (const auto* text : {"a,b\n1,\"2\n3,4\n", "\"a,b\n1,2\n"}) {
    const CsvFile file(text);
    try {
      file.rows();
      FAIL() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("a quotation mark is not closed"), std::string::npos)
          << error.what();
    }
  }
}

TEST(CleanText, ReplacesWhatXmlCannotHave) {
  const std::string bad = "\xef\xbf\xbd";
  EXPECT_EQ(clean_text("a\tb\n\xc3\xa4\xe2\x80\xa8\xf0\x9f\x98\x80"),
      "a\tb\n\xc3\xa4\xe2\x80\xa8\xf0\x9f\x98\x80");
  EXPECT_EQ(clean_text(std::string("a\0b\x01\x1f", 5)), "a" + bad + "b" + bad + bad);
  EXPECT_EQ(clean_text("\xff\xc3"), bad + bad);
  EXPECT_EQ(clean_text("\xc0\x80"), bad + bad);                      // overlong
  EXPECT_EQ(clean_text("\xed\xa0\x80"), bad + bad + bad);            // a surrogate
  EXPECT_EQ(clean_text("\xf4\x90\x80\x80"), bad + bad + bad + bad);  // beyond U+10FFFF
  EXPECT_EQ(clean_text("\xef\xbf\xbe"), bad + bad + bad);            // U+FFFE
  EXPECT_EQ(one_line("a\r\nb"), "a  b");
  EXPECT_EQ(one_line("a\xe2\x80\xa8"
                     "b\xc2\x85"
                     "c"),
      "a b c");
}

}  // namespace
}  // namespace edmill::io
