// SHA-256 (FIPS 180-4) in hexadecimal, of a whole text or of bytes added piece by piece.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace edmill {

std::string sha256(std::string_view text);

class Sha256 {
 public:
  Sha256();
  void add(std::string_view bytes);
  /// Digest of the bytes so far; more can follow.
  std::string hex() const;
 private:
  static constexpr std::size_t block_size = 64;

  void take_block(const unsigned char* block);

  std::array<std::uint32_t, 8> state_;
  std::array<unsigned char, block_size> waiting_{};  ///< a block that is not full yet
  std::uint64_t size_ = 0;                           ///< of all bytes
};

}  // namespace edmill
