// The settings of an entry [[output]]. docs/outputs.md
#pragma once

#include <any>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "casefile/quantity.hpp"
#include "model/parts/parameter.hpp"

namespace edmill::casefile {

using model::Parameter;
using model::Range;

/// A key without a dimension whose values and default are described to readers.
constexpr Parameter described_key(
    const char* key, const char* kind, const char* otherwise, const char* meaning) {
  return Parameter{key, meaning}.as(kind).usually(otherwise);
}

/// A colour in pictures: red, green and blue from 0 to 1. (thesis D.3.3)
using Colour = std::array<double, 3>;

/// When an output records. (thesis D.3.2) Of two starts, or of two ends, the earlier one counts.
struct TimerSpec {
  bool on = true;
  std::optional<Quantity> start_time, end_time, duration;
  std::optional<std::uint64_t> start_collision;  ///< index of an impact, from 0
  std::optional<std::uint64_t> collisions;       ///< how many impacts it lasts
  std::optional<Quantity> interval;
  std::optional<std::uint64_t> max_rows;

  /// The keys of every output; some types have an interval as well.
  static void keys(auto& t, auto&& row) {
    using enum Dimension;
    row({"on", "false leaves the table empty", Range::any, "true"}, t.on);
    row({"start_time", time,
            "the record begins at this time or at `start_collision`, whichever is earlier",
            Range::not_negative, nullptr, "the start of the run"},
        t.start_time);
    row({"start_collision", "index of the impact, from 0, at which the record begins", Range::any,
            nullptr, "none"},
        t.start_collision);
    row({"end_time", time,
            "the record ends at this time, after `duration` or after `collisions`, whichever is "
            "earliest",
            Range::not_negative, nullptr, "the end of the run"},
        t.end_time);
    row({"duration", time, "duration of the record", Range::positive}, t.duration);
    row({"collisions", "number of impacts in the record, including those that `only` excludes",
            Range::count, nullptr, "none"},
        t.collisions);
  }
};

class Section;

/// A table whose keys the user chooses, described by `T::entry`: `T::read(section, name)` reads
/// one.
template <class T> struct Named : std::vector<T> {
  static constexpr const char* what = T::what;
  static void keys(auto& names, auto&& row) { row(T::entry, static_cast<std::vector<T>&>(names)); }
};

/// A value as text, in the form that `--set` accepts.
struct AnyValue {
  std::optional<std::string> text;
  void read_from(Section& section, const char* key);
};

/// Restricts an output to impacts for which a flag or a count has this value.
struct Restriction {
  int variable;  ///< place in model::impact_variables
  std::uint64_t value;

  static constexpr const char* what = "`only = { ball_ball = false, partner = 1 }`";
  static constexpr Parameter entry =
      Parameter{"*", "the key is a flag or a count"}.as("true, false or count").usually("");
  static std::optional<Restriction> read(Section& section, const std::string& variable);
};

enum class Statistic { sum, average, minimum, maximum, rate, percentage };
/// In the order of the enumerators.
inline constexpr std::array<std::string_view, 6> statistic_names{
    "sum", "average", "minimum", "maximum", "rate", "percentage"};
inline std::string statistic_name(Statistic s) {
  return std::string(statistic_names[static_cast<std::size_t>(s)]);
}

/// A variable that an output shows.
struct ColumnSpec {
  int variable = 0;  ///< place in model::impact_variables, or of trends_balls in ball_variables
  std::vector<Statistic> statistics;
  std::string label;                  ///< in place of the variable's name
  std::string true_text, false_text;  ///< for flags
  bool with_ball = false;  ///< trends_balls: also show which ball has the minimum or maximum
};

struct FrequencySpec {
  std::string name;  ///< of the variable
  ColumnSpec variable;
  Quantity low, high;
  std::uint64_t intervals = 10;
  std::string title;
  bool wall_details = false, percentages = false, out_of_range = false;
};

/// A sphere that marks the contact point in pictures.
struct ContactPointSpec {
  Quantity radius{1, 1000};
  Colour colour{1, 1, 0};

  static constexpr const char* what = "A table.";
  static void keys(auto& c, auto&& row) {
    row({"radius", Dimension::length, "radius of the sphere that marks the point", Range::positive,
            "1 mm"},
        c.radius);
    row({"colour", "colour of the sphere that marks the point", Range::any, nullptr, "yellow"},
        c.colour);
  }
};

/// The settings of an animation. (thesis D.4.2)
struct AnimationSpec {
  Quantity speed{1, 1000};               ///< of playback; 1 is real time
  std::uint64_t frames_per_minute = 60;  ///< of playback
  std::uint64_t min_frames = 8;

  static void keys(auto& a, auto&& row) {
    row({"speed", "speed of playback; 1 is real time", Range::positive, "0.001"}, a.speed);
    row({"frames_per_minute", "frames per minute of playback", Range::count, "60"},
        a.frames_per_minute);
    row({"min_frames", "smallest number of frames of the whole animation", Range::count, "8"},
        a.min_frames);
  }
};

/// Settings of every entry, settings that several types share, and those of a single type.
struct OutputSpec {
  std::string type;
  std::string file;
  std::string folder;  ///< inside the run's folder; empty for that itself
  bool append = false;
  bool table = true;  ///< whether it is a table, which can be appended to another
  TimerSpec timer;
  Named<Restriction> only;
  std::vector<ColumnSpec> columns;
  FrequencySpec frequency;
  bool accumulated = false;  ///< trends: since the start instead of for each interval
  std::optional<ContactPointSpec> contact_point;  ///< pictures
  AnimationSpec animation;
  std::any own;  ///< keys that only this type of output has, set by its reader

  static constexpr const char* what = "Tables and pictures that the run writes.";
  /// The keys of every type.
  static void keys(auto& o, auto&& row) {
    row(described_key(
            "type", "name", "required", "type of table or picture: see the types of outputs above"),
        o.type);
    TimerSpec::keys(o.timer, row);
    row(Parameter{"file",
            "name of the file, without folders; a table whose name ends in `.h5` is written as "
            "HDF5"}
            .usually("type and extension"),
        o.file);
    row(Parameter{"folder", "folder inside the run's folder; created if absent"}.usually(
            "the run's folder"),
        o.folder);
    if (o.table)
      row({"append",
              "for CSV: keep the contents of the file and add to them; outputs that all append can "
              "share a file",
              Range::any, "false"},
          o.append);
    row(Parameter{"only", "only impacts with these values of flags and counts"}.usually(
            "all impacts"),
        o.only);
  }

  /// The keys of this type; they are created if there are none yet.
  template <class Keys> Keys& make_own() {
    if (!own.has_value()) own = Keys{};
    return std::any_cast<Keys&>(own);
  }
  /// @pre the reader of this type left keys of this kind
  template <class Keys> const Keys& own_keys() const { return std::any_cast<const Keys&>(own); }
  /// Whether a table is to be written as HDF5.
  bool hdf5() const { return file.ends_with(".h5"); }
};

}  // namespace edmill::casefile
