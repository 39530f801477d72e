#include "identify/identify.hpp"

#include "identify/fit.hpp"

namespace edmill::identify {

namespace {

constexpr std::size_t most_events = 20000, most_for_single = 4000;
constexpr double strong_evidence = 10;  ///< gain of Schwarz's criterion (Kass and Raftery 1995)
constexpr double same_evidence = 2;
constexpr std::size_t most_judged = 12;  ///< hypotheses of a stage that are audited

/// The items with the lowest misfits, best first.
template <class Item>
std::vector<Item> best_of(std::vector<std::pair<double, Item>> order, std::size_t most) {
  std::stable_sort(order.begin(), order.end(), [](auto& a, auto& b) { return a.first < b.first; });
  std::vector<Item> best;
  for (std::size_t k = 0; k < std::min(most, order.size()); ++k)
    best.push_back(std::move(order[k].second));
  return best;
}

bool is_violated(double row) { return std::abs(row) > 1; }

std::uint64_t count_violated(const VectorXd& rows) {
  return static_cast<std::uint64_t>(std::count_if(rows.begin(), rows.end(), is_violated));
}

/// Whether the effect of a number can be restricted to this part of the log.
bool fits(const Subset& part, const Assumption& p) { return p.of_impacts || part.of_flights; }

/// Whether the interval of a number contains that of the case.
bool has_number_of_case(const Hypothesis& tried) {
  return std::any_of(tried.found.begin(), tried.found.end(), [](const Found& f) {
    return f.what.is_of_case() && !(std::abs(f.value - f.what.value) > f.half_width);
  });
}

/// Assumptions that may differ in a part of the log: terms, and the numbers of each contact law.
Assumptions of_parts(const Assumptions& numbers) {
  std::set<std::string> common;
  const auto last = [](const std::string& key) { return key.substr(key.rfind('.') + 1); };
  const auto of_both = [](const std::string& key) {
    return std::count(key.begin(), key.end(), '.') == 1;
  };
  for (const auto& p : numbers)
    if (p.key.starts_with("contact.") && of_both(p.key)) common.insert(last(p.key));
  Assumptions list;
  for (const auto& p : numbers)
    if (!p.equation.empty() ||
        (p.key.starts_with("contact") && (of_both(p.key) || !common.contains(last(p.key)))))
      list.push_back(p);
  return list;
}

void sort(std::vector<Hypothesis>& list) {
  std::stable_sort(list.begin(), list.end(), [](auto& a, auto& b) { return a.rank() < b.rank(); });
}

/// The data that all hypotheses are judged by: a log, samples of it, and their rows.
class Evidence {
 public:
  /// All arguments except the_case must outlive it. @pre the log has events
  /// @param violations  number that an audit of the unmodified case finds
  Evidence(const EventsAtHand& log, const Options& options, const Case& the_case,
      const Assumed& nominal, std::uint64_t violations)
      : log_(log), options_(options), nominal_(nominal), period_(the_case.mill.motion.period()),
        residuals_(log, audit::tolerances_of(the_case, options), the_case),
        parts_(subsets_of(nominal.spec, the_case, log.events, residuals_.branches())),
        few_(residuals_, {}), many_(few_), all_(few_), violations_(violations) {
    std::vector<std::size_t> every(log_.events.size());
    std::iota(every.begin(), every.end(), std::size_t{0});
    all_ = Residuals(residuals_, every);
    draw_samples({nominal});
  }

  bool suffices() const { return whole().count() >= 12; }
  double score_of_case() const { return score_of_case_; }
  std::size_t part_count() const { return parts_.size(); }

  /// Draws new samples, half of them of events that violate a row under one of these assumptions.
  void draw_samples(const std::vector<Assumed>& bases) {
    std::set<std::size_t> violating;
    for (const auto& base : bases) violating.merge(violating_events(base));
    const auto& events = log_.events;
    const auto sample = [&](double until, std::size_t most) {
      std::vector<std::size_t> all, off;
      for (std::size_t k = 0; k < events.size() && events[k].time <= until; ++k) {
        all.push_back(k);
        if (violating.contains(k)) off.push_back(k);
      }
      if (all.size() <= most) return Residuals(residuals_, all);
      std::set<std::size_t> chosen;
      const auto choose = [&](const std::vector<std::size_t>& list, std::size_t number) {
        for (std::size_t k = 0; k < number; ++k) chosen.insert(list[k * list.size() / number]);
      };
      const std::size_t number_off = std::min(off.size(), most / 2);
      choose(off, number_off);
      choose(all, most - number_off);
      return Residuals(residuals_, {chosen.begin(), chosen.end()});
    };
    const auto known =
        std::find_if(events.begin(), events.end(), [](auto& e) { return std::isfinite(e.time); });
    const double begin = known == events.end() ? 0 : known->time, end = events.back().time;
    const double early = events[std::min<std::size_t>(79, events.size() - 1)].time - begin;
    const double span = end - begin, first = std::max(period_, early);
    windows_.clear();
    for (double window = first; window < span; window *= 4)
      windows_.push_back(sample(begin + window, 160));
    windows_.push_back(sample(end, 300));
    few_ = sample(end, 80);
    many_ = sample(end, 1500);
    early_end_ = std::min(begin + first, end);
    score_of_case_ = misfit(whole(), nominal_);
  }

  /// Computes the score from the current samples.
  void judge(Hypothesis& tried) const {
    const double rows = static_cast<double>(whole().count());
    tried.score = misfit(whole(), tried.assumed());
    for (const auto& number : fitted(tried)) tried.score += number.what.prior + std::log(rows);
  }

  /// Extends a hypothesis by an assumption and fits all of its numbers together, from the value of
  /// the case and from trial values that fit better.
  Hypothesis with(const Hypothesis& base, const Assumption& p) const {
    const auto assumed = base.assumed();
    const auto& sample = p.is_periodic() ? early() : few_;
    const double enough = misfit(sample, assumed) - strong_evidence;
    std::vector<std::pair<double, double>> better;
    for (const double value : p.trial_values(early_end_))
      if (const double now = misfit(sample, p.on(assumed, value)); now < enough)
        better.emplace_back(now, value);
    auto values = best_of(std::move(better), p.is_periodic() ? 2 : 1);
    if (p.is_of_case())
      values.insert(values.begin(), p.value);
    else if (values.empty())
      values = {p.first_values.front()};
    std::vector<Hypothesis> tried;
    for (const double start : values) tried.emplace_back(base).add(p, start);
    return best_fitted(std::move(tried));
  }

  /// Fits with the final sample and audits with the result. @return whether it is accepted
  bool accept(Hypothesis& tried) const {
    if (!(score_of_case_ - tried.score >= strong_evidence)) return false;
    if (vanished(whole(), tried.assumed()) < 0.5)
      return false;  // the final fit cannot make up for that
    tried.plainness = 0;
    if (!fitted(tried).empty()) fit(many_, tried);
    for (auto& number : fitted(tried))
      if (number.what.dimension == Dimension::time)  // times are rounded
        number.half_width += 1e-15 * std::abs(log_.events.back().time);
    if (has_number_of_case(tried)) return false;
    for (auto& number : fitted(tried)) {
      const bool is_factor = !number.what.equation.empty() && number.what.value == 1;
      if (is_factor && !word_for(number.value, number.half_width).empty()) tried.plainness += 3;
      widen(tried, number);
    }
    count_violations(tried);
    return tried.left <= tried.of && audit::accounts_for(tried.of - tried.left, tried.of) &&
        10 * vanished(many_, tried.assumed()) >= 9;
  }

  struct Explained {
    std::set<std::size_t> rows{}, events{};
  };
  /// Rows explained by one of several mistakes; none unless nine tenths of those it changes.
  Explained explained_by(const Hypothesis& tried) const {
    if (!(score_of_case_ - tried.score >= strong_evidence) || has_number_of_case(tried)) return {};
    const VectorXd before = all_.rows(nominal_), with = all_.rows(tried.assumed());
    // Rows of a kind that stay violated may have another mistake, if none of the kind is explained.
    std::array<std::uint64_t, audit::row_kinds> vanished{}, left{};
    std::uint64_t contradicting = 0;
    Explained explained;
    for (std::size_t k = 0; k < all_.count(); ++k) {
      if (!is_violated(with[k] - before[k])) continue;
      const auto& row = all_.of_case()[k];
      const auto kind = static_cast<std::size_t>(row.kind);
      if (!is_violated(before[k])) {
        ++contradicting;
      } else if (!audit::vanishes(std::abs(before[k]), std::abs(with[k]), 1)) {
        ++left[kind];
      } else {
        ++vanished[kind];
        explained.rows.insert(k);
        explained.events.insert(row.at.event);
      }
    }
    for (std::size_t kind = 0; kind < audit::row_kinds; ++kind)
      if (vanished[kind] > 0) contradicting += left[kind];
    constexpr std::size_t least_events = 5;  // a number fits one or two by chance
    const auto rows = explained.rows.size();
    return audit::accounts_for(rows, rows + contradicting) &&
            explained.events.size() >= least_events
        ? explained
        : Explained{};
  }

  std::set<std::size_t> violating_events(const Assumed& assumed) const {
    const VectorXd rows = all_.rows(assumed);
    std::set<std::size_t> events;
    for (std::size_t k = 0; k < all_.count(); ++k)
      if (is_violated(rows[k])) events.insert(all_.of_case()[k].at.event);
    return events;
  }

  /// Assumptions that improve the fit on top of `base` with one of their trial values, best first.
  /// This finds mistakes, and numbers that matter only far from their nominal value.
  Assumptions by_trials(const Assumed& base, const Assumptions& list, std::size_t most) const {
    const double enough = misfit(few_, base) - strong_evidence;
    std::vector<std::pair<double, Assumption>> order;
    for (const auto& p : list) {
      if (p.is_periodic()) continue;  // has too many trial values
      double least = enough;
      for (const double value : p.trial_values(early_end_))
        least = std::min(least, misfit(few_, p.on(base, value)));
      if (least < enough) order.emplace_back(least, p);
    }
    return best_of(std::move(order), most);
  }

  /// Numbers by how much they should improve `base`: by a linear fit of the rows and trial values.
  Assumptions best_numbers(const Assumed& base, const Assumptions& list, std::size_t most) const {
    // In the first span a wrong speed has little effect yet.
    const auto& sample = count_violated(early().rows(base)) > 12 ? early() : whole();
    auto best = by_sensitivity(sample, base, list, {}, most);
    for (auto& p : by_trials(base, list, most / 2)) best.push_back(std::move(p));
    return best;
  }

  /// Numbers by how much they should improve `base` in a part with this share of violated rows.
  Assumptions best_in_parts(
      const Assumed& base, const Assumptions& numbers, std::size_t most, double share) const {
    const VectorXd rows = whole().rows(base);
    std::vector<SharedSubset> parts;
    for (const auto& part : parts_) {
      std::uint64_t inside = 0;
      for (std::size_t k = 0; k < whole().count(); ++k)
        if (is_violated(rows[k]) && part->contains(whole().of_case()[k].at)) ++inside;
      if (static_cast<double>(inside) > share * static_cast<double>(count_violated(rows)))
        parts.push_back(part);
    }
    if (parts.empty()) return {};
    const auto of_these = of_parts(numbers);
    auto best = by_sensitivity(whole(), base, of_these, parts, most);
    Assumptions restricted;
    for (const auto& p : by_trials(base, of_these, 4))
      for (const auto& part : parts)
        if (fits(*part, p)) restricted.push_back(in_part(part, p));
    for (auto& p : by_trials(base, restricted, most / 2)) best.push_back(std::move(p));
    return best;
  }
 private:
  Assumption in_part(const SharedSubset& part, const Assumption& p) const {
    return restricted_to(part, p, parts_.size());
  }
  const Residuals& early() const { return windows_.front(); }
  const Residuals& whole() const { return windows_.back(); }

  /// Numbers ranked by a linear fit of the rows, or of those in parts without all of their effect.
  Assumptions by_sensitivity(const Residuals& sample, const Assumed& base,
      const Assumptions& numbers, const std::vector<SharedSubset>& parts, std::size_t most) const {
    const VectorXd rows = sample.rows(base);
    std::vector<std::pair<double, Assumption>> order;
    for (const auto& p : numbers) {
      const VectorXd slope = sensitivity(sample, base, rows, p);
      if (slope.size() == 0) continue;
      if (parts.empty()) order.emplace_back(linear_misfit(sample, rows, slope), p);
      for (const auto& part : parts) {
        if (!fits(*part, p)) continue;
        VectorXd inside = slope;
        for (std::size_t k = 0; k < sample.count(); ++k)
          if (!part->contains(sample.of_case()[k].at)) inside[k] = 0;
        if (inside == slope || inside.isZero(0)) continue;
        order.emplace_back(linear_misfit(sample, rows, inside), in_part(part, p));
      }
    }
    return best_of(std::move(order), most);
  }

  /// Fits hypotheses with several starting values, over growing spans if with a speed. @return the
  /// best
  Hypothesis best_fitted(std::vector<Hypothesis> list) const {
    for (auto& tried : list) {
      const bool from_early = std::any_of(
          tried.found.begin(), tried.found.end(), [](const Found& f) { return f.what.is_speed; });
      for (const auto& window : windows_) {
        const bool last = &window == &whole();
        if (!fitted(tried).empty() && (last || (from_early && window.count() >= 12)))
          fit(window, tried);
      }
      judge(tried);
    }
    sort(list);
    return std::move(list.front());
  }

  /// Extends the interval of a number to zero if zero fits as well: it has only an upper bound.
  void widen(const Hypothesis& tried, Found& number) const {
    if (number.what.value == 0 || number.value == 0) return;
    const double found = misfit(many_, tried.assumed()), value = std::exchange(number.value, 0);
    if (misfit(many_, tried.assumed()) <= found + 1)
      number.half_width = std::max(number.half_width, std::abs(value));
    number.value = value;
  }

  /// Fraction of the violated rows of a sample that a cause explains.
  double vanished(const Residuals& sample, const Assumed& assumed) const {
    const VectorXd before = sample.rows(nominal_), with = sample.rows(assumed);
    std::uint64_t violated = 0, vanished = 0;
    for (std::size_t k = 0; k < sample.count(); ++k) {
      if (!is_violated(before[k])) continue;
      ++violated;
      if (audit::vanishes(std::abs(before[k]), std::abs(with[k]), 1)) ++vanished;
    }
    return violated > 0 ? static_cast<double>(vanished) / static_cast<double>(violated) : 0;
  }

  /// Counts the violations of an audit, or of events if no case can express all.
  void count_violations(Hypothesis& tried) const {
    const auto assumed = tried.assumed();
    tried.of = violations_;
    tried.others.clear();
    if (!assumed.is_case()) {
      tried.of = violating_events(nominal_).size();
      tried.left = violating_events(assumed).size();
      return;
    }
    tried.left = std::numeric_limits<std::uint64_t>::max();
    if (const auto built = assumed.built()) {
      EventsAtHand changed = log_;
      for (auto& event : changed.events) assumed.log.apply(event, built->mill);
      const auto found = audit::audit(*built, changed, options_).findings;
      tried.left = found.total();
      for (const auto kind : found.ranked())
        tried.others += (tried.others.empty() ? "" : ", ") + std::string(audit::info(kind).name);
    }
  }

  const EventsAtHand& log_;
  const Options& options_;
  const Assumed& nominal_;
  double period_;  ///< of the drive [s]
  LogResiduals residuals_;
  std::vector<SharedSubset> parts_;
  /// Samples of growing spans, up to the whole log: a motion's speed is fitted from the first on.
  std::vector<Residuals> windows_;
  Residuals few_, many_;  ///< of the whole log: for trials, and for a last fit
  Residuals all_;         ///< of every event
  double early_end_ = 0;  ///< [s]
  std::uint64_t violations_;
  double score_of_case_ = 0;
};

/// A stage of the search: the best hypotheses of one size, each extended by one mistake, one
/// number, or one number in a part of the log. Stages without parts extend hypotheses about the
/// whole log. With these bounds of its time verification/plain/faults_test.py finds its faults.
struct Stage {
  const char* name;             ///< null: reported with the previous stage
  std::size_t size, bases = 1;  ///< size and number of the hypotheses that it extends
  std::size_t mistakes = 0, numbers = 0, in_parts = 0;  ///< how many are tried with each hypothesis
  double share = 0.9;  ///< of the violated rows that a part must contain
};
constexpr Stage stages[] = {{.name = "single causes", .size = 0, .mistakes = 8, .numbers = 6},
    {.name = "causes in a part of the log", .size = 0, .in_parts = 8},
    {.name = "two causes together", .size = 1, .bases = 10, .mistakes = 2, .numbers = 5},
    {.name = "two causes, of parts of the log", .size = 0, .in_parts = 4, .share = 0.2},
    {.name = nullptr, .size = 1, .bases = 10, .in_parts = 3},
    {.name = "three causes together",
        .size = 2,
        .bases = 4,
        .mistakes = 2,
        .numbers = 3,
        .in_parts = 3}};

class Searcher {
 public:
  Searcher(const CaseSpec& spec, Options options, Search search, Progress progress)
      : search_(search), progress_(std::move(progress)), nominal_(assumed_of(spec)),
        the_case_(casefile::build_case<double>(spec).the_case), options_(std::move(options)) {
    options_.examples = 0;
    options_.progress = nullptr;
    log_ = audit::read_events(
        the_case_, options_, search == Search::all ? most_events : most_for_single);
    interrupt_ = std::exchange(options_.interrupt, nullptr);  // audits must not end early
    numbers_ = numbers_of(nominal_);
    mistakes_ = mistakes_of(nominal_, numbers_, log_.available);
  }

  Identification run() {
    Identification result;
    find_causes(result);
    if (!result.interrupted) result.stepping = time_stepping(log_, the_case_, options_);
    // If the cause explains all violations, overlaps do not indicate a time step.
    if (!result.causes.empty() && result.causes[0].explains == result.causes[0].of)
      result.stepping.step_by_depth.reset();
    return result;
  }
 private:
  void find_causes(Identification& result) {
    result.search = search_;
    result.events = log_.events.size();
    if ((result.interrupted = is_interrupted()) || log_.events.empty()) return;
    if (!log_.available.body[0].position && options_.from_start && search_ == Search::all)
      return follow(result);
    const auto audited = audit::audit(the_case_, log_, options_);
    result.violations = audited.findings.total();
    if (result.violations == 0) return;
    const auto is_good = [](auto& e) { return e.problem.empty(); };
    result.too_few = std::count_if(log_.events.begin(), log_.events.end(), is_good) < 12;
    if (result.too_few) return;
    evidence_.emplace(log_, options_, the_case_, nominal_, result.violations);
    if ((result.too_few = !evidence_->suffices())) return;
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
  }

  bool is_interrupted() const { return interrupt_ && interrupt_->load(std::memory_order_relaxed); }

  /// Replays the log: impacts without positions are compared with a run from the initial state.
  void follow(Identification& result) const {
    // Runs cannot vary the terms of the equations.
    auto all = mistakes_;
    all.insert(all.end(), numbers_.begin(), numbers_.end());
    std::erase_if(all, [&](const Assumption& a) {
      return a.is_fitted() ? !a.equation.empty() || !a.is_of_case() : !a.on(nominal_, 1).is_case();
    });
    auto found = replay(nominal_, all, log_, [this] { return is_interrupted(); });
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
    if (stage.size == 1 && stage.name) resample();
    std::vector<Hypothesis> more;
    for (const auto& base : best_of_size(stage.size, stage.bases, stage.in_parts > 0)) {
      const auto assumed = base.assumed();
      auto names = base.names();
      const auto add = [&](const Assumptions& list) {
        for (const auto& p : list)
          if (!is_interrupted() && base.allows(p) && names.insert(p.name()).second)
            more.push_back(evidence_->with(base, p));
      };
      if (stage.mistakes > 0) add(evidence_->by_trials(assumed, mistakes_, stage.mistakes));
      if (stage.numbers > 0) add(evidence_->best_numbers(assumed, numbers_, stage.numbers));
      if (stage.in_parts > 0)
        add(evidence_->best_in_parts(assumed, numbers_, stage.in_parts, stage.share));
      if (stage.size == 0 && stage.numbers > 0)
        for (const auto& p : numbers_)
          if (p.is_periodic()) add({p});
    }
    sort(more);
    tried_.insert(tried_.end(), more.begin(), more.end());
    more.resize(std::min(most_judged, more.size()), {nominal_});
    for (auto& h : more)
      if (!is_interrupted() && evidence_->accept(h)) accepted_.push_back(std::move(h));
    sort(accepted_);
  }

  /// Draws new samples, with the events that the best single causes leave unexplained.
  void resample() {
    std::vector<Assumed> bases;
    for (const auto& single : best_of_size(1, 2, false)) bases.push_back(single.assumed());
    if (bases.empty()) bases.push_back(nominal_);
    evidence_->draw_samples(bases);
    for (auto* list : {&accepted_, &tried_})
      for (auto& h : *list) evidence_->judge(h);
    sort(accepted_);
  }

  Cause cause_of(const Hypothesis& h) const {
    return {.found = h.found,
        .explains = h.of - std::min(h.of, h.left),
        .of = h.of,
        .others = h.others,
        .gain = evidence_->score_of_case() - h.score};
  }

  /// The best accepted hypothesis. A larger one must explain half of what a smaller one leaves.
  const Hypothesis& best() const {
    const auto* best = &accepted_.front();
    for (const auto& h : accepted_)
      if (h.size() < best->size() && 2 * h.of * best->left > best->of * h.left) best = &h;
    return *best;
  }

  /// Reports the best cause, and as alternatives those that are as good with as few assumptions.
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

  /// For several mistakes: reports those that explain what they change and no other explains.
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
  Assumed nominal_;
  Case the_case_;
  Options options_;
  EventsAtHand log_;
  Assumptions numbers_, mistakes_;
  std::optional<Evidence> evidence_;
  std::vector<Hypothesis> tried_, accepted_;
  const std::atomic<bool>* interrupt_ = nullptr;
};

}  // namespace

Identification identify(
    const CaseSpec& spec, const Options& options, Search search, const Progress& progress) {
  return Searcher(spec, options, search, progress).run();
}

}  // namespace edmill::identify
