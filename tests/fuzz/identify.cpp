// Logs of the mills below, changed at random: the audit and the search for what explains them. The
// first byte chooses the mill, the second what the case says otherwise, which may have another
// number of walls or balls than the log.
#include "identify/identify.hpp"

#include "base/errors.hpp"
#include "casefile/build_case.hpp"
#include "input.hpp"

namespace {

using namespace edmill;

constexpr const char* mills[] = {
    "[mill]\ntype = \"spex8000\"\n[vessel]\ndiameter = \"38 mm\"\nheight = \"57 mm\"\n",
    "[mill]\ntype = \"planetary\"\nspeed = \"300 rpm\"\nradius = \"75 mm\"\nratio = "
    "-2\n[vessel]\ndiameter = "
    "\"50 mm\"\n"
    "height = \"40 mm\"\n",
    "[mill]\ntype = \"vibratory\"\namplitude = [\"5 mm\", \"0 mm\", \"1 mm\"]\nspeed = \"1500 "
    "rpm\"\n[vessel]\ntype = \"box\"\n"
    "size = [\"30 mm\", \"40 mm\", \"50 mm\"]\n",
    "[mill]\ntype = \"spex8000\"\n[vessel]\ntype = \"sphere\"\ndiameter = \"50 mm\"\n",
    "[mill]\ntype = \"spex8000\"\n[vessel]\ndiameter = \"38 mm\"\nheight = \"57 "
    "mm\"\n[[vessel.piston]]\nwall = \"cap +y\"\n"
    "distance = \"3 mm\"\nswing = [{ amplitude = \"2 mm\", speed = \"600 rpm\" }]\n",
};
constexpr const char* rest =
    "[run]\nend_time = \"1 s\"\n[contact]\nrestitution = 0.5\nfriction = 0.4\n[[balls]]\ncount = "
    "3\ndiameter "
    "= \"6 mm\"\n";
constexpr const char* changes[] = {"run.seed=1", "run.seed=2", "contact.restitution=0",
    "contact.friction=0", "contact.least_separation=\"0 m/s\"", "balls.0.diameter=\"7 mm\"",
    "balls.0.count=5", "run.gravity=\"9.8 m/s2\""};

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const auto file = fuzz::file_of(fuzz::text_of(data + 2, size - 2), "collisions.csv");
  try {
    const auto spec = casefile::parse_case(std::string(mills[data[0] % std::size(mills)]) + rest,
        "fuzz.toml", {changes[data[1] % std::size(changes)]});
    const auto built = casefile::build_case<double>(spec);
    audit::Options options;
    options.log = file;
    options.from_start = data[1] & 64;
    audit::audit(built.the_case, built.states, options);
    identify::identify(spec, options);
  } catch (const InputError&) {
  }
  return 0;
}
