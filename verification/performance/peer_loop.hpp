// The tuned reference implementation: minimal_loop.hpp with everything that makes such loops fast.
// Units as in periodic_gas.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace edmill::performance {

/// Which ball's event is next: a calendar of one year, cut into days that hold about one event
/// each.
class Calendar {
 public:
  /// @param day  length of a day; events beyond the year wait in a list of their own
  void open(int balls, double day);
  /// The ball whose event comes first, or -1 when the year is over.
  int first();
  double time(int ball) const { return entries_[ball].time; }
  double year() const { return year_; }
  void add(int ball, double time);
  void move(int ball, double time) {
    unlink(ball);
    add(ball, time);
  }
 private:
  struct Entry {
    double time;
    int next, previous;  ///< -1 ends a list; the first of day d is preceded by -2 - d
  };
  void unlink(int ball);

  double per_day_ = 1, year_ = 1;
  int days_ = 0, today_ = 0;
  std::vector<Entry> entries_;
  std::vector<int> heads_;
};

class PeerLoop {
 public:
  /// Starts from PeriodicGas, which see.
  PeerLoop(int balls, double packing, std::uint64_t seed, bool in_order = true);

  /// Continues for this number of collisions.
  void run(std::uint64_t collisions);

  std::uint64_t collisions() const { return collisions_; }
  std::uint64_t crossings() const { return crossings_; }
  std::uint64_t stale_events() const { return stale_; }
  double time() const { return years_ + now_; }
  double box() const { return box_; }
  double kinetic_energy() const;
  /// The places of all balls now; a ball may be a little outside of the box.
  std::vector<std::array<double, 3>> positions() const;
 private:
  using Vector = std::array<double, 3>;

  /// As of its last collision, in one cache line.
  struct alignas(64) Ball {
    Vector position;
    Vector velocity;
    double time;
    std::uint32_t impacts;
    std::uint32_t cell;  ///< ten bits a coordinate
  };
  /// A predicted contact; void once the partner has collided with somebody else.
  struct Contact {
    double time;
    int partner;
    std::uint32_t partner_impacts;
  };
  /// The predictions of a ball: the nearest of its own contacts, and its next cell.
  struct alignas(64) Agenda {
    static constexpr int capacity = 3;
    std::array<Contact, capacity> contacts;
    double crossing_time;
    std::int8_t axis, step;
    std::uint8_t count;
    bool dropped;  ///< contacts later than the ones kept were forgotten
  };
  struct Cell {
    static constexpr int capacity = 7;
    int count = 0;  ///< those beyond the capacity are in `spill_`
    std::array<int, capacity> balls;
  };
  struct Spilled {
    int cell, ball;
  };
  /// A ball on a collision course.
  struct Near {
    double b, c, discriminant;
    int ball;
  };

  static int coordinate(std::uint32_t cell, int axis) { return (cell >> (10 * axis)) & 1023; }
  int index(std::uint32_t cell) const {
    return coordinate(cell, 0) + side_ * (coordinate(cell, 1) + side_ * coordinate(cell, 2));
  }
  void enter(int cell, int ball);
  void leave(int cell, int ball);
  int* gather(int cell, int* end) const;

  void step();
  void collide(int i, int j);
  void cross(int i);
  void predict_pairs(int i, const Vector& position);
  void predict_crossing(int i, const Vector& position);
  template <bool at_edge>
  void consider(int i, const Vector& position, const int* first, const int* last);
  void keep(Agenda& agenda, const Contact& found);
  void requeue(int i) { calendar_.move(i, next_time(i)); }
  double next_time(int i) const;
  Vector position_now(const Ball& ball) const;
  void next_year();

  double box_, edge_;
  int side_;
  double now_ = 0, years_ = 0, day_ = 0;
  std::uint64_t collisions_ = 0, crossings_ = 0, stale_ = 0;
  std::vector<Ball> balls_;
  std::vector<Agenda> agendas_;
  std::vector<Cell> cells_;
  std::vector<Spilled> spill_;
  std::vector<int> candidates_;
  std::vector<Near> near_;
  Calendar calendar_;
};

}  // namespace edmill::performance
