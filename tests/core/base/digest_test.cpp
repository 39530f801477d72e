#include "base/digest.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <random>

#include "program.hpp"

namespace edmill {
namespace {

/// FIPS 180-4's own examples, and those of NIST for long messages.
TEST(Digest, IsThatOfThePublishedExamples) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
      "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1000000, 'a')),
      "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

class DigestOf : public ProgramTest {};

TEST_F(DigestOf, AnyBytesInAnyPiecesIsThatOfSha256sum) {
  constexpr unsigned seed = 20261126;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (int trial = 0; trial < 40; ++trial) {
    const std::size_t size = trial < 20 ? 50 + static_cast<std::size_t>(trial) : random() % 5000;
    std::string bytes;
    for (std::size_t k = 0; k < size; ++k) bytes += static_cast<char>(random());
    const auto place = scratch / "bytes";
    std::ofstream(place, std::ios::binary) << bytes;
    Sha256 digest;
    for (std::size_t at = 0; at < size;) {
      const std::size_t piece = random() % 150;
      digest.add(std::string_view(bytes).substr(at, piece));
      digest.hex();  // changes nothing
      at += piece;
    }
    std::unique_ptr<FILE, int (*)(FILE*)> other(
        popen(("sha256sum < " + place.string()).c_str(), "r"), pclose);
    char text[65] = {};
    ASSERT_EQ(std::fread(text, 1, 64, other.get()), 64u);
    EXPECT_EQ(digest.hex(), text) << size << " bytes";
  }
}

}  // namespace
}  // namespace edmill
