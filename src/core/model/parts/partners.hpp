// Collision partners of a ball, in the order of tables: the walls by id, then other balls.
#pragma once

#include <string>
#include <vector>

namespace edmill::model {

/// A wall for readers: "cap -y", "the cap at -y".
struct WallInfo {
  std::string label, meaning;
};

/// "wall 0" and so on. @param meaning  without the number
inline std::vector<WallInfo> numbered_walls(int count, const std::string& meaning) {
  std::vector<WallInfo> walls;
  for (int k = 0; k < count; ++k)
    walls.push_back({"wall " + std::to_string(k), meaning + std::to_string(k)});
  return walls;
}

/// The names of a partner, everywhere.
struct PartnerInfo {
  std::string key;      ///< in files: "wall_0"
  std::string label;    ///< for readers: "cap -y"
  std::string meaning;  ///< of a column for its impacts: "with wall 0, the cap at -y"
};

/// The key of a partner by its place.
inline std::string partner_key(int place, int walls) {
  return place < walls ? "wall_" + std::to_string(place) : "ball_ball";
}

/// All partners in order: the walls of a vessel by id; other balls are always the last.
class Partners {
 public:
  Partners() : Partners(std::vector<WallInfo>{}) {}
  explicit Partners(const std::vector<WallInfo>& walls) : walls_(static_cast<int>(walls.size())) {
    for (int id = 0; id < walls_; ++id)
      list_.push_back({partner_key(id, walls_), walls[id].label,
          "with wall " + std::to_string(id) + ", " + walls[id].meaning});
    list_.push_back({partner_key(walls_, walls_), "ball-ball", "between balls"});
  }

  int walls() const { return walls_; }
  int count() const { return walls_ + 1; }
  int ball_ball() const { return walls_; }
  const PartnerInfo& operator[](int place) const { return list_[place]; }
 private:
  int walls_;
  std::vector<PartnerInfo> list_;
};

Partners partners_of(const auto& vessel) { return Partners(vessel.walls()); }

}  // namespace edmill::model
