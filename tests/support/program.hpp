// The program as a user starts it, in a folder of its own.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace edmill {

struct Outcome {
  int code;
  std::string out, err;
};

class ProgramTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string place = (std::filesystem::temp_directory_path() / "edmill-test-XXXXXX").string();
    ASSERT_NE(::mkdtemp(place.data()), nullptr);
    scratch = place;
  }
  void TearDown() override { std::filesystem::remove_all(scratch); }

  static std::string contents(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(scratch / name, std::ios::binary) << text;
  }
  /// @param before  goes in front of the program, e.g. "mpirun -n 2"
  Outcome edmill(const std::string& arguments, const std::string& before = "") const {
    const std::string command = "cd '" + scratch.string() + "' && " + before +
        " '" EDMILL_BINARY "' " + arguments + " >stdout 2>stderr </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(scratch / "stdout"),
        contents(scratch / "stderr")};
  }

  std::filesystem::path scratch;
};

}  // namespace edmill
