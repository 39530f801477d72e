#include "base/digest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace edmill {

namespace {

/// The largest r with (r / 2^32)^power <= n, without its whole part.
template <int power>
constexpr std::uint32_t root(std::uint64_t n) {
  unsigned __int128 low = 0, high = static_cast<unsigned __int128>(1) << 37;
  const auto is_below = [n](unsigned __int128 r) {
    if constexpr (power == 2) return r * r <= static_cast<unsigned __int128>(n) << 64;
    return r * r * r <= static_cast<unsigned __int128>(n) << 96;  // r^3 has at most 111 bits
  };
  while (high - low > 1) {
    const auto middle = (low + high) / 2;
    (is_below(middle) ? low : high) = middle;
  }
  return static_cast<std::uint32_t>(low);
}

/// The first 32 bits after the point of the roots of the first primes: square roots of 8, cube roots of 64.
struct Constants {
  std::array<std::uint32_t, 8> begin{};
  std::array<std::uint32_t, 64> rounds{};

  constexpr Constants() {
    std::size_t count = 0;
    for (std::uint64_t n = 2; count < rounds.size(); ++n) {
      bool prime = true;
      for (std::uint64_t d = 2; d * d <= n; ++d) prime = prime && n % d != 0;
      if (!prime) continue;
      if (count < begin.size()) begin[count] = root<2>(n);
      rounds[count++] = root<3>(n);
    }
  }
};
constexpr Constants constants;

}  // namespace

Sha256::Sha256() : state_(constants.begin) {}

void Sha256::take_block(const unsigned char* block) {
  std::array<std::uint32_t, 64> w;
  for (std::size_t k = 0; k < 16; ++k) {
    const unsigned char* word = block + 4 * k;
    w[k] =
        std::uint32_t{word[0]} << 24 | std::uint32_t{word[1]} << 16 | std::uint32_t{word[2]} << 8 | word[3];
  }
  for (std::size_t k = 16; k < 64; ++k) {
    const std::uint32_t first = std::rotr(w[k - 15], 7) ^ std::rotr(w[k - 15], 18) ^ w[k - 15] >> 3;
    const std::uint32_t second = std::rotr(w[k - 2], 17) ^ std::rotr(w[k - 2], 19) ^ w[k - 2] >> 10;
    w[k] = w[k - 16] + first + w[k - 7] + second;
  }
  auto [a, b, c, d, e, f, g, h] = state_;
  for (std::size_t k = 0; k < 64; ++k) {
    const std::uint32_t first = h + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) +
                                ((e & f) ^ (~e & g)) + constants.rounds[k] + w[k];
    const std::uint32_t second =
        (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
    h = g;
    g = f;
    f = e;
    e = d + first;
    d = c;
    c = b;
    b = a;
    a = first + second;
  }
  const std::array<std::uint32_t, 8> change{a, b, c, d, e, f, g, h};
  for (std::size_t k = 0; k < 8; ++k) state_[k] += change[k];
}

void Sha256::add(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t used = size_ % block_size;
    const std::size_t count = std::min(block_size - used, bytes.size());
    std::memcpy(&waiting_[used], bytes.data(), count);
    size_ += count;
    bytes.remove_prefix(count);
    if (size_ % block_size == 0) take_block(waiting_.data());
  }
}

std::string Sha256::hex() const {
  Sha256 end = *this;
  // A bit, zeros up to a whole block, and in its last 8 bytes the number of bits.
  std::string padding(1, '\x80');
  padding.append((2 * block_size - 9 - size_ % block_size) % block_size, '\0');
  for (int shift = 56; shift >= 0; shift -= 8) padding += static_cast<char>(8 * size_ >> shift & 0xff);
  end.add(padding);
  std::string hex;
  for (const auto word : end.state_) hex += fmt::format("{:08x}", word);
  return hex;
}

std::string sha256(std::string_view text) {
  Sha256 digest;
  digest.add(text);
  return digest.hex();
}

}  // namespace edmill
