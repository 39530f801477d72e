#include "app/check_case.hpp"

#include <fmt/format.h>

#include <utility>

#include "casefile/build_case.hpp"
#include "casefile/case_spec.hpp"
#include "io/output_folder.hpp"
#include "report/report_page.hpp"
#include "run/any_run.hpp"

namespace edmill::app {

namespace {

std::string describe_law(const model::ContactLaw<double>& law) {
  std::string text = law.name();
  const char* separator = ": ";
  law.parameters([&](const model::Parameter& p, double value) {
    text += fmt::format("{}{} {}", std::exchange(separator, ", "), p.key, value);
  });
  return text + (law.least_separation > 0 ? fmt::format(", least separation {:g} m/s", law.least_separation)
                                          : ", no least separation");
}

/// "Y", "-X", "(0.966, 0.259, 0)"
std::string direction(const Vec3<double>& v) {
  for (int k = 0; k < 3; ++k)
    if (std::abs(v[k]) > 1 - 1e-12) return std::string(v[k] < 0 ? "-" : "") + "XYZ"[k];
  return fmt::format("({:.3g}, {:.3g}, {:.3g})", v[0], v[1], v[2]);
}

}  // namespace

CheckedCase check(const casefile::CaseSpec& spec) {
  return casefile::with_memory_for(spec, [&] {
    // The case must be valid in its own scalar; double is sufficient for the description.
    run::make_run(spec.precision, spec)->begin();
    const auto built = casefile::build_case<double>(spec, false);
    const auto& c = built.the_case;
    const auto& m = c.mill;
    CheckedCase result{spec.file, {}};
    const auto row = [&](const std::string& name, const std::string& value) {
      result.facts.emplace_back(name, value);
    };

    row("digest", spec.digest);
    row("precision, seed",
        fmt::format(
            "{}, {}",
            spec.digits ? fmt::format("for {} right digits at the end", *spec.digits) : spec.precision,
            spec.seed));
    row("statistics from", fmt::format("{} s", spec.statistics_start.to<double>()));
    if (spec.end_time) row("end_time", fmt::format("{} s", spec.end_time->to<double>()));
    model::for_each_stop_rule([&](auto rule, std::size_t place) {
      if (const auto& limit = c.stop.limits[place])
        row(rule.key.key, fmt::format("{}{}", *limit, casefile::si_unit(rule.key.dimension)));
    });

    row("gravity", casefile::describe_gravity(spec));
    row("mill", casefile::describe(spec.mill));
    const auto pose = m.motion.pose(DriveClock<double>(m.motion.period()).at(spec.initial_time.to<double>()));
    row("vessel's x, y, z",
        fmt::format("along {}, {}, {} of the laboratory at the start", direction(m.motion.axis_x(pose)),
                    direction(m.motion.axis_y(pose)), direction(m.motion.axis_z(pose))));
    if (const double peak = m.motion.wall_speed(0); peak > 0)
      row("peak wall speed", fmt::format("{:g} m/s at the vessel's centre", peak));
    row("vessel", casefile::describe(spec.vessel));
    const auto partners = casefile::partners_of(spec);
    for (const auto& piston : spec.pistons)
      row("piston " + partners[piston.wall].label, casefile::describe(piston));
    for (const auto& body : spec.bodies) row(body.name, casefile::describe(body));
    if (!spec.pairs_only) {
      row("contact ball-ball", describe_law(m.ball_ball));
      row("contact ball-wall", describe_law(m.ball_wall));
    }
    for (std::size_t k = 0; k < spec.pairs.size(); ++k)
      row("contact " + spec.names_of(spec.pairs[k]), describe_law(m.pairs.laws[k]));

    double mass = 0, volume = 0;
    for (const auto& ball : c.balls) {
      mass += ball.mass;
      volume += 4.0 / 3 * numerics::pi<double>() * ball.radius * ball.radius * ball.radius;
    }
    row("balls", fmt::format("{}, together {:g} kg", c.balls.size(), mass));
    const auto kind = [&](const casefile::BallSpec& b, int count) {
      const double d = b.diameter.to<double>(), density = b.density.to<double>();
      row("", fmt::format("{} x {:g} m, {:g} kg/m^3: {:g} kg each", count, d, density,
                          density * numerics::pi<double>() * d * d * d / 6));
    };
    for (const auto& b : spec.balls) kind(b, 1);
    for (const auto& b : spec.batches) kind(b, b.count);
    row("packing fraction", fmt::format("{:.4g}{}", volume / casefile::free_volume(m, built.start),
                                        !spec.pistons.empty() ? " of the vessel without its pistons"
                                        : m.bodies.empty()    ? ""
                                                              : " of the volume between the bodies"));
    for (const auto& gap : casefile::narrow_gaps(spec, m))
      row("narrow gap",
          fmt::format(
              "{} and {}: {:.3g} mm at {:.4g} s, less than a ball: balls that are squeezed there end the "
              "run as stalled",
              gap.one, gap.other, 1000 * gap.width, gap.time));
    if (spec.powder_mass)
      row("charge ratio", fmt::format("{:.4g} on {:g} kg of powder", mass / spec.powder_mass->to<double>(),
                                      spec.powder_mass->to<double>()));
    for (const auto& output : spec.outputs) row("output", output.type + " to " + output.file);
    return result;
  });
}

std::string CheckedCase::text() const {
  std::string out = fmt::format("{} is a valid case\n", file);
  for (const auto& [name, value] : facts) out += fmt::format("  {:<24}{}\n", name, value);
  return out;
}

void draw_mill(const casefile::CaseSpec& spec, const std::filesystem::path& file) {
  const auto built = casefile::build_case<double>(spec, false);
  io::NamedFile(file).write(report::mill_drawing(built.the_case.mill));
}

}  // namespace edmill::app
