// Frames of DEM codes: the `dump custom` of LAMMPS and LIGGGHTS, or a table.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "io/input_file.hpp"
#include "model/ball.hpp"

namespace edmill::dem {

using Vector = Vec3<double>;

inline double dot(const Vector& a, const Vector& b) { return edmill::dot<double>(a, b); }
inline Vector cross(const Vector& a, const Vector& b) { return edmill::cross<double>(a, b); }
inline double norm(const Vector& a) { return edmill::norm<double>(a); }

/// Facts about a dump that may be missing from the file.
struct DumpFormat {
  std::optional<double> time_step;  ///< [s]; of files without times
  std::string units = "si";         ///< "si", "cgs", "mm", "micro" or "nano"; else those in the file
};

/// Facts in a deck: its lines `timestep`, `units`, `# frame vessel` and `# facets`.
struct DeckFacts {
  std::optional<double> time_step;
  std::string no_time_step;  ///< why the time step is unknown; empty if it is known
  std::optional<std::string> units;
  bool in_vessel = false;
  int facets = 0;  ///< of the prism that represents a round wall
};
/// @throws InputError when it cannot be read
DeckFacts facts_of_deck(const std::string& deck);

/// All balls at one time, by ascending number.
struct Frame {
  double time = 0;  ///< [s]
  std::vector<model::BallState<double>> balls;
};

/// Reads frames in bounded memory: a dump of LAMMPS or LIGGGHTS, text or binary, or a table with a column
/// `time` whose rows of one time are a frame. Columns may be in any order, unknown ones are skipped, and an
/// incomplete last frame is dropped.
class FrameReader {
 public:
  /// @param balls  of the case
  /// @throws InputError when the file cannot be read
  FrameReader(const std::string& file, const DumpFormat& format, std::size_t balls);

  /// The next frame; false at the end.
  /// @throws InputError naming line, found and expected
  bool next(Frame& frame);

  /// Masses [kg] and radii [m] of the first frame, where the file has them.
  const std::vector<double>& masses() const { return masses_; }
  const std::vector<double>& radii() const { return radii_; }

 private:
  enum class FileKind { unknown, dump, binary, table };
  struct FrameRow {
    long id = 0;
    model::BallState<double> state;
    std::optional<double> mass, radius, time;
  };

  /// Units of a dump, in SI.
  struct Units {
    std::string_view name;
    double length, time, mass;
  };

  bool next_of_dump(Frame& frame);
  bool next_of_binary(Frame& frame);
  bool next_of_table(Frame& frame);
  bool line();
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const;
  void set_columns(const std::vector<std::string>& columns);
  void read_bounds(std::size_t axis);
  FrameRow row() const;
  FrameRow row_of(const std::vector<double>& values) const;
  double time_of(std::optional<double> time, std::optional<double> step) const;
  void finish(std::vector<FrameRow> rows, double time, Frame& frame);
  double number(const std::string& text) const;  ///< may be nan or infinite
  double finite(const std::string& text) const;

  std::string name_;
  io::InputFile in_;
  DumpFormat format_;
  std::size_t count_;
  FileKind kind_ = FileKind::unknown;
  std::string line_;
  std::uint64_t line_number_ = 0;
  std::vector<std::string> names_;        ///< of the columns
  std::vector<int> places_;               ///< index of each known column among them; -1 if absent
  std::array<double, 3> low_{}, size_{};  ///< of the box, for scaled and wrapped coordinates
  bool is_tilted_ = false;
  Units units_{"si", 1, 1, 1};
  std::vector<long> ids_;
  std::vector<double> masses_, radii_;
  std::optional<FrameRow> waiting_;  ///< first row of the next frame of a table
  double last_time_;
};

}  // namespace edmill::dem
