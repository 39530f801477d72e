// Substitutes for what the npm package lacks besides what the core alone lacks: wide scalars, ball
// arithmetic, pages, and studies, which run on threads. Each call is refused in one sentence.
#include "app/certify.hpp"
#include "app/judge.hpp"
#include "app/study.hpp"
#include "core_alone/missing_part.hpp"
#include "report/report_page.hpp"
#include "run/sensitivity.hpp"

namespace edmill {

namespace {
constexpr const char *mpfr = "MPFR", *arb = "Arb", *pages = "pugixml", *threads = "threads";
}  // namespace

namespace app {
using casefile::CaseSpec;
using Text = const std::string&;
using Flag = const std::atomic<bool>*;

Evidence certify(const CaseSpec&, const Options&) { refuse("certify", mpfr); }
void require_wider(Text, Text, Text) { refuse("--shadow", mpfr); }
Evidence shadow(const CaseSpec&, Text, Text, Flag) { refuse("--shadow", mpfr); }
Evidence find_digits(const CaseSpec&, const Options&) { refuse("--digits", mpfr); }
Evidence estimate_run(const CaseSpec&, Text, const Options&) { refuse("--estimate", mpfr); }
Proof prove(const CaseSpec&, const Options&) { refuse("prove", arb); }
std::size_t right_events(Text, const CaseSpec&, const Proof&) { refuse("prove", arb); }
std::vector<std::string> check_certificate(const CaseSpec&, Text) { refuse("prove", arb); }
std::optional<StudyResult> sweep(const StudyOptions&) { refuse("sweep", threads); }
std::optional<StudyResult> optimize(const StudyOptions&) { refuse("optimize", threads); }
std::optional<StudyResult> seeds(const SeedsOptions&) { refuse("--seeds", threads); }
std::string limit_drawing(const dem::Limit&) { refuse("limit --draw", pages); }
Bifurcation bifurcation(const CaseSpec&, const BifurcationOptions&) {
  refuse("bifurcation", pages);
}
std::string what_decides(const CaseSpec&, Text, const io::Facts&, double, Flag) {
  refuse("run --check", threads);
}
}  // namespace app

namespace run {
Sensitivities sensitivity(const casefile::CaseSpec&, const SensitivityOptions&) {
  refuse("sensitivity", mpfr);
}
}  // namespace run

namespace report {
using Folder = const std::filesystem::path&;
std::filesystem::path write_report(Folder) { refuse("a report", pages); }
void write_comparison(const std::vector<std::string>&, Folder) { refuse("a report", pages); }
std::string mill_drawing(const model::Mill<double>&) { refuse("a drawing", pages); }
}  // namespace report

}  // namespace edmill
