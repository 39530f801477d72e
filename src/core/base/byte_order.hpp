// Numbers as bytes in one order on every machine: the least significant byte first.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace edmill {

/// A number whose bytes are in the order of files, and back. Nothing changes on most machines.
template <class T>
T in_file_order(T value) {
  if constexpr (std::endian::native == std::endian::big) {
    std::array<unsigned char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof(T));
    std::reverse(bytes.begin(), bytes.end());
    std::memcpy(&value, bytes.data(), sizeof(T));
  }
  return value;
}

}  // namespace edmill
