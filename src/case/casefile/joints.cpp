// Joints of a chain as a case file says them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/scalar_list.hpp"
#include "casefile/case_parts.hpp"
#include "casefile/rational.hpp"
#include "casefile/tables.hpp"

namespace edmill::casefile {

namespace {

using boost::multiprecision::cpp_int;
using model::Joint;
using model::Joints;
using model::Swing;

/// The share of a turn by which `turns` exceeds whole turns, cut to the bits of a TurnFraction: to those that
/// the thread's `mpfr` needs, too.
TurnFraction fraction_of(const Quantity& turns) {
  TurnFraction fraction;
#if !defined(EDMILL_WITHOUT_MPFR)
  const std::size_t needed = TurnFraction::words_for(binary_digits<mpfr>());
  if (needed > TurnFraction::words) fraction.further.resize(needed - TurnFraction::words);
#endif
  const int fraction_bits = 64 * static_cast<int>(TurnFraction::words + fraction.further.size());
  const Rational value = value_of(turns, 2 * fraction_bits);
  cpp_int scaled = (numerator(value) << fraction_bits) / denominator(value);
  const cpp_int one = cpp_int(1) << fraction_bits;
  const cpp_int whole = scaled / one - (scaled % one < 0 ? 1 : 0);  // rounded down
  fraction.whole = static_cast<std::int64_t>(whole);
  scaled -= whole * one;
  for (std::size_t k = TurnFraction::words + fraction.further.size(); k-- > 0; scaled >>= 64)
    (k < TurnFraction::words ? fraction.bits[k] : fraction.further[k - TurnFraction::words]) =
        static_cast<std::uint64_t>(scaled & 0xffffffffffffffffu);
  return fraction;
}

/// A constant angle or phase less its whole turns: a scalar has the rest to its last digit. One of less
/// than a turn stays as it is given.
Quantity without_whole_turns(const Quantity& turns) {
  const auto fraction = fraction_of(turns);
  if (fraction.whole == 0 || fraction.whole == -1) return turns;
  if (turns.pi_power == 0) return quantity_of(rational(turns) - fraction.whole);
  cpp_int bits = 0;
  const std::size_t words = TurnFraction::words + fraction.further.size();
  for (std::size_t k = 0; k < words; ++k) bits = (bits << 64) + fraction.word(k);
  return quantity_of({bits, cpp_int(1) << (64 * words)});
}

/// A frequency [1/s] for an angular speed [rad/s], turns for an angle [rad].
Quantity in_turns(const Quantity& radians) {
  return quantity_of(rational(radians) / 2, radians.pi_power - 1);
}

const std::array<std::string, 3> axes{"x", "y", "z"};

bool is_zero(const QuantityVector& v) { return v[0].zero() && v[1].zero() && v[2].zero(); }

Joint<Quantity> rotation_of(Section& section, JointTable& table) {
  Joint<Quantity> joint;
  joint.axis = table.rotate.direction;
  joint.angle = in_turns(table.angle);
  joint.speed = in_turns(table.speed);
  joint.swings = read_swings(table.swings);
  if (joint.angle.zero() && joint.speed.zero() && joint.swings.empty())
    section.problem(first_of(section, {"speed", "angle", "rotate"}), "a joint that does not turn",
                    "one with angle, speed or swing");
  return joint;
}

Joint<Quantity> translation_of(Section& section, JointTable& table) {
  Joint<Quantity> joint;
  joint.rotates = false;
  joint.speed = table.speed;
  joint.swings = read_swings(table.swings);
  const bool named = !section.is_array("translate");
  if (!named && section.has("distance"))
    section.problem("distance",
                    table.translate.shift ? "a shift with all three lengths given"
                                          : "a distance along an axis of three numbers",
                    table.translate.shift ? "translate = \"x\", \"y\" or \"z\" with it"
                                          : "a joint of its own for it, translate = [..] with three lengths");
  if (table.translate.shift) {
    joint.shift = *table.translate.shift;
    if (is_zero(joint.shift))
      section.problem("translate", "a joint that shifts nothing", "a length other than zero");
    return joint;
  }
  joint.axis = table.translate.direction;
  if (!named) return joint;
  for (std::size_t k = 0; k < 3; ++k) joint.shift[k] = joint.axis[k] * table.distance;
  if (table.distance.zero() && joint.speed.zero() && joint.swings.empty())
    section.problem(first_of(section, {"speed", "distance", "translate"}), "a joint that shifts nothing",
                    "one with distance, speed or swing");
  return joint;
}

/// The fastest joint sets the clock.
Quantity period_of_fastest(const Joints<Quantity>& joints) {
  Quantity fastest{0};
  const auto see = [&](const Quantity& frequency) {
    if (std::abs(frequency.to<double>()) > std::abs(fastest.to<double>())) fastest = frequency;
  };
  for (const auto& joint : joints.list) {
    if (joint.rotates) see(joint.speed);
    for (const auto& swing : joint.swings) see(swing.frequency);
  }
  if (fastest.zero()) return {1, 16};
  if (fastest.negative()) fastest = -fastest;
  return Quantity{1} / fastest;
}

std::string axis_name(const std::array<Quantity, 3>& axis) {
  for (std::size_t k = 0; k < 3; ++k)
    if (axis[k] == 1 && axis[(k + 1) % 3].zero() && axis[(k + 2) % 3].zero()) return axes[k];
  return fmt::format("({:g}, {:g}, {:g})", axis[0].to<double>(), axis[1].to<double>(), axis[2].to<double>());
}

/// With its sign, after other terms.
std::string term(double value) { return fmt::format(" {} {:g}", value < 0 ? '-' : '+', std::abs(value)); }

/// Terms that may begin with a sign.
std::string as_sum(const std::string& terms) {
  if (terms.empty()) return "0 deg";
  return terms.starts_with(" + ")   ? terms.substr(3)
         : terms.starts_with(" - ") ? "-" + terms.substr(3)
                                    : terms;
}

std::string text_of_joint(const Joint<Quantity>& joint) {
  if (joint.rotates) {
    std::string angle;
    if (!joint.angle.zero()) angle = fmt::format("{:g} deg", 360 * joint.angle.to<double>());
    if (!joint.speed.zero()) angle += term(360 * joint.speed.to<double>()) + " deg/s t";
    return "turn about " + axis_name(joint.axis) + " by " +
           as_sum(angle + equation_of(joint.swings, joint.rotates));
  }
  std::string text = fmt::format("shift by ({:g}, {:g}, {:g}) m", joint.shift[0].to<double>(),
                                 joint.shift[1].to<double>(), joint.shift[2].to<double>());
  if (!joint.speed.zero()) text += term(joint.speed.to<double>()) + " m/s t";
  text += equation_of(joint.swings, joint.rotates);
  if (!joint.speed.zero() || !joint.swings.empty()) text += " along " + axis_name(joint.axis);
  return text;
}

void require_speed(Section& swing, const Quantity& speed) {
  swing.require(speed.positive() && speed.to<double>() < 1e6, "speed",
                "a positive angular speed below 1e6 rad/s");
}

template <class Spex>
std::vector<Joint<Quantity>> spex_joints(const Spex& spex) {
  const auto number = [](int n, int d) { return Quantity{n, d}; };
  const Quantity frequency = Quantity{1} / spex.period;
  Joint<Quantity> swing, arm, turn;
  swing.axis[2] = number(1, 1);
  swing.angle = number(1, 4);
  swing.swings.push_back({in_turns(spex.theta_max), frequency, number(1, 4)});
  arm.rotates = false;
  arm.shift[0] = spex.arm;
  turn.axis[0] = number(1, 1);
  turn.swings.push_back({in_turns(spex.gamma_max), frequency, number(0, 1)});
  return {swing, arm, turn};
}

}  // namespace

void check_swings(Section& section, const std::vector<Swing<Quantity>>& swings) {
  for (const auto& swing : swings)
    require_speed(section, quantity_of(2 * rational(swing.frequency), 1 + swing.frequency.pi_power));
}

void Axis::read_from(Section& joint, const char* key) {
  if (!joint.has(key)) return;
  if (joint.is_array(key)) {
    direction = joint.vector(key, Dimension::none).value_or(QuantityVector{Quantity{1}});
    joint.require(!is_zero(direction), key, "an axis other than zero");
    return;
  }
  const auto axis = std::find(axes.begin(), axes.end(), joint.text(key).value_or("x"));
  joint.require(axis != axes.end(), key, "\"x\", \"y\", \"z\" or an array of three numbers");
  direction = {};
  if (axis != axes.end()) direction[static_cast<std::size_t>(axis - axes.begin())] = Quantity{1};
}

void Translation::read_from(Section& joint, const char* key) {
  if (joint.is_array(key) && !joint.has("swing") && !joint.has("speed"))
    shift = joint.vector(key, Dimension::length).value_or(QuantityVector{Quantity{1}});
  else
    Axis::read_from(joint, key);
}

std::vector<Swing<Quantity>> read_swings(Entries<SwingTable>& entries) {
  std::vector<Swing<Quantity>> swings;
  const bool rotates = entries.like.dimension == Dimension::angle;
  for (Section& entry : entries) {
    SwingTable swing = entries.like;
    read_keys(entry, swing);
    require_speed(entry, swing.speed);
    swings.push_back({rotates ? in_turns(swing.amplitude) : swing.amplitude, in_turns(swing.speed),
                      in_turns(swing.phase)});
    entry.reject_unknown_keys();
  }
  return swings;
}

std::string equation_of(const std::vector<Swing<Quantity>>& swings, bool rotate) {
  std::string text;
  for (const auto& s : swings) {
    text += term(s.amplitude.to<double>() * (rotate ? 360 : 1)) +
            fmt::format(" {} sin(2 pi {:g} t/s", rotate ? "deg" : "m", s.frequency.to<double>());
    if (!s.phase.zero()) text += term(360 * s.phase.to<double>()) + " deg";
    text += ")";
  }
  return text;
}

std::vector<Swing<Quantity>> with_phases(std::vector<Swing<Quantity>> swings, const Quantity& period) {
  for (auto& swing : swings) {
    swing.per_period = fraction_of(swing.frequency * period);
    swing.phase = without_whole_turns(swing.phase);
  }
  return swings;
}

Joints<Quantity> with_phases(Joints<Quantity> joints) {
  for (auto& joint : joints.list) {
    if (joint.rotates) joint.per_period = fraction_of(joint.speed * joints.period);
    joint.angle = without_whole_turns(joint.angle);
    joint.swings = with_phases(std::move(joint.swings), joints.period);
  }
  return joints;
}

Joints<Quantity> read_joints(Section& mill) {
  Joints<Quantity> joints;
  ChainTable chain;
  read_keys(mill, chain);
  if (chain.joints.empty() && !mill.has("joint"))
    mill.problem("joint", "nothing", "at least one [[mill.joint]]");
  for (Section& entry : chain.joints) {
    const bool rotates = entry.has("rotate");
    if (rotates == entry.has("translate")) {
      entry.problem("rotate", rotates ? "rotate and translate" : "neither rotate nor translate",
                    "one of them");
      continue;
    }
    JointTable table;
    table.rotates = rotates;
    table.swings.like.dimension = rotates ? Dimension::angle : Dimension::length;
    read_keys(entry, table);
    joints.list.push_back(rotates ? rotation_of(entry, table) : translation_of(entry, table));
    entry.reject_unknown_keys();
  }
  joints.period = period_of_fastest(joints);
  return joints;
}

void require_end(Section& mill) {
  for (Section& entry : mill.sections("joint"))
    if (entry.has("translate") && entry.has("speed"))
      entry.problem("speed", "a translation that goes on and on", "a run.end_time");
}

std::string equation_of(const Joints<Quantity>& joints) {
  std::string text;
  for (const auto& joint : joints.list) text += (text.empty() ? "" : "; ") + text_of_joint(joint);
  return text;
}

std::vector<model::Joint<Quantity>> joints_of(const MotionSpec& motion) {
  return std::visit(
      [](const auto& m) {
        if constexpr (requires { m.joints(); })
          return m.joints().list;
        else
          return spex_joints(m);
      },
      motion);
}

}  // namespace edmill::casefile
