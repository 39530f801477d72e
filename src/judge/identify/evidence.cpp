#include "identify/evidence.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace edmill::identify {

namespace {

/// The items of the least misfits, the best first.
template <class Item>
std::vector<Item> best_of(std::vector<std::pair<double, Item>> order, std::size_t most) {
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Item> best;
  for (std::size_t k = 0; k < std::min(most, order.size()); ++k) best.push_back(std::move(order[k].second));
  return best;
}

bool is_violated(double row) { return std::abs(row) > 1; }

std::uint64_t count_violated(const std::vector<double>& rows) {
  return static_cast<std::uint64_t>(std::count_if(rows.begin(), rows.end(), is_violated));
}

/// Whether the effect of a number can be restricted to this part of the log.
bool fits(const Subset& part, const Parameter& p) {
  return (part.of_impacts && p.of_impacts) || (part.of_flights && p.of_flights);
}

/// Whether the interval of a number contains that of the case.
bool has_number_of_case(const Hypothesis& tried) {
  for (std::size_t k = 0; k < tried.numbers.size(); ++k) {
    const auto& p = tried.numbers[k];
    if (p.is_of_case() && !(std::abs(tried.values[k] - p.value) > tried.half_widths[k])) return true;
  }
  return false;
}

/// Terms, and numbers of the contact law; where both kinds of contact have one law, its numbers once.
std::vector<Parameter> of_parts(const std::vector<Parameter>& numbers) {
  std::set<std::string> common;
  const auto last = [](const std::string& key) { return key.substr(key.rfind('.') + 1); };
  const auto of_both = [](const std::string& key) { return std::count(key.begin(), key.end(), '.') == 1; };
  for (const auto& p : numbers)
    if (p.key.starts_with("contact.") && of_both(p.key)) common.insert(last(p.key));
  std::vector<Parameter> list;
  for (const auto& p : numbers)
    if (!p.equation.empty() ||
        (p.key.starts_with("contact") && (of_both(p.key) || !common.contains(last(p.key)))))
      list.push_back(p);
  return list;
}

}  // namespace

void sort(std::vector<Hypothesis>& list) {
  std::stable_sort(list.begin(), list.end(),
                   [](const auto& a, const auto& b) { return a.rank() < b.rank(); });
}

Evidence::Evidence(const audit::EventsAtHand& log, const audit::Options& options,
                   const model::Case<double>& the_case, const Assumptions& nominal, std::uint64_t violations)
    : log_(log),
      options_(options),
      nominal_(nominal),
      period_(the_case.mill.motion.period()),
      residuals_(log, audit::tolerances_of(the_case, options), the_case),
      parts_(subsets_of(nominal.spec, the_case, log.events, residuals_.branches())),
      few_(residuals_.on({})),
      many_(few_),
      all_(few_),
      violations_(violations) {
  std::vector<std::size_t> every(log_.events.size());
  std::iota(every.begin(), every.end(), std::size_t{0});
  all_ = residuals_.on(every);
  draw_samples({nominal});
}

void Evidence::draw_samples(const std::vector<Assumptions>& bases) {
  std::set<std::size_t> violating;
  for (const auto& base : bases) violating.merge(violating_events(base));
  const auto& events = log_.events;
  const auto sample = [&](double until, std::size_t most) {
    std::vector<std::size_t> all, off;
    for (std::size_t k = 0; k < events.size() && events[k].time <= until; ++k) {
      all.push_back(k);
      if (violating.contains(k)) off.push_back(k);
    }
    if (all.size() <= most) return residuals_.on(all);
    std::set<std::size_t> chosen;
    const auto choose = [&](const std::vector<std::size_t>& list, std::size_t number) {
      for (std::size_t k = 0; k < number; ++k) chosen.insert(list[k * list.size() / number]);
    };
    const std::size_t number_off = std::min(off.size(), most / 2);
    choose(off, number_off);
    choose(all, most - number_off);
    return residuals_.on({chosen.begin(), chosen.end()});
  };
  const auto known =
      std::find_if(events.begin(), events.end(), [](const auto& e) { return std::isfinite(e.time); });
  const double begin = known == events.end() ? 0 : known->time, end = events.back().time, span = end - begin;
  const double first = std::max(period_, events[std::min<std::size_t>(79, events.size() - 1)].time - begin);
  windows_.clear();
  for (double window = first; window < span; window *= 4) windows_.push_back(sample(begin + window, 160));
  windows_.push_back(sample(end, 300));
  few_ = sample(end, 80);
  many_ = sample(end, 1500);
  early_end_ = std::min(begin + first, end);
  score_of_case_ = misfit(whole(), nominal_);
}

void Evidence::count_violations(Hypothesis& tried) const {
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
    audit::EventsAtHand changed = log_;
    for (auto& event : changed.events) assumed.log.apply(event, built->mill);
    const auto found = audit::audit(*built, changed, options_).findings;
    tried.left = found.total();
    for (const auto kind : found.ranked())
      tried.others += (tried.others.empty() ? "" : ", ") + std::string(audit::info(kind).name);
  }
}

std::set<std::size_t> Evidence::violating_events(const Assumptions& assumed) const {
  const auto rows = all_.rows(assumed);
  std::set<std::size_t> events;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (is_violated(rows[k])) events.insert(all_.of_case()[k].at.event);
  return events;
}

Evidence::Explained Evidence::explained_by(const Hypothesis& tried) const {
  if (!(score_of_case_ - tried.score >= strong_evidence) || has_number_of_case(tried)) return {};
  const auto before = all_.rows(nominal_), with = all_.rows(tried.assumed());
  // Rows of one kind that stay violated may have another mistake, if none of that kind is explained.
  std::array<std::uint64_t, audit::row_kinds> vanished{}, left{};
  std::uint64_t contradicting = 0;
  Explained explained;
  for (std::size_t k = 0; k < before.size(); ++k) {
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
  const bool all = audit::accounts_for(explained.rows.size(), explained.rows.size() + contradicting);
  return all && explained.events.size() >= least_events ? explained : Explained{};
}

void Evidence::judge(Hypothesis& tried) const {
  const double rows = static_cast<double>(whole().count());
  tried.score = misfit(whole(), tried.assumed());
  for (const auto& p : tried.numbers) tried.score += p.prior + std::log(rows);
}

Hypothesis Evidence::with(const Hypothesis& base, const Parameter& more) const {
  Hypothesis tried = base;
  if (!more.mistake.empty()) {
    tried.mistakes.push_back(more);
    fit_and_judge(tried);
    return tried;
  }
  tried.numbers.push_back(more);
  std::vector<Hypothesis> fitted;
  for (const double start : starts(base.assumed(), more)) {
    tried.values = base.values;
    tried.values.push_back(start);
    fitted.push_back(tried);
    fit_and_judge(fitted.back());
  }
  sort(fitted);
  return std::move(fitted.front());
}

void Evidence::fit_and_judge(Hypothesis& tried) const {
  const bool from_early =
      std::any_of(tried.numbers.begin(), tried.numbers.end(), [](const auto& p) { return p.is_speed; });
  for (const auto& window : windows_) {
    const bool last = &window == &whole();
    if (!tried.numbers.empty() && (last || (from_early && window.count() >= 12))) fit(window, tried);
  }
  judge(tried);
}

/// Values to begin a fit with: that of the case, and others that fit better.
std::vector<double> Evidence::starts(const Assumptions& base, const Parameter& p) const {
  const auto& sample = p.is_periodic() ? early() : few_;
  const double enough = misfit(sample, base) - strong_evidence;
  std::vector<std::pair<double, double>> better;
  for (const double value : p.trial_values(early_end_))
    if (const double now = misfit(sample, p.on(base, value)); now < enough) better.emplace_back(now, value);
  auto values = best_of(std::move(better), p.is_periodic() ? 2 : 1);
  if (p.is_of_case())
    values.insert(values.begin(), p.value);
  else if (values.empty())
    values = {p.first_values.front()};
  return values;
}

bool Evidence::accept(Hypothesis& tried) const {
  if (!(score_of_case_ - tried.score >= strong_evidence)) return false;
  if (vanished(whole(), tried.assumed()) < 0.5) return false;  // a better fit does not help that much
  tried.plainness = 0;
  if (!tried.numbers.empty()) fit(many_, tried);
  for (std::size_t k = 0; k < tried.values.size(); ++k)
    if (tried.numbers[k].dimension == Dimension::time)  // times are rounded
      tried.half_widths[k] += 1e-15 * std::abs(log_.events.back().time);
  if (has_number_of_case(tried)) return false;
  for (std::size_t k = 0; k < tried.values.size(); ++k) {
    const auto& p = tried.numbers[k];
    const bool is_factor = !p.equation.empty() && p.value == 1;
    if (is_factor && !word_for(tried.values[k], tried.half_widths[k]).empty()) tried.plainness += 3;
    widen(tried, k);
  }
  count_violations(tried);
  return tried.left <= tried.of && audit::accounts_for(tried.of - tried.left, tried.of) &&
         10 * vanished(many_, tried.assumed()) >= 9;
}

/// A number known from one side only, such as a restitution below which all impacts separate at v_s: the
/// interval reaches to zero where that fits as well.
void Evidence::widen(Hypothesis& tried, std::size_t place) const {
  if (tried.numbers[place].value == 0 || tried.values[place] == 0) return;
  auto values = tried.values;
  values[place] = 0;
  if (misfit(many_, tried.with(values)) <= misfit(many_, tried.assumed()) + 1)
    tried.half_widths[place] = std::max(tried.half_widths[place], std::abs(tried.values[place]));
}

/// The share of the violated rows of a sample that vanish when a cause is assumed.
double Evidence::vanished(const Residuals& sample, const Assumptions& assumed) const {
  const auto before = sample.rows(nominal_), with = sample.rows(assumed);
  std::uint64_t violated = 0, vanished = 0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (!is_violated(before[k])) continue;
    ++violated;
    if (audit::vanishes(std::abs(before[k]), std::abs(with[k]), 1)) ++vanished;
  }
  return violated > 0 ? static_cast<double>(vanished) / static_cast<double>(violated) : 0;
}

std::vector<Parameter> Evidence::by_trial_values(const Assumptions& base, const std::vector<Parameter>& list,
                                                 std::size_t most) const {
  const double enough = misfit(few_, base) - strong_evidence;
  std::vector<std::pair<double, Parameter>> order;
  for (const auto& p : list) {
    if (p.is_periodic()) continue;  // has too many of them
    double least = enough;
    for (const double value : p.trial_values(early_end_))
      least = std::min(least, misfit(few_, p.on(base, value)));
    if (least < enough) order.emplace_back(least, p);
  }
  return best_of(std::move(order), most);
}

/// By a linear fit of the rows. A part that contains all rows of a number restricts nothing.
std::vector<Parameter> Evidence::by_sensitivity(const Residuals& sample, const Assumptions& base,
                                                const std::vector<Parameter>& numbers,
                                                const std::vector<SharedSubset>& parts,
                                                std::size_t most) const {
  const auto rows = sample.rows(base);
  std::vector<double> change;
  std::vector<std::pair<double, Parameter>> order;
  for (const auto& p : numbers) {
    const auto slope = sensitivity(sample, base, rows, p);
    if (slope.empty()) continue;
    if (parts.empty()) order.emplace_back(linear_misfit(sample, rows, {&slope}, change), p);
    for (const auto& part : parts) {
      if (!fits(*part, p)) continue;
      auto inside = slope;
      for (std::size_t k = 0; k < rows.size(); ++k)
        if (!part->holds(sample.of_case()[k].at)) inside[k] = 0;
      const auto is_zero = [](double row) { return row == 0; };
      if (inside == slope || std::all_of(inside.begin(), inside.end(), is_zero)) continue;
      order.emplace_back(linear_misfit(sample, rows, {&inside}, change),
                         restricted_to(part, p, parts_.size()));
    }
  }
  return best_of(std::move(order), most);
}

/// In the first span a wrong speed has not gone far; the whole log where that span shows nothing.
const Residuals& Evidence::early_or_whole(const Assumptions& base) const {
  return count_violated(early().rows(base)) > 12 ? early() : whole();
}

std::vector<Parameter> Evidence::best_numbers(const Assumptions& base, const std::vector<Parameter>& numbers,
                                              std::size_t most) const {
  auto best = by_sensitivity(early_or_whole(base), base, numbers, {}, most);
  for (auto& p : by_trial_values(base, numbers, most / 2)) best.push_back(std::move(p));
  return best;
}

std::vector<Hypothesis> Evidence::best_pairs(const std::vector<Parameter>& numbers, std::size_t most) const {
  const auto& sample = early_or_whole(nominal_);
  const auto rows = sample.rows(nominal_);
  std::vector<std::pair<const Parameter*, std::vector<double>>> sensitive;
  for (const auto& p : numbers)
    if (auto slope = sensitivity(sample, nominal_, rows, p); !slope.empty())
      sensitive.emplace_back(&p, std::move(slope));
  struct Pair {
    std::array<const Parameter*, 2> numbers;
    std::vector<double> change;
  };
  std::vector<std::pair<double, Pair>> order;
  for (auto one = sensitive.begin(); one != sensitive.end(); ++one)
    for (auto two = std::next(one); two != sensitive.end(); ++two) {
      Pair pair{{one->first, two->first}, {}};
      const double left = linear_misfit(sample, rows, {&one->second, &two->second}, pair.change);
      order.emplace_back(left, std::move(pair));
    }
  std::vector<Hypothesis> best;
  for (const auto& pair : best_of(std::move(order), most)) {
    std::vector<Hypothesis> fitted;
    for (const double share : {0, 1}) {
      auto& tried = fitted.emplace_back(Hypothesis{nominal_});
      for (std::size_t k = 0; k < 2; ++k) {
        const auto& p = *pair.numbers[k];
        tried.numbers.push_back(p);
        tried.values.push_back(p.value + share * pair.change[k] * p.change);
      }
      fit_and_judge(tried);
    }
    sort(fitted);
    best.push_back(std::move(fitted.front()));
  }
  return best;
}

std::vector<Parameter> Evidence::best_in_parts(const Assumptions& base, const std::vector<Parameter>& numbers,
                                               std::size_t most, double share) const {
  const auto rows = whole().rows(base);
  std::vector<SharedSubset> parts;
  for (const auto& part : parts_) {
    std::uint64_t inside = 0;
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (is_violated(rows[k]) && part->holds(whole().of_case()[k].at)) ++inside;
    if (static_cast<double>(inside) > share * static_cast<double>(count_violated(rows)))
      parts.push_back(part);
  }
  if (parts.empty()) return {};
  const auto of_these = of_parts(numbers);
  auto best = by_sensitivity(whole(), base, of_these, parts, most);
  std::vector<Parameter> restricted;
  for (const auto& p : by_trial_values(base, of_these, 4))
    for (const auto& part : parts)
      if (fits(*part, p)) restricted.push_back(restricted_to(part, p, parts_.size()));
  for (auto& p : by_trial_values(base, restricted, most / 2)) best.push_back(std::move(p));
  return best;
}

}  // namespace edmill::identify
