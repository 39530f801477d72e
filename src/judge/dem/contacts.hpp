// Contacts that last: what happened to balls between frames in which they fly, and logs of them, which
// `edmill import` writes and `audit`, `compare` and `limit` read. docs/dem.md
#pragma once

#include <array>
#include <cstdio>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "dem/frame_reader.hpp"
#include "dem/moving_vessel.hpp"
#include "io/csv_reader.hpp"

namespace edmill::dem {

/// Kinds of contacts. `wall` and `pair` are single ones, from which laws can be measured; in a `missed` one,
/// which the code did not compute, bodies overlap and one of them flies on; in a `jump` a ball moves to where
/// its velocities do not lead it.
enum class ContactClass { wall, pair, several, lasting, unexplained, missed, jump };
inline constexpr std::array<const char*, 7> contact_class_names{"wall",        "pair",   "several", "lasting",
                                                                "unexplained", "missed", "jump"};
template <class Value>
using ByClass = std::array<Value, contact_class_names.size()>;

/// One contact, or a group of bodies whose contacts overlap in time. Of a single one the states are those at
/// the touch and at the detachment, by the flights before and after; of others those of the frames around it.
struct Contact {
  ContactClass kind{};
  double begin = 0, end = 0;             ///< [s]
  double free_until = 0, free_from = 0;  ///< times of the last frame before and the first after it [s]
  int bodies = 1;                        ///< balls in it
  int ball = 0;                          ///< the lowest
  int partner = -1;                      ///< wall or ball; -1 where there is no single one
  double dose = 0;                       ///< energy lost by all balls, by the balance [J]
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
  double way_factor = 0;               ///< median of displacements over those by the velocities; 0 unknown
};

/// @pre at least three frames
FrameStatistics statistics_of(const std::vector<Frame>& frames, const Vector& expected_gravity);

/// Finds contacts in a stream of frames; memory is bounded by how long contacts last.
class ContactFinder {
 public:
  using Found = std::function<void(const Contact&)>;

  /// @param found  gets each contact when it is over, in order of the end of its group
  ContactFinder(const MovingVessel& vessel, const FrameStatistics& frames, Found found);

  void add(Frame frame);
  /// Contacts that have not ended by the last frame are none of the record, unless they last.
  void finish();

 private:
  /// A stretch in which a ball does not fly, from the last frame before to the first after it.
  struct Stretch {
    std::size_t ball, first, last;  ///< frames, by number
    int group = -1;
    bool open = true;
  };
  /// A ball overlaps a wall or another ball, from frame to frame.
  struct Overlap {
    double begin = 0;                       ///< of the last frame before [s]
    double last = 0;                        ///< depth in the last frame [m]
    double depth = 0, growth = 0;           ///< largest so far [m], [m/s]
    std::array<bool, 2> flies{true, true};  ///< the ball, or its partner, all the while
  };
  using BodyPair = std::array<int, 2>;  ///< the ball, and the other one or -1 - wall

  const Frame& frame(std::size_t number) const { return window_[number - first_]; }
  /// Whether a usual contact has frames within it.
  bool resolved() const { return frames_.contact_time >= 3 * frames_.interval; }
  void find_jumps();
  void watch_overlaps(const std::vector<bool>& flies);
  void end_overlap(const BodyPair& bodies, const Overlap& overlap);
  void close(Stretch& stretch);
  bool come_near(const Stretch& one, const Stretch& other) const;
  void settle();
  void report(std::vector<Stretch> group);
  std::vector<int> walls_met(const Stretch& s) const;
  using States = std::vector<std::pair<double, BallState>>;  ///< of a ball, by time
  double balance(std::size_t ball, const States& states) const;
  bool make_single(const std::vector<Stretch>& group, int wall, Contact& contact) const;
  void forget();

  const MovingVessel& vessel_;
  FrameStatistics frames_;
  Found found_;
  std::deque<Frame> window_;
  std::size_t first_ = 0;           ///< number of the window's first frame
  std::vector<Stretch> stretches_;  ///< open, or ended in a group that is open
  std::vector<int> open_of_;        ///< by ball: place in stretches_, or -1
  int groups_ = 0;
  std::map<BodyPair, Overlap> overlaps_;
  double largest_radius_ = 0;
  bool at_end_ = false;  ///< of the frames
};

/// Facts about a whole log.
struct ContactLogFacts {
  std::string dump;  ///< that it was made from
  std::uint64_t frames = 0, contacts = 0;
  double first = 0, last = 0;  ///< times of the frames [s]
  FrameStatistics statistics;
  double mass_factor = 1,
         radius_factor = 1;  ///< of the dump's balls over the case's; 0 where it does not have them
  int facets = 0;            ///< of the prism that represents a round wall; 0 for a round wall
  ByClass<double> doses{};   ///< [J]

  /// The head of a log.
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

/// Number of contacts of each class, and their share of the dose. @param doses  [J]
std::string class_table(const ByClass<double>& doses, const ByClass<std::uint64_t>& counts);

/// Collects rows on disk until the facts are known.
class ContactLogWriter {
 public:
  ContactLogWriter();
  void add(const Contact& contact);
  void write(std::ostream& out, const ContactLogFacts& facts);

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> rows_;
};

/// Whether a file is such a log, by its first line.
bool is_contact_log(const std::string& file);

class ContactLogReader {
 public:
  /// @throws InputError when it is none
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
