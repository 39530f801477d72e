// Mills, ball materials and contacts with the sources of their numbers, and new cases made of them.
#pragma once

#include <string>
#include <vector>

namespace edmill::machines {

/// A key of a case with its value, and the source of the value.
struct Setting {
  std::string key, value;  ///< "mill.arm", "\"10 cm\"": as in a case file
  std::string source;      ///< of the value, whole
  std::string note;        ///< may be empty
};

/// A jar that is sold, with its inner size.
struct Jar {
  std::string volume, diameter, height;
};

struct Machine {
  std::string key, name;
  std::vector<std::string> also;        ///< other names
  std::string slowest, fastest, usual;  ///< speeds of its drive
  std::vector<Jar> jars{};
  std::vector<Setting> settings{};
};

/// A material of balls.
struct Material {
  std::string key, density, source;
  std::string dry;  ///< restitution and friction without powder in the literature; may be empty
  std::vector<std::string> also;
};

/// Machines that are not in the list, and what to do.
struct Elsewhere {
  std::vector<std::string> names;
  std::string what;
};

/// Default contact parameters for a kind of charge.
struct Contact {
  std::string key, what, model, restitution, source;
};

struct Catalogue {
  std::vector<Machine> machines;
  std::vector<Elsewhere> elsewhere;
  std::vector<Material> materials;
  std::vector<Contact> contacts;
  std::string friction, friction_source;
};

/// All that the program knows.
const Catalogue& catalogue();

/// As a table for a terminal, and as the page docs/machines.md.
std::string table();
std::string markdown();

/// Options of a new case; empty texts select the defaults of the machine.
struct Wanted {
  std::string machine = "spex8000";  ///< "pm100", "Retsch PM 100"
  std::vector<std::string> balls;    ///< "10x12.7mm", "4x6.35mm:zirconia"; one batch each
  std::string powder, speed, restitution, friction, target_dose;
  std::string time = "10 s";
  std::string jar;    ///< "250ml", or its inner size, "75x57mm"
  std::string fill;   ///< "30%": of the jar, by the balls with the gaps between them
  std::string ratio;  ///< mass of the balls over that of the powder
};

/// A case file with the sources in its comments.
/// @throws InputError that names the option, what was found and what was expected
std::string new_case(const Wanted& wanted);

}  // namespace edmill::machines
