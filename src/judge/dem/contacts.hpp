// Frames of DEM codes, contacts of finite duration between those in which balls fly freely, and
// their logs, which `edmill import` writes and `audit`, `compare` and `limit` read. docs/dem.md
#pragma once

#include <array>
#include <cstdio>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "decks/moving_vessel.hpp"
#include "io/csv_reader.hpp"
#include "io/input_file.hpp"
#include "model/ball.hpp"

namespace edmill::dem {

using decks::BallState, decks::flown, decks::MovingVessel, decks::Vector;

inline double dot(const Vector& a, const Vector& b) { return edmill::dot<double>(a, b); }
inline Vector cross(const Vector& a, const Vector& b) { return edmill::cross<double>(a, b); }
inline double norm(const Vector& a) { return edmill::norm<double>(a); }

/// Facts about a dump that may be missing from the file.
struct DumpFormat {
  std::optional<double> time_step;  ///< [s]; of files without times
  std::string units = "si";  ///< "si", "cgs", "mm", "micro" or "nano"; else those in the file
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

/// Reads frames in bounded memory: a dump of LAMMPS or LIGGGHTS, text or binary, or a table with a
/// column `time` whose rows of one time are a frame. Columns may be in any order, unknown ones are
/// skipped, and an incomplete last frame is dropped.
class FrameReader {
 public:
  /// @param balls  of the case @throws InputError when the file cannot be read
  FrameReader(const std::string& file, const DumpFormat& format, std::size_t balls);

  /// The next frame; false at the end. @throws InputError naming line, found and expected
  bool next(Frame& frame);

  /// Masses [kg] and radii [m] of the first frame, where the file has them.
  const std::vector<double>& masses() const { return masses_; }
  const std::vector<double>& radii() const { return radii_; }
 private:
  struct FrameRow {
    long id = 0;
    model::BallState<double> state;
    std::optional<double> mass, radius, time;
  };

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
  FrameRow row() const;
  FrameRow row_of(const std::vector<double>& values) const;
  double time_of(std::optional<double> time, std::optional<double> step) const;
  void finish(std::vector<FrameRow> rows, double time, Frame& frame);
  double number(const std::string& text, bool is_finite = false) const;

  std::string name_;
  io::InputFile in_;
  DumpFormat format_;
  std::size_t count_;
  bool (FrameReader::*next_)(Frame&) = nullptr;  ///< by the kind of the file
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

/// Kinds of contacts. `wall` and `pair` are single ones, by which laws are measured. In a `missed`
/// one bodies overlap and fly on. In a `jump` a ball moves farther than its velocities allow.
enum class ContactClass { wall, pair, several, lasting, unexplained, missed, jump };
inline constexpr std::array<const char*, 7> contact_class_names{
    "wall", "pair", "several", "lasting", "unexplained", "missed", "jump"};
constexpr const char* name_of(ContactClass kind) {
  return contact_class_names[static_cast<std::size_t>(kind)];
}
constexpr bool is_single(ContactClass kind) {
  return kind == ContactClass::wall || kind == ContactClass::pair;
}
template <class Value> using ByClass = std::array<Value, contact_class_names.size()>;

/// One contact, or a group of bodies whose contacts overlap in time. The states of a single contact
/// are those at the touch and at the detachment, extrapolated from the flights before and after;
/// those of other contacts are taken from the last frame before and the first frame after.
struct Contact {
  ContactClass kind{};
  double begin = 0, end = 0;             ///< [s]
  double free_until = 0, free_from = 0;  ///< the last frame before and the first after it [s]
  int bodies = 1;                        ///< number of balls
  int ball = 0;                          ///< the one with the lowest number
  int partner = -1;  ///< number of the wall or ball; -1 unless there is exactly one
  double dose = 0;   ///< energy lost by all balls, by the energy balance [J]
  BallState before = {}, after = {};
  BallState partner_before = {}, partner_after = {};  ///< of a pair
};

/// Statistics of the first frames, used for all.
struct FrameStatistics {
  double interval = 0;                 ///< median between frames [s]
  Vector gravity{0, 0, 0};             ///< median acceleration of all balls [m/s^2]
  Vector gravity_half_width{0, 0, 0};  ///< of its 95 % interval
  double kick = 0;                     ///< velocity changes below are noise [m/s]
  double contact_time = 0;             ///< median of the time in which a ball does not fly [s]
  double way_factor = 0;  ///< median ratio of displacements to those by velocities; 0 if unknown
};

/// @pre at least three frames
FrameStatistics statistics_of(const std::vector<Frame>& frames, const Vector& expected_gravity);

/// Finds contacts in a stream of frames; its memory grows with the duration of contacts only.
class ContactFinder {
 public:
  using Found = std::function<void(const Contact&)>;

  /// @param found  called with each contact when it is over, in order of the end of its group
  ContactFinder(const MovingVessel& vessel, const FrameStatistics& frames, Found found);

  void add(Frame frame);
  /// Ends the record. Contacts that are open at the last frame are dropped, except lasting ones.
  void finish();
 private:
  /// A stretch in which a ball does not fly, from the last frame before to the first after it.
  struct Stretch {
    std::size_t ball, first, last;  ///< frames, by number
    int group = -1;
    bool open = true;
  };
  using Group = std::vector<Stretch>;
  /// An overlap of a ball with a wall or another ball over consecutive frames.
  struct Overlap {
    double begin = 0;              ///< time of the last frame before [s]
    double last = 0;               ///< depth in the last frame [m]
    double depth = 0, growth = 0;  ///< largest so far [m], [m/s]
    std::array<bool, 2> flies{
        true, true};  ///< whether the ball, or its partner, flew freely throughout
  };
  using BodyPair = std::array<int, 2>;  ///< the ball, and the other one or -1 - wall

  const Frame& frame(std::size_t number) const { return window_[number - first_]; }
  bool resolved() const { return frames_.contact_time >= 3 * frames_.interval; }
  void find_jumps();
  void watch_overlaps(const std::vector<bool>& flies);
  void end_overlap(const BodyPair& bodies, const Overlap& overlap);
  void close(Stretch& stretch);
  bool come_near(const Stretch& one, const Stretch& other) const;
  void settle();
  void report(Group group);
  std::vector<int> walls_met(const Stretch& s) const;
  using States = std::vector<std::pair<double, BallState>>;  ///< of a ball, by time
  double balance(std::size_t frame, std::size_t ball, const States& states) const;
  double dose_of(const Group& group) const;
  double work_of_bodies(const Stretch& s, const std::vector<int>& walls) const;
  bool make_single(const Group& group, int wall, Contact& contact) const;

  const MovingVessel& vessel_;
  FrameStatistics frames_;
  Found found_;
  std::deque<Frame> window_;
  std::size_t first_ = 0;           ///< number of the window's first frame
  std::vector<Stretch> stretches_;  ///< open, or ended while another one of the group is open
  std::vector<int> open_of_;        ///< for each ball: index in stretches_, or -1
  int groups_ = 0;
  std::map<BodyPair, Overlap> overlaps_;
  double largest_radius_ = 0;
  bool at_end_ = false;  ///< of the frames
};

struct ContactLogFacts {
  std::string dump;  ///< file that it was made from
  std::uint64_t frames = 0, contacts = 0;
  double first = 0, last = 0;  ///< times of the frames [s]
  FrameStatistics statistics;
  double mass_factor = 1, radius_factor = 1;  ///< of the dump's balls over the case's; 0 if unknown
  int facets = 0;           ///< of the prism that represents a round wall; 0 for a round wall
  ByClass<double> doses{};  ///< [J]

  /// Visits the fields of a log's header.
  static void fields(auto& self, auto&& field) {
    auto& s = self.statistics;
    field("dump", self.dump);
    field("frames", self.frames);
    field("contacts", self.contacts);
    field("first", self.first);
    field("last", self.last);
    field("interval", s.interval);
    field("gravity", s.gravity);
    field("gravity_half_width", s.gravity_half_width);
    field("contact_time", s.contact_time);
    field("kick", s.kick);
    field("way_factor", s.way_factor);
    field("mass_factor", self.mass_factor);
    field("radius_factor", self.radius_factor);
    field("facets", self.facets);
    field("doses", self.doses);
  }
  double dose() const;
  double duration() const { return last - first; }
};

/// A table of the number of contacts of each class and their share of the dose. @param doses  [J]
std::string class_table(const ByClass<double>& doses, const ByClass<std::uint64_t>& counts);

/// Writes a log. Its rows are in a temporary file until the facts of the header are known.
class ContactLogWriter {
 public:
  ContactLogWriter();
  void add(const Contact& contact);
  void write(std::ostream& out, const ContactLogFacts& facts);
 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> rows_;
};

bool is_contact_log(const std::string& file);

class ContactLogReader {
 public:
  /// @throws InputError when the file is not a contact log
  explicit ContactLogReader(const std::string& file);

  const ContactLogFacts& facts() const { return facts_; }
  /// The next contact; nothing at the end. @throws InputError with the bad lines
  std::optional<Contact> next();
 private:
  std::optional<Contact> parse();

  ContactLogFacts facts_;
  io::CsvReader csv_;
};

}  // namespace edmill::dem
