// Substitutes for parts that the npm package lacks in addition to those that the core alone lacks: wide
// scalars, ball arithmetic, pages, and studies, which run on threads. Each call is refused in one sentence.
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
Certification certify(const casefile::CaseSpec&, const CertifyOptions&) { refuse("certify", mpfr); }
void require_wider(const std::string&, const std::string&, const std::string&) { refuse("--shadow", mpfr); }
Shadow shadow(const casefile::CaseSpec&, const std::string&, const std::string&, const std::atomic<bool>*) {
  refuse("--shadow", mpfr);
}
FoundDigits find_digits(const casefile::CaseSpec&, const DigitsOptions&) { refuse("--digits", mpfr); }
FoundDigits estimate_run(const casefile::CaseSpec&, const std::string&, const DigitsOptions&) {
  refuse("--estimate", mpfr);
}
Proof prove(const casefile::CaseSpec&, const ProveOptions&) { refuse("prove", arb); }
std::size_t right_events(const std::string&, const casefile::CaseSpec&, const Proof&) {
  refuse("prove", arb);
}
std::vector<std::string> check_certificate(const casefile::CaseSpec&, const std::string&) {
  refuse("prove", arb);
}
std::optional<StudyResult> sweep(const StudyOptions&) { refuse("sweep", threads); }
std::optional<StudyResult> optimize(const StudyOptions&) { refuse("optimize", threads); }
std::optional<StudyResult> seeds(const SeedsOptions&) { refuse("--seeds", threads); }
std::string limit_drawing(const dem::Limit&) { refuse("limit --draw", pages); }
Bifurcation bifurcation(const casefile::CaseSpec&, const BifurcationOptions&) {
  refuse("bifurcation", pages);
}
std::string what_decides(const casefile::CaseSpec&, const std::string&, const io::Facts&, double,
                         const std::atomic<bool>*) {
  refuse("run --check", threads);
}
}  // namespace app

namespace run {
Sensitivities sensitivity(const casefile::CaseSpec&, const SensitivityOptions&) {
  refuse("sensitivity", mpfr);
}
}  // namespace run

namespace report {
std::filesystem::path write_report(const std::filesystem::path&) { refuse("a report", pages); }
void write_comparison(const std::vector<std::string>&, const std::filesystem::path&) {
  refuse("a report", pages);
}
std::string mill_drawing(const model::Mill<double>&) { refuse("a drawing", pages); }
}  // namespace report

}  // namespace edmill
