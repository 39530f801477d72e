#include "report/report_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/atomic_file.hpp"
#include "io/checkpoint_file.hpp"
#include "io/output_folder.hpp"
#include "report/animation.hpp"
#include "report/embedded.hpp"
#include "report/page.hpp"
#include "report/sections.hpp"

namespace edmill::report {

namespace {

using plot::add;

/// One line that identifies the case.
std::string subtitle_of(const RunFolder& run) {
  const auto& spec = run.spec;
  std::string text = fmt::format("{} balls", spec.ball_count());
  if (spec.batches.size() == 1 && spec.balls.empty())
    text += fmt::format(" of {} mm", plot::brief(1000 * spec.batches[0].diameter.to<double>()));
  if (spec.powder_mass)
    text += fmt::format(", {} g of powder", plot::brief(1000 * spec.powder_mass->to<double>()));
  const auto mill = casefile::name_of(spec.mill);
  if (mill == "still") return text + ", in a still vessel";
  return text + fmt::format(", {} at {} rpm", mill == "spex8000" ? "SPEX 8000" : mill,
                            plot::brief(60 / casefile::period_of(spec.mill).to<double>()));
}

/// Says in words how fast the playback is; a speed of 1 is real time.
std::string pace(double speed) {
  const double factor = std::max(speed, 1 / speed);
  if (factor < 1.05) return "In real time";
  return fmt::format("{} {} times", speed > 1 ? "Sped up" : "Slowed down", plot::readable(factor, 2));
}

/// The controls, hidden until page.js plays. The slider counts milliseconds in the mill.
void add_player(pugi::xml_node section, const Animation& animation, double speed) {
  auto player = add(section, "div", {{"id", "player"}, {"hidden", "hidden"}});
  auto controls = add(player, "div", {{"class", "controls"}});
  add(controls, "button", {{"type", "button"}, {"id", "play"}}, "Play");
  add(controls, "input",
      {{"type", "range"},
       {"id", "time"},
       {"min", "0"},
       {"max", fmt::format("{}", 1000 * animation.duration * speed)},
       {"step", "any"},
       {"autocomplete", "off"},
       {"value", "0"},
       {"aria-label", "Time from the beginning of the animation"}});
  add(controls, "span", {{"id", "clock"}, {"aria-hidden", "true"}}, "0.0 ms");
  add(player, "p", {{"class", "note"}},
      pace(speed) + ". Drag to rotate, scroll to zoom; by keyboard the arrows, + and -.");
}

std::string player() {
  return fmt::format("<script>\n/* {}*/\n{}\n{}</script>\n<script>\n{}</script>\n", three_licence, three_js,
                     three_orbit_js, page_js);
}

}  // namespace

void add_animation(pugi::xml_node main, const RunFolder& run) {
  auto section = add_section(main, "animation", "The mill in motion");
  const auto* output = run.output("animation", [](const auto&) { return true; });
  if (!output) return add_missing(section, "animation", "type = \"animation\"");
  const auto animation = read_animation(run.file_of(*output));
  auto stage = add(section, "div", {{"class", "stage"}});
  add_still(stage, animation);
  if (three_js.empty()) {
    add(section, "p", {{"class", "missing"}},
        "A still picture: this edmill was built without three.js (Debian: libjs-three). The animation itself "
        "is in " +
            run.file_of(*output).filename().string() + ".");
    return;
  }
  add_frames(section, animation);
  add_player(section, animation, output->animation.speed.to<double>());
}

std::string report_page(const RunFolder& run) {
  pugi::xml_document document;
  auto main = add(document, "main");
  add_headline(main, run);
  add_warnings(main, run);
  auto pair = add(main, "div", {{"class", "pair"}});
  add_animation(pair, run);
  add_ward(pair, run);
  add_rates(main, run);
  add_spectra(main, run);
  add_vessel(main, run);
  add_treatment(main, run);
  add_ball_speeds(main, run);
  add_exponents(main, run);
  add_energy(main, run);
  add_case(main, run);
  const bool plays = static_cast<bool>(main.select_node("//div[@id='player']"));
  const auto title = std::filesystem::path(run.facts.case_file).filename().string();
  return page_of({title, subtitle_of(run), run.facts.version, run.facts.commit, document,
                  plays ? player() : "", plays ? "The animation is played by three.js (MIT licence)." : ""});
}

std::filesystem::path write_report(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) read_run_folder(folder);  // says what is missing
  const io::FolderLock alone(folder);
  // Removes what killed processes have left; an unfinished run goes on with its own files, which stay.
  if (!std::filesystem::exists(io::checkpoint_place(folder))) io::remove_temporaries(folder);
  return put_report(folder);
}

std::filesystem::path put_report(const std::filesystem::path& folder) {
  const auto page = report_page(read_run_folder(folder));
  auto place = folder / "report.html";
  io::AtomicFile file(place);
  file.stream() << page;
  file.complete();
  io::record_files(folder, file.places());
  file.commit();
  return place;
}

}  // namespace edmill::report
