// The plain reference implementation: the textbook event-driven loop for elastic smooth spheres in
// a periodic box. Cells, a heap, one event for each ball, and nothing else. Units as in
// periodic_gas.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace edmill::performance {

/// A binary heap of one event time for each ball, which knows where each ball's entry is.
class EventHeap {
 public:
  /// @param balls  all of them at time 0
  explicit EventHeap(int balls);
  int top() const { return entries_[0].ball; }
  double top_time() const { return entries_[0].time; }
  void set(int ball, double time);
  /// Takes `span` from every time.
  void shift(double span);
 private:
  struct Entry {
    double time;
    int ball;
  };
  void put(int place, const Entry& entry);

  std::vector<Entry> entries_;
  std::vector<int> place_;  ///< of each ball in `entries_`
};

class MinimalLoop {
 public:
  /// Starts from PeriodicGas, which see.
  MinimalLoop(int balls, double packing, std::uint64_t seed, bool in_order = true);

  /// Continues for this number of collisions.
  void run(std::uint64_t collisions);

  std::uint64_t collisions() const { return collisions_; }
  std::uint64_t crossings() const { return crossings_; }
  std::uint64_t stale_events() const { return stale_; }
  double time() const { return past_ + now_; }
  double box() const { return box_; }
  double kinetic_energy() const;
  /// The places of all balls now; a ball may be a little outside of the box.
  std::vector<std::array<double, 3>> positions() const;
 private:
  using Vector = std::array<double, 3>;

  struct Ball {
    Vector position;  ///< at `time`, the ball's last event
    Vector velocity;
    double time;
    std::array<int, 3> cell;
    int next, previous;  ///< in the list of the cell; -1 ends it
    std::uint32_t impacts;

    // The ball's first contact, void once the partner has collided with somebody else, and its next
    // cell.
    double contact_time;
    int partner;
    std::uint32_t partner_impacts;
    double crossing_time;
    int axis, step;
  };

  int wrapped(int place) const {
    return place < 0 ? place + side_ : place >= side_ ? place - side_ : place;
  }
  int& first_in(const std::array<int, 3>& cell) {
    return cells_[cell[0] + side_ * (cell[1] + side_ * cell[2])];
  }
  void enter_cell(int i);
  void leave_cell(int i);

  void collide(int i, int j);
  void cross(int i);
  void advance(Ball& ball) const;
  void predict(int i);
  void predict_contacts(int i, const std::array<int, 3>& low, const std::array<int, 3>& high);
  void predict_crossing(Ball& ball) const;
  void requeue(int i) { heap_.set(i, std::min(balls_[i].contact_time, balls_[i].crossing_time)); }
  double nearest_image(double r) const {
    return r > box_ / 2 ? r - box_ : r < -box_ / 2 ? r + box_ : r;
  }
  void restart_clock();

  double box_, edge_;
  int side_;
  double now_ = 0, past_ = 0;
  std::uint64_t collisions_ = 0, crossings_ = 0, stale_ = 0;
  std::vector<Ball> balls_;
  std::vector<int> cells_;  ///< first ball of each
  EventHeap heap_;
};

}  // namespace edmill::performance
