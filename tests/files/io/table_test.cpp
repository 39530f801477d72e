// Tables as CSV and in HDF5.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core.hpp"
#include "hdf5_table.hpp"
#include "io/table_hdf5.hpp"

namespace edmill::io {
namespace {

using Type = Column::Type;

TEST(Table, TextsAreQuotedOnlyWhereTheyNeedIt) {
  Table<double> table({{"text", Type::text}, {"x", Type::number}});
  for (const auto* text : {"plain", "a,b", "say \"no\""}) table.put(text, std::optional<double>());
  EXPECT_EQ(table.csv(), "text,x\nplain,\n\"a,b\",\n\"say \"\"no\"\"\",\n");
}

TEST(Table, TitlesHaveUnitsAndCommentsComeFirst) {
  Table<double> table(
      {{"dose, all", Type::number, "J"}, {"n", Type::integer}}, {"from here", "to there"});
  table.put(0.1, 3);
  EXPECT_EQ(table.csv(), "# from here\n# to there\n\"dose, all [J]\",n\n0.1,3\n");
}

TEST(Table, NumbersHaveAllDigitsOfTheirScalar) {
  Table<mpfr> table({{"third", Type::number}});
  const mpfr third = mpfr(1) / 3;
  table.put(third);
  EXPECT_EQ(table.csv_rows(), to_text<mpfr>(third) + "\n");
}

TEST(Table, ARowIsFilledFromLeftToRight) {
  Table<double> table({{"a", Type::number}, {"b", Type::integer}, {"c", Type::text}});
  table.put(1.5);
  EXPECT_FALSE(table.at_row_end());
  table.put(2, "x");
  EXPECT_TRUE(table.at_row_end());
  EXPECT_EQ(table.csv_rows(), "1.5,2,x\n");
  EXPECT_THROW(table.put("a text"), std::bad_variant_access);
}

TEST(Table, RowsGoOnWhereTheyWereArchived) {
  const std::vector<Column> columns{{"a", Type::number}, {"b", Type::integer}, {"c", Type::text}};
  Table<double> table(columns), loaded(columns);
  table.put(1.5, 2, "x", std::optional<double>());
  Archive saving;
  saving(table);
  Archive loading(saving.bytes());
  loading(loaded);
  loading.finish();
  for (auto* t : {&table, &loaded}) t->put(7, "y");
  EXPECT_EQ(loaded.csv(), table.csv());
  EXPECT_EQ(loaded.csv(), "a,b,c\n1.5,2,x\n,7,y\n");
}

class TableInHdf5 : public ::testing::Test {
 protected:
  template <class Real> void store(const Table<Real>& table) {
    std::ofstream(place_, std::ios::binary) << hdf5_columns(table, {});
    file_.emplace(H5Fopen(place_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  }
  void TearDown() override {
    file_.reset();
    std::filesystem::remove(place_);
  }
  H5T_class_t type_of(const char* name) const {
    const Handle set(H5Dopen2(*file_, name, H5P_DEFAULT), H5Dclose),
        type(H5Dget_type(set), H5Tclose);
    return H5Tget_class(type);
  }
  std::filesystem::path place_ = std::filesystem::temp_directory_path() /
      ("edmill-table-" + std::to_string(::getpid()) + ".h5");
  std::optional<Handle> file_;
};

TEST_F(TableInHdf5, ColumnsHaveTheTypeOfTheirCells) {
  Table<mpfr> table({{"text", Type::text}, {"flag", Type::text}, {"count", Type::integer},
      {"whole", Type::number}, {"nearly", Type::number}, {"gap", Type::number}});
  const mpfr little("1e-40");
  table.put("below", "1", 3, mpfr(4), mpfr(4 + little), mpfr(5));
  table.put("2", "0", 4, mpfr(-5), mpfr(6), std::optional<mpfr>());
  store(table);
  EXPECT_EQ(type_of("text"), H5T_STRING);
  EXPECT_EQ(type_of("flag"), H5T_INTEGER);
  EXPECT_EQ(type_of("count"), H5T_INTEGER);
  EXPECT_EQ(type_of("whole"), H5T_INTEGER);
  EXPECT_EQ(type_of("nearly"), H5T_FLOAT);
  EXPECT_EQ(type_of("gap"), H5T_FLOAT);
  EXPECT_EQ(dataset(*file_, "whole"), (std::vector<double>{4, -5}));
  EXPECT_EQ(dataset(*file_, "nearly"), (std::vector<double>{4, 6}));
  EXPECT_TRUE(std::isnan(dataset(*file_, "gap").at(1)));
}

TEST_F(TableInHdf5, NamesOfDatasetsDiffer) {
  Table<double> table({{"a/b", Type::integer}, {"a_b", Type::integer}});
  table.put(1, 2);
  store(table);
  EXPECT_EQ(dataset(*file_, "a_b"), std::vector<double>{1});
  EXPECT_EQ(dataset(*file_, "a_b 2"), std::vector<double>{2});
}

}  // namespace
}  // namespace edmill::io
