#include "dem/binary_dump.hpp"

#include <fmt/format.h>

#include <cstring>

#include "base/errors.hpp"

namespace edmill::dem {

namespace {

constexpr int most_columns = 1000;
constexpr int longest_text = 100'000;  // of the names of the columns
constexpr const char* magic = "DUMPCUSTOM";

/// Thrown where the file ends.
struct EndOfFile {};

/// Numbers as the writer's machine had them: LAMMPS writes them as they are.
class Bytes {
 public:
  Bytes(std::istream& in, const std::string& name) : in_(in), name_(name) {}

  template <class T>
  T take() {
    T value;
    read(reinterpret_cast<char*>(&value), sizeof value);
    return value;
  }
  std::string text(int length) {
    if (length < 0 || length > longest_text) fail(fmt::format("a text of {} bytes", length), "a short one");
    std::string value(static_cast<std::size_t>(length), ' ');
    read(value.data(), value.size());
    return value;
  }
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw InputError(fmt::format("{}: binary dump: found {}, expected {}", name_, found, expected));
  }

 private:
  void read(char* to, std::size_t bytes) {
    if (!in_.read(to, static_cast<std::streamsize>(bytes))) throw EndOfFile();
  }

  std::istream& in_;
  const std::string& name_;
};

/// A format without names of columns begins with the step, which is not negative.
void read_format(Bytes& in) {
  const auto length = in.take<std::int64_t>();
  if (length >= 0 || in.text(static_cast<int>(-std::max<std::int64_t>(length, -longest_text))) != magic)
    in.fail("the format of LAMMPS before 2021, which does not name its columns, or another file",
            "a dump custom of a later LAMMPS, or the text that its binary2txt makes");
  if (const auto one = in.take<std::int32_t>(); one != 1)
    in.fail("numbers of a machine with the other order of bytes", "those of this one");
  if (const auto revision = in.take<std::int32_t>(); revision != 2)
    in.fail(fmt::format("revision {}", revision), "2");
}

void read_box(Bytes& in, BinaryFrame& frame) {
  const auto triclinic = in.take<std::int32_t>();
  for (int k = 0; k < 6; ++k) in.take<std::int32_t>();  // kinds of boundaries
  for (std::size_t axis = 0; axis < 3; ++axis) {
    frame.low[axis] = in.take<double>();
    frame.size[axis] = in.take<double>() - frame.low[axis];
  }
  if (triclinic != 0) in.fail("a box whose edges are not at right angles", "another");
}

void read_rows(Bytes& in, std::size_t balls, std::size_t columns, BinaryFrame& frame) {
  std::vector<double> values;
  const auto chunks = in.take<std::int32_t>();
  for (std::int32_t chunk = 0; chunk < chunks; ++chunk) {
    const auto count = in.take<std::int32_t>();
    if (count < 0 || static_cast<std::size_t>(count) > balls * columns - values.size())
      in.fail(fmt::format("a part of {} values", count), fmt::format("at most {}", balls * columns));
    for (std::int32_t k = 0; k < count; ++k) values.push_back(in.take<double>());
  }
  if (values.size() != balls * columns)
    in.fail(fmt::format("{} values", values.size()), fmt::format("{}", balls * columns));
  frame.rows.clear();
  for (std::size_t ball = 0; ball < balls; ++ball) {
    const auto row = values.begin() + static_cast<std::ptrdiff_t>(ball * columns);
    frame.rows.emplace_back(row, row + static_cast<std::ptrdiff_t>(columns));
  }
}

void read_frame(Bytes& in, std::size_t balls, BinaryFrame& frame) {
  read_format(in);
  frame.step = in.take<std::int64_t>();
  if (const auto count = in.take<std::int64_t>(); count < 0 || static_cast<std::size_t>(count) != balls)
    in.fail(fmt::format("{} balls", count), fmt::format("{}, as in the case", balls));
  read_box(in, frame);
  const auto columns = in.take<std::int32_t>();
  if (columns < 1 || columns > most_columns)
    in.fail(fmt::format("{} columns", columns), fmt::format("1 to {}", most_columns));
  frame.units = in.text(in.take<std::int32_t>());
  frame.time.reset();
  if (in.take<char>() != 0) frame.time = in.take<double>();
  frame.columns = in.text(in.take<std::int32_t>());
  read_rows(in, balls, static_cast<std::size_t>(columns), frame);
}

}  // namespace

bool begins_binary_dump(int first_byte) {
  // The length of the format's name, negated; or a step, whose lowest byte is most often 0.
  return first_byte == 0 || first_byte == 256 - static_cast<int>(std::strlen(magic));
}

bool read_binary_frame(std::istream& in, const std::string& name, std::size_t balls, BinaryFrame& frame) {
  Bytes bytes(in, name);
  try {
    read_frame(bytes, balls, frame);
  } catch (const EndOfFile&) {
    return false;
  }
  return true;
}

}  // namespace edmill::dem
