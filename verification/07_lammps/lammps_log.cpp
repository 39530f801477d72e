// A collision log of LAMMPS, as a user of a soft-sphere code writes one, and what `edmill audit
// --identify` says of it.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "core.hpp"
#include "identify/identify.hpp"
#include "lammps_contacts.hpp"
#include "lammps_limit.hpp"
#include "output/collision_log.hpp"

namespace edmill::verification {
namespace {

/// A line for each contact: bodies and states at the first step with an overlap, velocities and
/// spins at the first step without one.
class ContactLog {
 public:
  ContactLog(const LammpsMotion& m, const LammpsSetting& s)
      : motion_(m.arm, m.theta_max, m.gamma_max, m.period), setting_(s) {}

  void look(double time, const std::vector<LammpsBall>& balls) {
    const auto pose = motion_.pose(DriveClock<double>(motion_.period()).at(time));
    const auto state = [&](std::size_t k) {
      const auto vec = [](const Triple& t) { return Vec3<double>(t[0], t[1], t[2]); };
      const Vec3<double> place = motion_.to_inertial(pose, vec(balls[k].position));
      return model::BallState<double>{place,
          motion_.direction_to_inertial(pose, vec(balls[k].velocity)) +
              motion_.wall_velocity(pose, place),
          motion_.direction_to_inertial(pose, vec(balls[k].spin)) + motion_.angular_velocity(pose)};
    };
    const double radius = setting_.ball_diameter / 2;
    const auto see = [&](std::size_t ball, bool wall, std::size_t partner, double gap) {
      const auto key = std::tuple(ball, wall, partner);
      const auto open = open_.find(key);
      if (gap < 0 && open == open_.end())
        open_[key] = {time, state(ball), wall ? model::BallState<double>{} : state(partner)};
      if (gap < 0 || open == open_.end()) return;
      durations.push_back(time - open->second.time);
      lines_.emplace_back(open->second.time,
          line(ball, wall, partner, open->second, state(ball),
              wall ? open->second.two : state(partner)));
      open_.erase(open);
    };
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const auto& p = balls[i].position;
      see(i, true, 0, setting_.vessel_half_height + p[1] - radius);
      see(i, true, 1, setting_.vessel_half_height - p[1] - radius);
      see(i, true, 2, setting_.vessel_radius - radius - std::hypot(p[0], p[2]));
      for (std::size_t j = i + 1; j < balls.size(); ++j) {
        const auto& q = balls[j].position;
        see(i, false, j, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) - 2 * radius);
      }
    }
  }
  std::size_t count() const { return lines_.size(); }
  void write(const std::filesystem::path& file) {
    std::sort(lines_.begin(), lines_.end());
    std::ofstream out(file);
    out << "time,ball,partner_kind,partner";
    model::for_logged_vectors([&](const std::string& name) { out << ',' << name; });
    out << '\n';
    for (const auto& [time, line] : lines_) out << line << '\n';
  }
  std::vector<double> durations;
 private:
  struct Open {
    double time;
    model::BallState<double> one, two;
  };
  static std::string line(std::size_t ball, bool wall, std::size_t partner, const Open& before,
      const model::BallState<double>& one, const model::BallState<double>& two) {
    auto text = fmt::format("{},{},{},{}", before.time, ball, wall ? "wall" : "ball", partner);
    const auto add = [&](const model::BallState<double>& b, const model::BallState<double>& a) {
      for (const auto* v : {&b.position, &b.velocity, &b.spin, &a.velocity, &a.spin})
        text += fmt::format(",{},{},{}", (*v)[0], (*v)[1], (*v)[2]);
    };
    add(before.one, one);
    if (wall)
      text += std::string(15, ',');
    else
      add(before.two, two);
    return text;
  }

  model::SpexMotion<double> motion_;
  const LammpsSetting& setting_;
  std::map<std::tuple<std::size_t, bool, std::size_t>, Open> open_;
  std::vector<std::pair<double, std::string>> lines_;
};

TEST_F(LammpsPeer, ItsLogIsDiagnosedAsSoftContacts) {
  const auto spec = casefile::read_case(EDMILL_SOURCE_DIR "/docs/examples/ward.toml",
      {"balls.0.count=7", "balls.0.diameter=9.52 mm", "contact.restitution=0.52"});
  auto setting = setting_of(0.00952, 50e-6);
  setting.damping = damping_for(0.52, setting);
  setting.motion = spex;
  const auto built = casefile::build_case<double>(spec);
  const auto& motion = built.the_case.mill.motion;
  const auto pose = motion.pose({0, 0.0});
  const Triple turning = VesselFrame(spex, 0).spin;
  std::vector<LammpsBall> balls;
  for (const auto& state : built.states) {
    const auto seen = motion.to_vessel_frame(pose, state.position, state.velocity);
    const auto &x = seen.position, &v = seen.velocity;
    balls.push_back(
        {{x[0], x[1], x[2]}, {v[0], v[1], v[2]}, {-turning[0], -turning[1], -turning[2]}});
  }
  LammpsMill mill(setting, balls);
  ContactLog log(spex, setting);
  while (log.count() < 400) {
    mill.run(1);
    log.look(mill.time(), mill.balls());
  }
  const auto file = std::filesystem::temp_directory_path() / "edmill-lammps-log.csv";
  log.write(file);
  audit::Options options;
  options.log = file;
  const auto found = identify::identify(spec, options);
  claim.say(identify::table(found));
  std::filesystem::remove(file);
  ASSERT_TRUE(found.stepping.soft);
  auto& all = log.durations;
  std::nth_element(
      all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2), all.end());
  const double true_duration = all[all.size() / 2];
  claim.at_most(
      "LAMMPS log of 7 balls, contact time that is identified over the true median, as a factor",
      std::max(found.stepping.soft->duration / true_duration,
          true_duration / found.stepping.soft->duration),
      1.5);
  claim.at_most("LAMMPS log of 7 balls, wrong parameters that are named",
      static_cast<double>(found.causes.size()), 0);
  ASSERT_TRUE(found.stepping.step);
  claim.at_most("LAMMPS log of 7 balls, its step from the log, relative error",
      std::abs(*found.stepping.step / setting.time_step - 1), 1e-6);
}

}  // namespace
}  // namespace edmill::verification
