#include "identify/identify.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "identify/evidence.hpp"

namespace edmill::identify {

namespace {

constexpr std::size_t most_events = 20000, most_for_single = 4000;
constexpr double same_evidence = 2;
constexpr std::size_t most_judged = 12;  ///< hypotheses of a stage, by the whole log

/// A stage of the search: the best hypotheses of one size, each extended by one mistake, one number, or one
/// number in a part of the log. Stages without parts extend hypotheses about the whole log.
struct Stage {
  const char* name;                                     ///< null: it is reported with the stage before
  std::size_t size, bases = 1;                          ///< of the hypotheses that it extends, and how many
  std::size_t mistakes = 0, numbers = 0, in_parts = 0;  ///< tried on top of each, the most promising
  std::size_t pairs = 0;                                ///< of numbers of the case, fitted together
  double share = 0.9;  ///< of the rows violated with a base that a part must contain
};
constexpr Stage stages[] = {
    {.name = "single causes", .size = 0, .mistakes = 8, .numbers = 6},
    {.name = "causes in a part of the log", .size = 0, .in_parts = 8},
    {.name = "two causes together", .size = 1, .bases = 10, .mistakes = 2, .numbers = 5, .pairs = 12},
    {.name = "two causes, of parts of the log", .size = 0, .in_parts = 4, .share = 0.2},
    {.name = nullptr, .size = 1, .bases = 10, .in_parts = 3},
    {.name = "three causes together", .size = 2, .bases = 4, .mistakes = 2, .numbers = 3, .in_parts = 3}};

class Searcher {
 public:
  Searcher(const casefile::CaseSpec& spec, audit::Options options, Search search, Progress progress)
      : search_(search),
        progress_(std::move(progress)),
        nominal_(assumptions_of(spec)),
        the_case_(casefile::build_case<double>(spec).the_case),
        options_(std::move(options)) {
    from_start_ = options_.from_start;
    options_.from_start = false;
    options_.examples = 0;
    options_.progress = nullptr;
    log_ = audit::read_events(the_case_, options_, search == Search::all ? most_events : most_for_single);
    interrupt_ = std::exchange(options_.interrupt, nullptr);  // an audit that ends early finds nothing wrong
    numbers_ = parameters_of(nominal_);
    std::copy_if(numbers_.begin(), numbers_.end(), std::back_inserter(periodic_),
                 [](const Parameter& p) { return p.is_periodic(); });
    mistakes_ = mistakes_of(nominal_, numbers_, log_.available);
  }

  const audit::EventsAtHand& log() const { return log_; }
  const model::Case<double>& the_case() const { return the_case_; }

  Identification run() {
    Identification result;
    result.search = search_;
    result.events = log_.events.size();
    if ((result.interrupted = is_interrupted()) || log_.events.empty()) return result;
    if (!log_.available.body[0].position && from_start_ && search_ == Search::all) {
      follow(result);
      return result;
    }
    const auto audited = audit::audit(the_case_, log_, options_);
    result.violations = audited.findings.total();
    if (result.violations == 0) return result;
    result.too_few = std::count_if(log_.events.begin(), log_.events.end(),
                                   [](const auto& e) { return e.problem.empty(); }) < 12;
    if (result.too_few) return result;
    evidence_.emplace(log_, options_, the_case_, nominal_, result.violations);
    if ((result.too_few = !evidence_->suffices())) return result;
    tried_ = {{nominal_}};
    result.tried = {numbers_.size(), mistakes_.size(), evidence_->part_count(), {}};
    for (const auto& stage : stages) {
      if (!accepted_.empty() && accepted_.front().left == 0) break;
      if (search_ == Search::single && &stage != std::begin(stages)) break;
      if (stage.name) {
        result.tried.stages.push_back(stage.name);
        if (progress_) progress_(stage.name);
      }
      extend(stage);
    }
    result.interrupted = is_interrupted();
    report(result);
    return result;
  }

 private:
  bool is_interrupted() const { return interrupt_ && interrupt_->load(std::memory_order_relaxed); }

  /// Without places impacts cannot be checked, but a run from the case's start can follow the log.
  void follow(Identification& result) const {
    // A run of a case has the terms of the equations as they are.
    auto numbers = numbers_, mistakes = mistakes_;
    std::erase_if(numbers, [](const Parameter& p) { return !p.equation.empty() || !p.is_of_case(); });
    std::erase_if(mistakes, [&](const Parameter& m) { return !m.on(nominal_, 1).is_case(); });
    auto found = replay(nominal_, numbers, mistakes, log_, [this] { return is_interrupted(); });
    result.interrupted = is_interrupted();
    result.too_few = found.too_few;
    if (result.interrupted) return;
    result.follows = found.follows;
    result.follows_all = found.follows_all;
    result.causes = std::move(found.causes);
  }

  std::vector<Hypothesis> best_of_size(std::size_t size, std::size_t most, bool in_parts) const {
    std::vector<Hypothesis> best;
    std::copy_if(tried_.begin(), tried_.end(), std::back_inserter(best), [&](const Hypothesis& h) {
      return h.size() == size && (in_parts || h.assumed().restricted.empty());
    });
    sort(best);
    best.erase(best.begin() + static_cast<std::ptrdiff_t>(std::min(most, best.size())), best.end());
    return best;
  }

  void extend(const Stage& stage) {
    if (stage.pairs > 0) resample();
    std::vector<Hypothesis> more;
    for (const auto& base : best_of_size(stage.size, stage.bases, stage.in_parts > 0)) {
      const auto assumed = base.assumed();
      auto names = base.names();
      const auto add = [&](const std::vector<Parameter>& list) {
        for (const auto& p : list)
          if (!is_interrupted() && base.allows(p) && names.insert(p.name()).second)
            more.push_back(evidence_->with(base, p));
      };
      if (stage.mistakes > 0) add(evidence_->by_trial_values(assumed, mistakes_, stage.mistakes));
      if (stage.numbers > 0) add(evidence_->best_numbers(assumed, numbers_, stage.numbers));
      if (stage.in_parts > 0) add(evidence_->best_in_parts(assumed, numbers_, stage.in_parts, stage.share));
      if (stage.size == 0 && stage.numbers > 0) add(periodic_);
    }
    if (stage.pairs > 0 && !is_interrupted())
      for (auto& pair : evidence_->best_pairs(numbers_, stage.pairs)) more.push_back(std::move(pair));
    sort(more);
    tried_.insert(tried_.end(), more.begin(), more.end());
    more.resize(std::min(most_judged, more.size()), {nominal_});
    for (auto& h : more)
      if (!is_interrupted() && evidence_->accept(h)) accepted_.push_back(std::move(h));
    sort(accepted_);
  }

  /// With the events that the best single causes leave unexplained.
  void resample() {
    std::vector<Assumptions> bases;
    for (const auto& single : best_of_size(1, 2, false)) bases.push_back(single.assumed());
    if (bases.empty()) bases.push_back(nominal_);
    evidence_->draw_samples(bases);
    for (auto* list : {&accepted_, &tried_})
      for (auto& h : *list) evidence_->judge(h);
    sort(accepted_);
  }

  Cause cause_of(const Hypothesis& h) const {
    Cause cause;
    for (std::size_t k = 0; k < h.values.size(); ++k)
      cause.values.push_back({h.numbers[k], h.values[k], h.half_widths[k]});
    for (const auto& mistake : h.mistakes) cause.mistakes.push_back(mistake.name());
    cause.of = h.of;
    cause.explains = cause.of - std::min(cause.of, h.left);
    cause.gain = evidence_->score_of_case() - h.score;
    cause.others = h.others;
    return cause;
  }

  /// A further assumption must explain most of what the others leave.
  const Hypothesis& best() const {
    const auto* best = &accepted_.front();
    for (const auto& h : accepted_)
      if (h.size() < best->size() && 2 * h.of * best->left > best->of * h.left) best = &h;
    return *best;
  }

  /// The best cause, and of the others those that are no worse with as few numbers.
  void report(Identification& result) const {
    if (accepted_.empty() && !result.interrupted) report_each(result);
    if (accepted_.empty()) return;
    const auto& best = this->best();
    result.causes = {cause_of(best)};
    std::set<std::set<std::string>> reported;  // two numbers may have been tried in either order
    for (const auto& other : accepted_)
      if (other.evidence() - best.evidence() < same_evidence && other.size() <= best.size() &&
          reported.insert(other.names()).second && &other != &best)
        result.causes[0].alike.push_back(cause_of(other).text());
  }

  /// Of a log with several mistakes those that explain what they change, each other rows.
  void report_each(Identification& result) const {
    std::set<std::size_t> explained;
    const auto violating = evidence_->violating_events(nominal_).size();
    for (auto h : best_of_size(1, tried_.size(), true)) {
      auto own = evidence_->explained_by(h);
      const auto known = std::count_if(own.rows.begin(), own.rows.end(),
                                       [&](std::size_t row) { return explained.contains(row); });
      if (own.rows.empty() || 10 * static_cast<std::size_t>(known) > own.rows.size()) continue;
      h.of = violating;
      h.left = violating - own.events.size();
      result.causes.push_back(cause_of(h));
      explained.merge(own.rows);
    }
  }

  Search search_;
  Progress progress_;
  Assumptions nominal_;
  model::Case<double> the_case_;
  audit::Options options_;
  audit::EventsAtHand log_;
  std::vector<Parameter> numbers_, mistakes_;
  std::vector<Parameter> periodic_;  ///< of the numbers
  std::optional<Evidence> evidence_;
  std::vector<Hypothesis> tried_, accepted_;
  const std::atomic<bool>* interrupt_ = nullptr;
  bool from_start_ = false;
};

}  // namespace

Identification identify(const casefile::CaseSpec& spec, const audit::Options& options, Search search,
                        const Progress& progress) {
  Searcher searcher(spec, options, search, progress);
  auto result = searcher.run();
  if (!result.interrupted) result.stepping = time_stepping(searcher.log(), searcher.the_case(), options);
  // Overlaps that a cause explains need no step.
  if (!result.causes.empty() && result.causes[0].explains == result.causes[0].of)
    result.stepping.step_by_depth.reset();
  return result;
}

}  // namespace edmill::identify
