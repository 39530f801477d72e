#include "identify/identify.hpp"

#include <algorithm>
#include <deque>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "identify/candidates.hpp"

namespace edmill::identify {

namespace {

constexpr std::size_t most_events = 20000;
constexpr double same_evidence = 2;

std::string name_of(const Mistake& m) { return m.key + ": " + m.text; }

/// The first of a list, at most so many.
template <class Item>
std::span<const Item> first_of(const std::vector<Item>& list, std::size_t most) {
  return std::span(list).first(std::min(most, list.size()));
}

class Search {
 public:
  Search(const casefile::CaseSpec& spec, audit::Options options, Progress told)
      : told_(std::move(told)),
        nominal_(assumptions_of(spec)),
        the_case_(casefile::build_case<double>(spec).the_case),
        options_(std::move(options)) {
    from_start_ = options_.from_start;
    options_.from_start = false;
    options_.examples = 0;
    options_.progress = nullptr;
    log_ = audit::read_events(the_case_, options_, most_events);
    interrupt_ = std::exchange(options_.interrupt, nullptr);  // an audit that ends early finds nothing wrong
    parameters_ = parameters_of(nominal_);
  }

  const audit::EventsAtHand& log() const { return log_; }
  const model::Case<double>& the_case() const { return the_case_; }

  Identification run() {
    Identification result;
    result.events = log_.events.size();
    if ((result.interrupted = is_interrupted()) || log_.events.empty()) return result;
    if (!log_.available.body[0].position && from_start_) {
      follow(result);
      return result;
    }
    const auto audited = audit::audit(the_case_, log_, options_);
    result.violations = audited.findings.total();
    result.noted = audited.findings.explained();
    if (result.violations == 0) return result;
    result.too_few = std::count_if(log_.events.begin(), log_.events.end(),
                                   [](const auto& e) { return e.problem.empty(); }) < 12;
    if (result.too_few) return result;
    candidates_.emplace(log_, options_, the_case_, nominal_, result.violations);
    if ((result.too_few = !candidates_->suffice())) return result;
    tell("single causes");
    auto accepted = singles();
    const auto explained = [&] { return !accepted.empty() && accepted.front().left == 0; };
    const auto search = [&](const char* what, std::vector<Candidate> (Search::*more)()) {
      if (explained()) return;
      tell(what);
      for (auto& c : (this->*more)()) accepted.push_back(std::move(c));
      sort(accepted);
    };
    search("causes in a part of the log", &Search::in_parts);
    if (!explained()) resample(accepted);
    search("two causes together", &Search::pairs);
    search("two causes, of parts of the log", &Search::pairs_in_parts);
    search("three causes together", &Search::threes);
    result.tried = {parameters_.size(), mistakes_.size(), candidates_->part_count(), stages_};
    result.interrupted = is_interrupted();
    report(accepted, result);
    return result;
  }

 private:
  void tell(const char* what) {
    stages_.push_back(what);
    if (told_) told_(what);
  }

  bool is_interrupted() const { return interrupt_ && interrupt_->load(std::memory_order_relaxed); }

  /// Without places impacts cannot be checked, but a run from the case's start can follow the log.
  void follow(Identification& result) const {
    // A run of a case has the terms of the equations as they are.
    std::vector<Parameter> numbers;
    for (const auto& p : parameters_)
      if (p.equation.empty() && p.is_of_case()) numbers.push_back(p);
    auto mistakes = mistakes_of(nominal_, numbers, log_.available);
    std::erase_if(mistakes, [&](const Mistake& m) { return !m.on(nominal_).is_case(); });
    auto found = replay(nominal_, numbers, mistakes, log_, [this] { return is_interrupted(); });
    result.interrupted = is_interrupted();
    result.too_few = found.too_few;
    if (result.interrupted) return;
    result.follows = found.follows;
    result.follows_all = found.follows_all;
    result.causes = std::move(found.causes);
  }

  /// The best of the fits of one more number on top of a base.
  std::vector<Candidate> one_more(
      const Candidate& base, std::size_t most,
      const std::function<bool(const Parameter&)>& free_of = [](const auto&) { return true; }) {
    std::vector<Candidate> found;
    for (const auto* p : candidates_->ranked(base.assumed(), parameters_, most))
      if (!is_interrupted() && free_of(*p)) found.push_back(with_one_more(base, *p));
    return found;
  }

  std::vector<Candidate> accepted_of(std::vector<Candidate> tried) {
    std::vector<Candidate> good;
    sort(tried);
    for (auto& c : tried)
      if (!is_interrupted() && candidates_->accept(c)) good.push_back(std::move(c));
    sort(good);
    return good;
  }

  std::vector<Candidate> singles() {
    mistakes_ = mistakes_of(nominal_, parameters_, log_.available);
    promising_ = candidates_->promising(nominal_, mistakes_, 8);
    std::vector<Candidate> tried;
    for (const auto& t : promising_) tried.push_back(with(t.mistake));
    singles_ = one_more(none(), 6);
    tried.insert(tried.end(), singles_.begin(), singles_.end());
    return accepted_of(std::move(tried));
  }

  /// One number or term more, in a part of the log where that share of what is off lies.
  std::vector<Candidate> one_more_in_parts(const Candidate& base, std::size_t most, double share) {
    std::vector<Candidate> found;
    for (auto& p : candidates_->ranked_in_parts(base.assumed(), parameters_, most, share)) {
      if (is_interrupted()) break;
      found.push_back(with_one_more(base, restricted_.emplace_back(std::move(p))));
    }
    return found;
  }

  /// One more number, fitted together with those of a candidate.
  Candidate with_one_more(const Candidate& base, const Parameter& p) const {
    Model model = base.model;
    model.free.push_back(&p);
    std::vector<Candidate> of_starts;
    for (const double start : candidates_->starts(base.assumed(), p)) {
      auto values = base.values;
      values.push_back(start);
      of_starts.push_back(candidates_->fitted(model, base.mistakes, values));
    }
    sort(of_starts);
    return of_starts.front();
  }

  std::vector<Candidate> in_parts() { return accepted_of(one_more_in_parts(none(), 8, 0.9)); }
  Candidate none() const { return {{nominal_, {}}, {}, {}, {}}; }
  Candidate with(const Mistake& mistake) const {
    return candidates_->with_mistakes(mistake.on(nominal_), {name_of(mistake)});
  }

  /// A cause in a part of the log on top of another one, which may be in a part itself.
  std::vector<Candidate> pairs_in_parts() {
    const auto best = first_of(singles_, 3);
    std::vector<Candidate> bases(best.begin(), best.end());
    auto some = one_more_in_parts(none(), 4, 0.2);
    sort(some);
    for (auto& c : some) bases.push_back(std::move(c));
    for (const auto& t : first_of(promising_, 2)) bases.push_back(with(t.mistake));
    std::vector<Candidate> tried;
    for (const auto& base : bases)
      for (auto& c : one_more_in_parts(base, 3, 0.9)) tried.push_back(std::move(c));
    pairs_.insert(pairs_.end(), tried.begin(), tried.end());
    return accepted_of(std::move(tried));
  }

  /// One more number or mistake on top of the best pairs.
  std::vector<Candidate> threes() {
    sort(pairs_);
    std::vector<Candidate> tried;
    for (const auto& base : first_of(pairs_, 4)) {
      const auto names = base.names();
      for (const auto* p : candidates_->ranked(base.assumed(), parameters_, 3))
        if (!is_interrupted() && !names.contains(p->key)) tried.push_back(with_one_more(base, *p));
      for (auto& c : one_more_in_parts(base, 3, 0.9)) tried.push_back(std::move(c));
      for (const auto& t : candidates_->promising(base.assumed(), mistakes_, 2)) {
        if (names.contains(name_of(t.mistake))) continue;
        Candidate c = base;
        t.mistake.make(c.model.base);
        c.mistakes.push_back(name_of(t.mistake));
        tried.push_back(candidates_->fitted(c.model, c.mistakes, c.values));
      }
    }
    return accepted_of(std::move(tried));
  }

  /// New samples with the events that the best single causes leave unexplained.
  void resample(std::vector<Candidate>& accepted) {
    sort(singles_);
    std::vector<Assumptions> bases;
    for (const auto& c : first_of(singles_, 2)) bases.push_back(c.assumed());
    if (bases.empty()) bases.push_back(nominal_);
    candidates_->draw_samples(bases);
    for (auto* list : {&accepted, &singles_}) {
      for (auto& c : *list) candidates_->judge(c);
      sort(*list);
    }
  }

  std::vector<Candidate> pairs() {
    std::vector<Candidate> tried;
    // A mistake and another one, or a number.
    for (const auto& t : promising_) {
      const Assumptions base = t.mistake.on(nominal_);
      for (const auto& other : candidates_->promising(base, mistakes_, 2)) {
        if (other.mistake.key == t.mistake.key || (other.mistake.of_motion && t.mistake.of_motion)) continue;
        tried.push_back(
            candidates_->with_mistakes(other.mistake.on(base), {name_of(t.mistake), name_of(other.mistake)}));
      }
      const auto free_of = [&](const Parameter& p) {
        return p.key != t.mistake.key && !(t.mistake.of_motion && p.key.starts_with("mill."));
      };
      const Candidate mistaken{{base, {}}, {name_of(t.mistake)}, {}, {}};
      for (auto& c : one_more(mistaken, 3, free_of)) tried.push_back(std::move(c));
    }
    for (auto& c : two_numbers()) tried.push_back(std::move(c));
    // A number on top of the best ones, then both together.
    for (const auto& single : first_of(singles_, 3)) {
      const auto* first = single.model.free[0];
      for (const auto* p : candidates_->ranked(single.assumed(), parameters_, 3))
        if (p != first) {
          const double start = p->is_of_case() ? p->value : candidates_->starts(single.assumed(), *p).front();
          tried.push_back(candidates_->fitted({nominal_, {first, p}}, {}, {single.values[0], start}));
        }
    }
    pairs_ = tried;
    return accepted_of(std::move(tried));
  }

  std::vector<Candidate> two_numbers() {
    const auto order = candidates_->ranked_pairs(parameters_);
    std::vector<Candidate> found;
    for (const auto& pair : first_of(order, 12)) {
      if (is_interrupted()) break;
      const Parameter &one = parameters_[pair.one], &two = parameters_[pair.two];
      const Model model{nominal_, {&one, &two}};
      auto best = candidates_->fitted(model, {}, {one.value, two.value});
      const auto from = [&](double a, double b) {
        auto other = candidates_->fitted(model, {}, {a, b});
        if (other.criterion < best.criterion) best = std::move(other);
      };
      from(one.value + pair.start[0] * one.change, two.value + pair.start[1] * two.change);
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
      cause.values.push_back({.key = p.key,
                              .dimension = p.dimension,
                              .value = c.values[k],
                              .half_width = c.half_widths[k],
                              .nominal = p.value,
                              .equation = p.equation,
                              .in_place_of = p.in_place_of});
    }
    cause.mistakes = c.mistakes;
    cause.of = c.of;
    cause.explains = cause.of - std::min(cause.of, c.left);
    cause.gain = candidates_->without() - c.criterion;
    return cause;
  }

  /// The best cause, and of the others those that are no worse with as few numbers.
  void report(const std::vector<Candidate>& accepted, Identification& result) const {
    if (accepted.empty()) return;
    const auto& best = accepted.front();
    Cause cause = cause_of(best);
    std::set<std::set<std::string>> told = {best.names()};  // two numbers may have been tried in either order
    for (std::size_t k = 1; k < accepted.size(); ++k)
      if (accepted[k].evidence() - best.evidence() < same_evidence &&
          accepted[k].complexity() <= best.complexity() && told.insert(accepted[k].names()).second)
        cause.alike.push_back(cause_of(accepted[k]).text());
    result.causes.push_back(std::move(cause));
  }

  Progress told_;
  std::vector<std::string> stages_;
  Assumptions nominal_;
  model::Case<double> the_case_;
  audit::Options options_;
  audit::EventsAtHand log_;
  std::vector<Parameter> parameters_;
  std::vector<Mistake> mistakes_;
  std::optional<Candidates> candidates_;
  std::vector<Tried> promising_;
  std::vector<Candidate> singles_, pairs_;
  std::deque<Parameter> restricted_;  ///< which candidates point to
  const std::atomic<bool>* interrupt_ = nullptr;
  bool from_start_ = false;
};

}  // namespace

Identification identify(const casefile::CaseSpec& spec, const audit::Options& options,
                        const Progress& progress) {
  Search search(spec, options, progress);
  auto result = search.run();
  if (!result.interrupted) result.stepping = time_stepping(search.log(), search.the_case(), options);
  return result;
}

}  // namespace edmill::identify
