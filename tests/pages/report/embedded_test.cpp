// Files that are part of the program.
#include "report/embedded.hpp"

#include <gtest/gtest.h>

#include "program.hpp"

namespace {

using Embedded = edmill::ProgramTest;

TEST_F(Embedded, FilesAreThereByteForByte) {
  using namespace edmill::report;
  const std::filesystem::path sources = EDMILL_SOURCE_DIR;
  EXPECT_EQ(page_css, contents(sources / "src/pages/report/page.css"));
  EXPECT_EQ(page_html, contents(sources / "src/pages/report/page.html"));
  EXPECT_EQ(terms_toml, contents(sources / "src/pages/report/terms.toml"));
  EXPECT_EQ(page_js, contents(sources / "src/pages/report/page.js"));
  EXPECT_EQ(mill_view_js, contents(sources / "src/pages/report/mill_view.js"));
}

}  // namespace
