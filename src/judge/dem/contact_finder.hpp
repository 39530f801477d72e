// From frames to contacts that last: what happened to balls between frames in which they fly.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "dem/frame_reader.hpp"
#include "dem/moving_vessel.hpp"

namespace edmill::dem {

/// What a contact is. `wall` and `pair` are single ones, which laws can be asked of.
enum class ContactClass { wall, pair, several, lasting, unexplained };
inline constexpr std::array<const char*, 5> contact_class_names{"wall", "pair", "several", "lasting",
                                                                "unexplained"};

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
  BallState before, after;
  BallState partner_before, partner_after;  ///< of a pair
};

/// What the first frames tell, for the rest.
struct FrameStatistics {
  double interval = 0;                 ///< median between frames [s]
  Vector gravity{0, 0, 0};             ///< median acceleration of all balls [m/s^2]
  Vector gravity_half_width{0, 0, 0};  ///< of its 95 % interval
  double kick = 0;                     ///< velocity changes below are noise [m/s]
  double contact_time = 0;             ///< median of the time in which a ball does not fly [s]
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
  /// Contacts that have not ended by the last frame are none of the record.
  void finish();

 private:
  /// A stretch in which a ball does not fly, from the last frame before to the first after it.
  struct Stretch {
    std::size_t ball, first, last;  ///< frames, by number
    int group = -1;
    bool open = true;
  };
  struct Touch {
    int wall;
    int spells;
  };

  const Frame& frame(std::size_t number) const { return window_[number - first_]; }
  /// Whether a usual contact has frames within it.
  bool resolved() const { return frames_.contact_time >= 3 * frames_.interval; }
  void close(std::size_t stretch);
  bool come_near(const Stretch& one, const Stretch& other) const;
  void settle();
  void report(std::vector<Stretch> group);
  std::vector<Touch> touches_of(const Stretch& s) const;
  double balance(const Stretch& s) const;
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
};

}  // namespace edmill::dem
