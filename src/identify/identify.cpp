#include "identify/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <utility>

#include "audit/naming.hpp"
#include "identify/causes.hpp"
#include "identify/fit.hpp"
#include "identify/replay.hpp"
#include "identify/samples.hpp"

namespace edmill::casefile {
extern template InitialCase<double> build_case<double>(const CaseSpec&, bool);
}

namespace edmill::identify {

namespace {

constexpr std::size_t most_events = 20000;
constexpr double strong_evidence = 10;  ///< least gain of Schwarz's criterion (Kass and Raftery 1995)
constexpr double same_evidence = 2;

/// A combination of free numbers and mistakes, fitted.
struct Candidate {
  Model model;
  std::vector<std::string> mistakes;
  std::vector<double> values, half_widths;
  double criterion = 0;    ///< misfit + parameters ln(rows)
  std::uint64_t left = 0;  ///< violations

  std::size_t complexity() const { return model.free.size() + mistakes.size(); }
  std::set<std::string> names() const {
    std::set<std::string> all(mistakes.begin(), mistakes.end());
    for (const auto* p : model.free) all.insert(p->key);
    return all;
  }
};

class Search {
 public:
  Search(const casefile::CaseSpec& spec, audit::Options options)
      : nominal_(assumptions_of(spec)),
        the_case_(casefile::build_case<double>(spec).the_case),
        options_(std::move(options)) {
    from_start_ = options_.from_start;
    options_.from_start = false;
    options_.examples = 0;
    options_.progress = nullptr;
    log_ = audit::read_events(the_case_, options_, most_events);
    interrupt_ = std::exchange(options_.interrupt, nullptr);  // an audit that ends early finds nothing wrong
    parameters_ = parameters_of(nominal_);
    if (!log_.events.empty()) residuals_.emplace(log_, audit::tolerances_of(the_case_, options_), the_case_);
  }

  const audit::EventsAtHand& log() const { return log_; }
  const model::Case<double>& the_case() const { return the_case_; }

  Identification run() {
    Identification result;
    result.events = log_.events.size();
    if ((result.interrupted = is_interrupted()) || log_.events.empty()) return result;
    const auto& has = log_.available.body[0];
    if (!has.position && from_start_) {
      follow(result);
      return result;
    }
    const auto audited = audit::audit(the_case_, log_, options_);
    violations_ = result.violations = audited.findings.total();
    result.noted = audited.findings.explained();
    if (violations_ == 0) return result;
    result.too_few = std::ranges::count_if(log_.events, [](const auto& e) { return e.problem.empty(); }) < 12;
    if (result.too_few) return result;
    samples_ = Samples(log_.events, the_case_.mill.motion.period());
    note_violating(nominal_);
    samples_.choose();
    take(samples_.whole());
    if ((result.too_few = residuals_->count() < 12)) return result;
    null_ = misfit_of(nominal_);
    auto accepted = singles();
    if (accepted.empty() || accepted.front().left > 0) {
      resample(accepted);
      for (auto& pair : pairs()) accepted.push_back(std::move(pair));
      sort(accepted);
    }
    if (!(result.interrupted = is_interrupted())) report(accepted, result);
    return result;
  }

 private:
  bool is_interrupted() const { return interrupt_ && interrupt_->load(std::memory_order_relaxed); }

  /// Without places impacts cannot be checked, but a run from the case's start can follow the log.
  void follow(Identification& result) const {
    const auto found = replay(nominal_, parameters_, mistakes_of(nominal_, parameters_, log_), log_,
                              [this] { return is_interrupted(); });
    result.interrupted = is_interrupted(), result.too_few = found.too_few;
    if (result.interrupted || result.too_few) return;
    result.follows = found.without;
    result.follows_all = found.clean;
    if (!found.cause) return;
    Cause cause;
    if (const auto* p = found.cause->parameter)
      cause.values.push_back({p->key, p->dimension, found.cause->value, found.cause->half_width, p->value});
    else
      cause.mistakes.push_back(found.cause->mistake);
    cause.follows = found.cause->follows, cause.could_follow = found.cause->of;
    result.causes.push_back(std::move(cause));
  }

  std::uint64_t violations(const Assumptions& assumed) const {
    const auto built = assumed.built();
    if (!built) return std::numeric_limits<std::uint64_t>::max();
    if (assumed.log.none()) return audit::audit(*built, log_, options_).findings.total();
    audit::EventsAtHand changed = log_;
    for (auto& event : changed.events) assumed.log.apply(event);
    return audit::audit(*built, changed, options_).findings.total();
  }

  /// Notes the events that are off by more than the audit allows.
  void note_violating(const Assumptions& assumed) {
    take(samples_.every());
    const auto rows = rows_of(assumed);
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (std::abs(rows[k]) > 1) samples_.note_violating(residuals_->events()[k]);
  }
  void take(const std::vector<std::size_t>& sample) { residuals_->choose(sample); }

  // ---- misfits of what is chosen
  std::vector<double> rows_of(const Assumptions& assumed) const { return residuals_->rows(assumed); }
  double misfit_of(const Assumptions& assumed) const { return misfit(rows_of(assumed), residuals_->kinds()); }
  double penalty(std::size_t parameters) const {
    return static_cast<double>(parameters) * std::log(static_cast<double>(residuals_->count()));
  }

  // ---- fits
  /// Values to begin with, from afar where the rows are periodic in the parameter.
  std::vector<double> starts(const Assumptions& base, const Parameter& p) {
    if (!p.is_speed && !p.is_phase) {
      if (p.value != 0) return {p.value};
      return {p.value, 0.1 * p.change, p.change, 10 * p.change};
    }
    take(samples_.early());
    std::vector<std::pair<double, double>> tried;
    const auto add = [&](double value) {
      Assumptions moved = base;
      p.set(moved, value);
      tried.emplace_back(misfit_of(moved), value);
    };
    add(p.value);
    const double period = the_case_.mill.motion.period();
    if (p.is_phase) {
      for (int k = 1; k < 16; ++k) add(period * (k <= 8 ? k : k - 16) / 16);
    } else {
      const double turns =
          std::abs(log_.events[samples_.early().back()].time * p.value) / (2 * std::numbers::pi);
      const int steps = std::clamp(static_cast<int>(std::ceil(0.12 * turns * 10)), 1, 400);
      for (int k = -steps; k <= steps; ++k)
        if (k != 0) add(p.value * (1 + 0.12 * k / steps));
    }
    const double here = tried.front().second;
    std::sort(tried.begin(), tried.end());
    std::vector<double> best = {here};
    for (std::size_t k = 0; k < std::min<std::size_t>(2, tried.size()); ++k)
      if (tried[k].second != here) best.push_back(tried[k].second);
    return best;
  }

  /// Fits over growing spans where a motion's speed is free, and over the whole log.
  Candidate fitted(const Model& model, const std::vector<std::string>& mistakes,
                   const std::vector<double>& start) {
    Candidate c{model, mistakes, start, {}, 0, 0};
    const bool staged =
        std::any_of(model.free.begin(), model.free.end(), [](const auto* p) { return p->is_speed; });
    for (std::size_t w = staged ? 0 : samples_.windows().size() - 1; w < samples_.windows().size(); ++w) {
      take(samples_.windows()[w]);
      if (residuals_->count() < 12 && w + 1 < samples_.windows().size()) continue;
      auto result = fit(*residuals_, model, c.values);
      c.values = std::move(result.values), c.half_widths = std::move(result.half_widths);
      c.criterion = result.cost + penalty(model.free.size());
    }
    return c;
  }

  /// The fit with the final sample, and what the audit says of it.
  bool accept(Candidate& c) {
    take(samples_.whole());
    if (!(null_ - c.criterion >= strong_evidence)) return false;
    if (!c.model.free.empty()) {
      take(samples_.many());
      auto result = fit(*residuals_, c.model, c.values);
      c.values = std::move(result.values), c.half_widths = std::move(result.half_widths);
    }
    for (std::size_t k = 0; k < c.values.size(); ++k)
      if (!(std::abs(c.values[k] - c.model.free[k]->value) > c.half_widths[k])) return false;
    const auto assumed = c.model.with(c.values);
    c.left = violations(assumed);
    return c.left <= violations_ && audit::accounts_for(violations_ - c.left, violations_) &&
           rows_vanish(assumed);
  }

  /// Whether the rows that are off vanish when a cause is assumed.
  bool rows_vanish(const Assumptions& assumed) {
    take(samples_.many());
    const auto before = rows_of(nominal_), with = rows_of(assumed);
    std::uint64_t off = 0, vanished = 0;
    for (std::size_t k = 0; k < before.size(); ++k) {
      if (!(std::abs(before[k]) > 1)) continue;
      ++off;
      if (audit::vanishes(std::abs(before[k]), std::abs(with[k]), 1)) ++vanished;
    }
    take(samples_.whole());
    return audit::accounts_for(vanished, off);
  }

  static void sort(std::vector<Candidate>& list) {
    std::ranges::stable_sort(list, {}, &Candidate::criterion);
  }

  struct Tried {
    double misfit;
    Mistake mistake;
  };
  /// Mistakes that make the rows fit better, the best first.
  std::vector<Tried> promising(const Assumptions& base, const std::vector<Mistake>& mistakes,
                               std::size_t most) {
    take(samples_.few());
    const double before = misfit_of(base);
    std::vector<Tried> better;
    for (const auto& mistake : mistakes) {
      Assumptions assumed = base;
      mistake.make(assumed);
      const double now = misfit_of(assumed);
      if (now < before - strong_evidence) better.push_back({now, mistake});
    }
    std::ranges::stable_sort(better, {}, &Tried::misfit);
    if (better.size() > most) better.resize(most);
    return better;
  }

  Candidate with_mistakes(const Assumptions& base, const std::vector<std::string>& names) {
    take(samples_.whole());
    return {{base, {}}, names, {}, {}, misfit_of(base), 0};
  }
  static std::string name_of(const Mistake& m) { return m.key + ": " + m.text; }

  /// Rows of the first span, where a wrong speed has not gone far; of the whole log when that span shows
  /// nothing.
  std::vector<double> telling_rows(const Assumptions& base) {
    take(samples_.early());
    auto rows = rows_of(base);
    if (std::count_if(rows.begin(), rows.end(), [](double r) { return std::abs(r) > 1; }) > 12) return rows;
    take(samples_.whole());
    return rows_of(base);
  }

  /// The parameters whose fit promises most on top of a base, by a linear fit of the first span.
  std::vector<const Parameter*> ranked(const Assumptions& base, std::size_t most) {
    const auto rows = telling_rows(base);
    const auto slopes = slopes_of(*residuals_, base, parameters_);
    std::vector<std::pair<double, const Parameter*>> order;
    for (std::size_t k = 0; k < parameters_.size(); ++k) {
      if (slopes[k].empty()) continue;
      std::vector<double> change;
      order.emplace_back(linear_misfit(rows, residuals_->kinds(), {&slopes[k]}, change), &parameters_[k]);
    }
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<const Parameter*> best;
    for (std::size_t k = 0; k < order.size(); ++k)
      if (k < most || order[k].second->is_speed || order[k].second->is_phase) best.push_back(order[k].second);
    return best;
  }

  /// The best of the fits of one more number on top of a base.
  std::vector<Candidate> one_more(
      const Assumptions& base, const std::vector<std::string>& mistakes, std::size_t most,
      const std::function<bool(const Parameter&)>& free_of = [](const auto&) { return true; }) {
    std::vector<Candidate> found;
    for (const auto* p : ranked(base, most)) {
      if (is_interrupted() || !free_of(*p)) continue;
      std::vector<Candidate> of_starts;
      for (const double start : starts(base, *p)) of_starts.push_back(fitted({base, {p}}, mistakes, {start}));
      sort(of_starts);
      found.push_back(of_starts.front());
    }
    return found;
  }

  std::vector<Candidate> accepted_of(std::vector<Candidate> tried) {
    std::vector<Candidate> good;
    sort(tried);
    for (auto& c : tried)
      if (!is_interrupted() && accept(c)) good.push_back(std::move(c));
    sort(good);
    return good;
  }

  std::vector<Candidate> singles() {
    mistakes_ = mistakes_of(nominal_, parameters_, log_);
    promising_ = promising(nominal_, mistakes_, 8);
    std::vector<Candidate> tried;
    for (const auto& t : promising_) {
      Assumptions assumed = nominal_;
      t.mistake.make(assumed);
      tried.push_back(with_mistakes(assumed, {name_of(t.mistake)}));
    }
    singles_ = one_more(nominal_, {}, 6);
    for (const auto& c : singles_) tried.push_back(c);
    return accepted_of(std::move(tried));
  }

  /// New samples with the events that the best single causes leave unexplained.
  void resample(std::vector<Candidate>& accepted) {
    sort(singles_);
    samples_.forget_violating();
    const std::size_t bases = std::min<std::size_t>(2, singles_.size());
    for (std::size_t k = 0; k < bases; ++k) note_violating(singles_[k].model.with(singles_[k].values));
    if (bases == 0) note_violating(nominal_);
    samples_.choose();
    take(samples_.whole());
    null_ = misfit_of(nominal_);
    for (auto* list : {&accepted, &singles_}) {
      for (auto& c : *list) c.criterion = misfit_of(c.model.with(c.values)) + penalty(c.model.free.size());
      sort(*list);
    }
  }

  std::vector<Candidate> pairs() {
    std::vector<Candidate> tried;
    // A mistake and another one, or a number.
    for (const auto& t : promising_) {
      Assumptions base = nominal_;
      t.mistake.make(base);
      for (const auto& other : promising(base, mistakes_, 2)) {
        if (other.mistake.key == t.mistake.key || (other.mistake.of_motion && t.mistake.of_motion)) continue;
        Assumptions both = base;
        other.mistake.make(both);
        tried.push_back(with_mistakes(both, {name_of(t.mistake), name_of(other.mistake)}));
      }
      const auto free_of = [&](const Parameter& p) {
        return p.key != t.mistake.key && !(t.mistake.of_motion && p.key.starts_with("mill."));
      };
      for (auto& c : one_more(base, {name_of(t.mistake)}, 3, free_of)) tried.push_back(std::move(c));
    }
    for (auto& c : two_numbers()) tried.push_back(std::move(c));
    // A number on top of the best ones, then both together.
    for (std::size_t k = 0; k < std::min<std::size_t>(3, singles_.size()); ++k) {
      const auto& single = singles_[k];
      const auto* first = single.model.free[0];
      for (const auto* p : ranked(single.model.with(single.values), 3))
        if (p != first) tried.push_back(fitted({nominal_, {first, p}}, {}, {single.values[0], p->value}));
    }
    return accepted_of(std::move(tried));
  }

  std::vector<Candidate> two_numbers() {
    const auto rows = telling_rows(nominal_);
    const auto slopes = slopes_of(*residuals_, nominal_, parameters_);
    struct Pair {
      double misfit;
      std::size_t one, two;
      std::vector<double> start;
    };
    std::vector<Pair> order;
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      for (std::size_t j = i + 1; j < parameters_.size(); ++j) {
        if (slopes[i].empty() || slopes[j].empty()) continue;
        std::vector<double> change;
        const double left = linear_misfit(rows, residuals_->kinds(), {&slopes[i], &slopes[j]}, change);
        if (change.size() == 2) order.push_back({left, i, j, change});
      }
    std::ranges::stable_sort(order, {}, &Pair::misfit);
    std::vector<Candidate> found;
    constexpr std::size_t most = 12;
    for (std::size_t k = 0; k < std::min(most, order.size()) && !is_interrupted(); ++k) {
      const Parameter &one = parameters_[order[k].one], &two = parameters_[order[k].two];
      const Model model{nominal_, {&one, &two}};
      auto best = fitted(model, {}, {one.value, two.value});
      const auto from = [&](double a, double b) {
        auto other = fitted(model, {}, {a, b});
        if (other.criterion < best.criterion) best = std::move(other);
      };
      from(one.value + order[k].start[0] * one.change, two.value + order[k].start[1] * two.change);
      for (const auto& single : singles_) {
        if (single.model.free[0] == &one) from(single.values[0], two.value);
        if (single.model.free[0] == &two) from(one.value, single.values[0]);
      }
      found.push_back(std::move(best));
    }
    return found;
  }

  Cause cause_of(const Candidate& c) const {
    Cause cause;
    for (std::size_t k = 0; k < c.values.size(); ++k) {
      const auto& p = *c.model.free[k];
      cause.values.push_back({p.key, p.dimension, c.values[k], c.half_widths[k], p.value});
    }
    cause.mistakes = c.mistakes;
    cause.of = violations_;
    cause.explains = violations_ - std::min(violations_, c.left);
    cause.gain = null_ - c.criterion;
    return cause;
  }

  /// The best cause, and of the others those that are no worse with as few numbers.
  void report(const std::vector<Candidate>& accepted, Identification& result) const {
    if (accepted.empty()) return;
    const auto& best = accepted.front();
    Cause cause = cause_of(best);
    std::set<std::set<std::string>> told = {best.names()};  // two numbers may have been tried in either order
    for (std::size_t k = 1; k < accepted.size(); ++k)
      if (accepted[k].criterion - best.criterion < same_evidence &&
          accepted[k].complexity() <= best.complexity() && told.insert(accepted[k].names()).second)
        cause.alike.push_back(cause_of(accepted[k]).text());
    result.causes.push_back(std::move(cause));
  }

  Assumptions nominal_;
  model::Case<double> the_case_;
  audit::Options options_;
  audit::EventsAtHand log_;
  std::vector<Parameter> parameters_;
  Samples samples_;
  std::vector<Mistake> mistakes_;
  std::optional<Residuals> residuals_;
  std::vector<Tried> promising_;
  std::vector<Candidate> singles_;
  std::uint64_t violations_ = 0;
  double null_ = 0;
  const std::atomic<bool>* interrupt_ = nullptr;
  bool from_start_ = false;
};

}  // namespace

Identification identify(const casefile::CaseSpec& spec, const audit::Options& options) {
  Search search(spec, options);
  auto result = search.run();
  if (!result.interrupted) result.stepping = time_stepping(search.log(), search.the_case(), options);
  return result;
}

}  // namespace edmill::identify
