// A run with a report, and what its page says.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <pugixml.hpp>
#include <sstream>
#include <string>

#include "program.hpp"

namespace edmill::testing {

class Report : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    folder = scratch / "run";
  }
  /// The demo for 1.5 s.
  void run(const std::string& options) {
    const auto done = edmill("run " + std::string(EDMILL_SOURCE_DIR "/docs/examples/demo.toml") +
        " --quiet --set 'run.end_time=1.5 s' --out " + folder.string() + " " + options);
    ASSERT_EQ(done.code, 0) << done.err;
  }
  std::string page() const { return contents(folder / "report.html"); }
  /// <main> of the page, which is XML.
  pugi::xml_document body() const {
    const std::string all = page();
    const auto begin = all.find("<main>"), end = all.find("</main>");
    pugi::xml_document document;
    EXPECT_TRUE(document.load_string(all.substr(begin, end + 7 - begin).c_str()));
    return document;
  }
  std::filesystem::path folder;
};

}  // namespace edmill::testing
