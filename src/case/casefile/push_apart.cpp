#include "casefile/push_apart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

namespace edmill::casefile {

namespace {

using Place = Vec3<double>;

/// Balls are pushed a little farther than they have to be, so that the pushes come to an end.
constexpr double farther = 1e-3, tolerated = 1e-7;

class Crowd {
 public:
  Crowd(const model::AnyVessel<double>& vessel, const std::vector<double>& moved,
        std::vector<CrowdBall>& balls, double share)
      : vessel_(vessel), moved_(moved), balls_(balls), share_(share) {
    std::map<double, std::size_t> known;  // rooms by the distance that centres keep from walls
    for (const auto& ball : balls_) {
      const double distance = ball.radius * (1 + tolerated) + share * ball.gap_wall;
      const auto [entry, is_new] = known.emplace(distance, rooms_.size());
      if (is_new) rooms_.push_back({distance, vessel_.inset(distance)});
      room_of_.push_back(entry->second);
      widest_ = std::max(widest_, 2 * ball.radius + share * ball.gap_ball);
      slimmest_ = std::min(slimmest_, ball.radius);
    }
  }

  bool has_room() const {
    return std::none_of(rooms_.begin(), rooms_.end(), [](const Room& r) { return r.vessel.is_empty(); });
  }

  /// @return whether all are apart
  bool sweep() {
    if (have_gone_far()) find_pairs();
    bool apart = true;
    for (const auto& [one, other] : pairs_) apart &= part(one, other);
    for (std::size_t k = 0; k < balls_.size(); ++k)
      if (!balls_[k].fixed) apart &= bring_inside(k);
    return apart;
  }

 private:
  struct Room {
    double distance;  ///< of a centre from the walls [m]
    model::AnyVessel<double> vessel;
  };

  double skin() const { return slimmest_ / 2; }
  double least_distance(std::size_t one, std::size_t other) const {
    return (balls_[one].radius + balls_[other].radius) * (1 + tolerated) +
           share_ * balls_[std::max(one, other)].gap_ball;
  }

  /// @return whether they were apart
  bool part(std::size_t one, std::size_t other) {
    CrowdBall &a = balls_[one], &b = balls_[other];
    Place between = a.place - b.place;
    const double least = least_distance(one, other), square = squared_norm<double>(between);
    if (square >= least * least) return true;
    double distance = std::sqrt(square);
    if (!(distance > 0)) between = Place(0, distance = 1, 0);
    const double push = least * (1 + farther) - std::sqrt(square);
    const double of_one = a.fixed ? 0 : b.fixed ? 1 : 0.5;
    a.place += between * (push * of_one / distance);
    b.place -= between * (push * (a.fixed ? 1 : 1 - of_one) / distance);
    return a.fixed && b.fixed;
  }

  /// @return whether the ball was inside
  bool bring_inside(std::size_t k) {
    const Room& room = rooms_[room_of_[k]];
    Place& p = balls_[k].place;
    if (is_inside(room, p)) return true;
    for (int wall = 0; wall < vessel_.wall_count(); ++wall) {
      const double moved = moved_.empty() ? 0 : moved_[static_cast<std::size_t>(wall)];
      const double overlap = room.vessel.overlap(wall, p) + moved;
      if (overlap > 0) p += room.vessel.normal(wall, p) * (overlap + farther * balls_[k].radius / 16);
    }
    return false;
  }
  bool is_inside(const Room& room, const Place& p) const {
    if (!room.vessel.contains(p)) return false;
    for (std::size_t wall = 0; wall < moved_.size(); ++wall)
      if (moved_[wall] != 0 && vessel_.gap(static_cast<int>(wall), p) < room.distance + moved_[wall])
        return false;
    return true;
  }

  bool have_gone_far() const {
    if (begin_.empty()) return true;
    const double most = skin() * skin() / 4;
    for (std::size_t k = 0; k < balls_.size(); ++k)
      if (squared_norm<double>(balls_[k].place - begin_[k]) > most) return true;
    return false;
  }

  /// Pairs that can come too close before any ball has gone half the skin, by cells as wide as the widest.
  void find_pairs() {
    begin_.clear();
    for (const auto& ball : balls_) begin_.push_back(ball.place);
    pairs_.clear();
    Place low = begin_.front(), high = low;
    for (const auto& p : begin_) low = low.cwiseMin(p), high = high.cwiseMax(p);
    std::array<int, 3> cells;
    for (int axis = 0; axis < 3; ++axis)
      cells[axis] = static_cast<int>(std::clamp((high[axis] - low[axis]) / (widest_ + skin()), 1.0, 64.0));
    const auto cell_of = [&](const Place& p, int axis) {
      const double extent = high[axis] - low[axis];
      const double place = extent > 0 ? (p[axis] - low[axis]) / extent * cells[axis] : 0;
      return std::min(static_cast<int>(place), cells[axis] - 1);
    };
    std::vector<std::vector<std::size_t>> content(static_cast<std::size_t>(cells[0] * cells[1] * cells[2]));
    const auto at = [&](int x, int y, int z) -> auto& {
      return content[static_cast<std::size_t>((x * cells[1] + y) * cells[2] + z)];
    };
    for (std::size_t k = 0; k < begin_.size(); ++k) {
      const int x = cell_of(begin_[k], 0), y = cell_of(begin_[k], 1), z = cell_of(begin_[k], 2);
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, cells[0] - 1); ++u)
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, cells[1] - 1); ++v)
          for (int w = std::max(z - 1, 0); w <= std::min(z + 1, cells[2] - 1); ++w)
            for (const auto other : at(u, v, w)) add_pair(other, k);
      at(x, y, z).push_back(k);
    }
  }
  void add_pair(std::size_t one, std::size_t other) {
    const double reach = least_distance(one, other) + skin();
    if (squared_norm<double>(begin_[one] - begin_[other]) < reach * reach) pairs_.emplace_back(one, other);
  }

  const model::AnyVessel<double>& vessel_;
  const std::vector<double>& moved_;
  std::vector<CrowdBall>& balls_;
  double share_;
  std::vector<Room> rooms_;
  std::vector<std::size_t> room_of_;
  double widest_ = 0, slimmest_ = 1e300;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;
  std::vector<Place> begin_;  ///< places when the pairs were found
};

}  // namespace

bool push_apart(const model::AnyVessel<double>& vessel, const std::vector<double>& moved,
                std::vector<CrowdBall>& balls, double share) {
  Crowd crowd(vessel, moved, balls, share);
  if (!crowd.has_room()) return false;
  const std::int64_t most =
      std::clamp<std::int64_t>(2000000 / static_cast<std::int64_t>(balls.size()), 200, 4000);
  for (std::int64_t k = 0; k < most; ++k)
    if (crowd.sweep()) return true;
  return false;
}

}  // namespace edmill::casefile
