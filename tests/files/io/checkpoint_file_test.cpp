// A checkpoint is read as it was written, or refused.
#include "io/checkpoint_file.hpp"

#include <gtest/gtest.h>

#include <random>

#include "base/digest.hpp"
#include "base/errors.hpp"
#include "base/version.hpp"
#include "program.hpp"

namespace edmill::io {
namespace {

class CheckpointFile : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    checkpoint.case_text = "[run]\n";
    checkpoint.overrides = {"run.seed=2", "run.end_time=\"1 s\""};
    checkpoint.precision = "mpfr50";
    checkpoint.right_digits = 12;
    for (int k = 0; k < 3000; ++k) checkpoint.state += static_cast<char>(k * k % 251);
    write_checkpoint(scratch, checkpoint);
    bytes = contents(scratch / "checkpoint");
  }
  std::string refusal(const std::string& changed) {
    write("checkpoint", changed);
    try {
      read_checkpoint(scratch);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  Checkpoint checkpoint;
  std::string bytes;
};

TEST_F(CheckpointFile, IsReadAsItWasWritten) {
  const auto read = read_checkpoint(scratch);
  EXPECT_EQ(read.case_text, checkpoint.case_text);
  EXPECT_EQ(read.overrides, checkpoint.overrides);
  EXPECT_EQ(read.precision, checkpoint.precision);
  EXPECT_EQ(read.right_digits, checkpoint.right_digits);
  EXPECT_EQ(read.state, checkpoint.state);
}

TEST_F(CheckpointFile, IsRefusedWithAnyBitChanged) {
  std::mt19937 random(20110101);
  for (int trial = 0; trial < 2000; ++trial) {
    std::string changed = bytes;
    changed[random() % changed.size()] ^= static_cast<char>(1 << random() % 8);
    EXPECT_NE(refusal(changed), "") << trial;
  }
}

TEST_F(CheckpointFile, IsRefusedWhenItEndsEarlyOrLate) {
  for (std::size_t size = 0; size < bytes.size(); size += 1 + size / 50)
    EXPECT_NE(refusal(bytes.substr(0, size)), "") << size;
  EXPECT_NE(refusal(bytes + '\0'), "");
}

TEST_F(CheckpointFile, OfAnotherCommitIsRefusedByName) {
  const std::string begin = "edmill checkpoint 4\n";
  ASSERT_TRUE(bytes.starts_with(begin));
  Archive archive;
  std::string program = version(), another = "0123456";
  archive(program, another, checkpoint);
  const std::string message = refusal(begin + sha256(archive.bytes()) + "\n" + archive.bytes());
  EXPECT_NE(message.find("0123456"), std::string::npos) << message;
  EXPECT_NE(message.find(commit()), std::string::npos) << message;
}

TEST_F(CheckpointFile, IsRefusedWhereThereIsNone) {
  std::filesystem::remove(scratch / "checkpoint");
  EXPECT_THROW(read_checkpoint(scratch), InputError);
}

}  // namespace
}  // namespace edmill::io
