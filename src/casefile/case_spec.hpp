// A case as its file says it: exact quantities, no scalar yet.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "casefile/colour.hpp"
#include "casefile/output_spec.hpp"
#include "casefile/parts.hpp"
#include "casefile/quantity.hpp"
#include "model/contact_law.hpp"
#include "model/parts/partners.hpp"
#include "model/stop_rules.hpp"

namespace edmill::casefile {

using QuantityVector = std::array<Quantity, 3>;

/// An entry [[material]].
struct MaterialSpec {
  std::string name;
  std::optional<Quantity> density;  ///< balls need it, walls do not
};

/// What all ways of adding balls have in common.
struct BallSpec {
  Quantity diameter;
  Quantity density{8000};
  int material = 0;  ///< of CaseSpec::materials, from 1; 0 for none
  Quantity reduced_inertia{boost::multiprecision::cpp_rational(2, 5)};
  QuantityVector velocity{};
  Colour colour{0, 0, 1};  ///< in pictures
  std::string where;       ///< "case.toml:12: [[balls]] 1", for messages
};

/// A batch of balls placed at random. (thesis D.2.4)
struct BallBatch : BallSpec {
  int count = 1;
  Quantity diameter_spread;
  std::optional<Quantity> random_speed;  ///< largest; direction and size at random
  Quantity gap_ball{boost::multiprecision::cpp_rational(1, 1000)};
  Quantity gap_wall{boost::multiprecision::cpp_rational(1, 1000)};
  std::uint64_t max_relocations = 100000;
};

/// A ball with its state at the initial time, in the inertial frame.
struct ExplicitBall : BallSpec {
  QuantityVector position{};
  QuantityVector spin{};
};

using ContactSpec = model::ContactLaw<Quantity>;

/// An entry [[contact.pair]].
struct PairSpec {
  std::array<int, 2> materials{};  ///< from 1
  ContactSpec law;

  bool is_of(int one, int other) const {
    return materials == std::array{one, other} || materials == std::array{other, one};
  }
};

/// Section [audit]: how another code's collision log is to be read and judged. docs/audit.md
struct AuditSpec {
  std::vector<std::pair<std::string, std::string>> columns;  ///< our name, theirs with its unit: "t [ms]"
  std::optional<Quantity> tolerance, gap_tolerance;
  std::optional<std::uint64_t> first_ball;
  std::string walls;  ///< "-1, -2, -3": what stands for the walls, by id; empty when not given
  bool from_start = false;
};

struct CaseSpec {
  std::string file;                   ///< path of the case file
  std::string text;                   ///< of the case file
  std::vector<std::string> settings;  ///< over it, "section.key=value"
  bool reported = false;              ///< the outputs of the report were added to those of the file
  std::string digest;                 ///< SHA-256 of the case's canonical text
  std::string precision = "double";
  std::uint64_t seed = 1;
  Quantity initial_time, statistics_start;
  std::optional<Quantity> end_time;
  model::StopLimits<Quantity> stop_limits;
  std::string initial_state;  ///< path of a final_state.csv, or empty
  QuantityVector gravity{};
  MotionSpec mill;
  VesselSpec vessel;
  std::vector<model::Piston<Quantity>> pistons;
  Colour vessel_colour{1, 1, 0};  ///< in pictures
  std::vector<MaterialSpec> materials;
  std::vector<int> wall_materials;  ///< by wall, from 1; 0 for none
  ContactSpec ball_ball, ball_wall;
  std::vector<PairSpec> pairs;  ///< in place of both where two materials are named
  bool pairs_only = false;      ///< every contact that can be is one of them
  std::optional<Quantity> powder_mass;
  std::vector<ExplicitBall> balls;
  std::vector<BallBatch> batches;
  std::vector<OutputSpec> outputs;
  AuditSpec audit;  ///< no part of what is simulated, nor of the digest

  /// From 1; 0 when there is none.
  int material_named(const std::string& name) const;
  /// "steel, rubber", for readers.
  std::string names_of(const PairSpec& pair) const {
    return materials[static_cast<std::size_t>(pair.materials[0]) - 1].name + ", " +
           materials[static_cast<std::size_t>(pair.materials[1]) - 1].name;
  }
  std::size_t ball_count() const;
  /// Colours of all balls, in their order.
  std::vector<Colour> ball_colours() const;
};

/// "0.01 m + 0.001 m sin(2 pi 5 t) inward", for readers.
std::string describe(const model::Piston<Quantity>& piston);

/// "(0, -9.8, 0) m/s^2" or "none", for readers.
std::string describe_gravity(const CaseSpec& spec);

/// What the balls of a case can collide with.
model::Partners partners_of(const CaseSpec& spec);

/// Precisions that a case can name.
const std::vector<std::string>& precisions();

/// Reads and checks a case file.
/// @param overrides  "section.key=value", applied over the file; a value that is not TOML is taken as text
/// @throws InputError with every problem of the file: file, line, key, found, expected
CaseSpec read_case(const std::string& path, const std::vector<std::string>& overrides = {});

/// Reads and checks the text of a case; `name` stands for the file in messages.
CaseSpec parse_case(const std::string& text, const std::string& name,
                    const std::vector<std::string>& overrides = {});

}  // namespace edmill::casefile
