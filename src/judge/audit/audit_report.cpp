#include <fmt/format.h>
#include <fmt/ranges.h>

#include "audit/audit.hpp"
#include "base/version.hpp"

namespace edmill::audit {

namespace {

std::string describe(const Finding& f) {
  std::string text = fmt::format("line {}: t = {} s, ball {} with {} {}, off by {:.3g} {}", f.line,
      f.time, f.ball, f.with_wall ? "wall" : "ball", f.partner, f.size, info(f.kind).unit);
  if (std::isfinite(f.found)) text += fmt::format(": found {:.9g}", f.found);
  if (std::isfinite(f.expected)) text += fmt::format(", expected {:.9g}", f.expected);
  return text;
}

/// Lists the checks whose `number` is not 0: "touch (12), approach (7)".
std::string list_of_checks(const Findings& findings, auto number) {
  std::vector<std::string> list;
  for (const Check check : checks_with([&](Check c) { return std::invoke(number, findings, c); }))
    list.push_back(fmt::format("{} ({})", info(check).name, std::invoke(number, findings, check)));
  return fmt::format("{}", fmt::join(list, ", "));
}

/// Reports rounded times, if their effect exceeds the tolerance, and the unresolved checks.
std::string unresolved_checks(const Audit& a) {
  std::string out;
  const double latest = std::max(std::abs(a.first), std::abs(a.last));
  const double places = a.tolerances.wall_places(latest);
  if (places > a.tolerances.relative * a.tolerances.reach)
    out += fmt::format(
        "\n  times are known to {:.2g} s by their rounding, places of walls to {:.2g} m: the "
        "tolerances "
        "allow for it\n",
        rounding_of(latest), places);
  if (const auto list = list_of_checks(a.findings, &Findings::unresolved_number); !list.empty())
    out += fmt::format(
        "\n  could not be checked, since what is allowed is as large as what is checked: {}\n",
        list);
  return out;
}

}  // namespace

double share_of(const Audit& a, Kind kind) {
  const auto judged = a.findings.judged_number(info(kind).check);
  return judged > 0 ? static_cast<double>(a.findings.of(kind).count) / static_cast<double>(judged)
                    : unknown;
}

std::string table(const Audit& a) {
  std::string out = fmt::format(
      "{}: {} impacts, {:g} s to {:g} s{}\nchecked with {}, tolerance {:g}, gaps {:.3g} m\n",
      a.log_name, a.events, a.first, a.last, a.interrupted ? " (interrupted)" : "", a.case_name,
      a.tolerances.relative, a.tolerances.gap);
  if (a.findings.total() > 0)
    out += fmt::format(
        "\n  {:<24}{:>10}{:>9}  {:<14}{}\n", "violation", "count", "share", "worst", "meaning");
  for (const Kind kind : a.findings.ranked()) {
    const Tally& tally = a.findings.of(kind);
    out += fmt::format("  {:<24}{:>10}{:>8.3g}%  {:<14}{}\n", info(kind).name, tally.count,
        100 * share_of(a, kind), fmt::format("{:.3g} {}", tally.worst, info(kind).unit),
        info(kind).meaning);
    for (const auto& [note, count] : tally.notes)
      out += fmt::format("    {} of them: {}\n", count, note);
    for (const auto& example : tally.examples) out += fmt::format("    {}\n", describe(example));
  }
  const auto& e = a.energies;
  if (e.impacts > 0)
    out += fmt::format(
        "\n  energy of {} impacts: wall work {:.6g} J - dose {:.6g} J + supplied {:.4g} J - gained "
        "{:.6g} J "
        "= {:.2g} J\n    supplied by the least separation speed in {} of them\n",
        e.impacts, e.wall_work.value(), e.milling_dose.value(), e.supplied.value(),
        e.kinetic_change.value(), e.closure(), e.supplying);
  if (e.creating > 0)
    out += fmt::format("\n  {} impacts create energy, {:.4g} J together\n", e.creating, e.created);
  if (!a.diagnoses.empty()) out += "\n  the log looks like\n";
  for (const auto& d : a.diagnoses)
    out += fmt::format("    {} ({} of {}): {}\n", d.name, d.events, d.of, d.text);
  if (!a.not_made.empty() && a.events > 0) {
    out += "\n  not checked, since columns are missing\n";
    for (const Check check : a.not_made)
      out += fmt::format("    {:<24}needs {}\n", info(check).name, info(check).columns);
  }
  if (a.undecided > 0)
    out += fmt::format("\n  {} searches for missed impacts are undecided\n", a.undecided);
  out += unresolved_checks(a);
  const auto made = list_of_checks(a.findings, &Findings::judged_number);
  return out +
      fmt::format(
          "\n  checked{}{}\n  verdict: {}\n", made.empty() ? "" : ": ", made, name_of(a.verdict));
}

}  // namespace edmill::audit
