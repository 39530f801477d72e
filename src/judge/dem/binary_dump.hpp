// Binary dumps of LAMMPS: `dump custom FILE.bin`, revision 2 of its format (since 2021), which names its
// columns.
#pragma once

#include <array>
#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <vector>

namespace edmill::dem {

struct BinaryFrame {
  std::int64_t step = 0;
  std::optional<double> time;             ///< in the units of the dump
  std::string units, columns;             ///< empty where the frame does not say them
  std::array<double, 3> low{}, size{};    ///< of the box
  std::vector<std::vector<double>> rows;  ///< by ball, a value for each column
};

/// Whether a file is one, by its first byte, which begins no text.
bool begins_binary_dump(int first_byte);

/// The next frame; false at the end, or where the file ends within a frame.
/// @param balls  that each frame must have: nothing larger is allocated
/// @throws InputError saying what was found; the caller's `name` begins the message
bool read_binary_frame(std::istream& in, const std::string& name, std::size_t balls, BinaryFrame& frame);

}  // namespace edmill::dem
