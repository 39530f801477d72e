#include "identify/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

namespace edmill::identify {

namespace {

template <class List, class Key>
void sort_by(List& list, const Key& key) {
  std::stable_sort(list.begin(), list.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
}

/// The items of the least misfits, the best first.
template <class Item>
std::vector<Item> best_of(std::vector<std::pair<double, Item>> order, std::size_t most) {
  sort_by(order, [](const auto& row) { return row.first; });
  std::vector<Item> best;
  for (std::size_t k = 0; k < std::min(most, order.size()); ++k) best.push_back(std::move(order[k].second));
  return best;
}

double misfit_with(const Residuals& sample, const Assumptions& base, const Parameter& p, double value) {
  Assumptions moved = base;
  p.set(moved, value);
  return misfit(sample, moved);
}

/// The least with values of a parameter over decades.
double misfit_from_afar(const Residuals& sample, const Assumptions& base, const Parameter& p) {
  double best = std::numeric_limits<double>::infinity();
  for (const double value : p.values_from_afar()) best = std::min(best, misfit_with(sample, base, p, value));
  return best;
}

/// How many rows are off.
std::uint64_t count_off(const std::vector<double>& rows) {
  return static_cast<std::uint64_t>(
      std::count_if(rows.begin(), rows.end(), [](double r) { return std::abs(r) > 1; }));
}

/// Whether the effect of a parameter can be restricted to this part of the log.
bool fits(const Subset& part, const Parameter& p) {
  return (part.of_impacts && p.of_impacts) || (part.of_flights && p.of_flights);
}

double penalty(const Residuals& sample, const Model& model) {
  double sum = static_cast<double>(model.free.size()) * std::log(static_cast<double>(sample.count()));
  for (const auto* p : model.free) sum += p->prior;
  return sum;
}

/// Terms, and numbers of the contact law; where both kinds of contact have one law, its numbers once.
std::vector<Parameter> of_parts(const std::vector<Parameter>& parameters) {
  std::set<std::string> common;
  const auto last = [](const std::string& key) { return key.substr(key.rfind('.') + 1); };
  for (const auto& p : parameters)
    if (p.key.starts_with("contact.") && std::count(p.key.begin(), p.key.end(), '.') == 1)
      common.insert(last(p.key));
  std::vector<Parameter> list;
  for (const auto& p : parameters) {
    const bool of_law = p.key.starts_with("contact");
    const bool again =
        of_law && std::count(p.key.begin(), p.key.end(), '.') > 1 && common.contains(last(p.key));
    if (!p.equation.empty() || (of_law && !again)) list.push_back(p);
  }
  return list;
}

}  // namespace

void Samples::choose(std::set<std::size_t> violating) {
  violating_ = std::move(violating);
  const auto& events = *events_;
  const auto known =
      std::find_if(events.begin(), events.end(), [](const auto& e) { return std::isfinite(e.time); });
  const double begin = known == events.end() ? 0 : known->time, end = events.back().time, span = end - begin;
  const double first = std::max(period_, events[std::min<std::size_t>(79, events.size() - 1)].time - begin);
  windows_.clear();
  for (double window = first; window < span; window *= 4) windows_.push_back(sample(begin + window, 160));
  windows_.push_back(sample(end, 300));
  few_ = sample(end, 80);
  many_ = sample(end, 1500);
}

auto Samples::sample(double until, std::size_t most) const -> Places {
  Places all, violating, chosen;
  for (std::size_t k = 0; k < events_->size() && (*events_)[k].time <= until; ++k) {
    all.push_back(k);
    if (violating_.contains(k)) violating.push_back(k);
  }
  if (all.size() <= most) return all;
  for (const auto* list : {&violating, &all}) {
    const std::size_t number = std::min(list->size(), list == &all ? most - chosen.size() : most / 2);
    for (std::size_t k = 0; k < number; ++k) chosen.push_back((*list)[k * list->size() / number]);
  }
  const std::set<std::size_t> each(chosen.begin(), chosen.end());
  return {each.begin(), each.end()};
}

std::set<std::string> Candidate::names() const {
  std::set<std::string> all(mistakes.begin(), mistakes.end());
  for (const auto* p : model.free) all.insert(p->key);
  return all;
}

void sort(std::vector<Candidate>& list) {
  sort_by(list, [](const auto& c) { return c.rank(); });
}

double Candidate::evidence() const {
  double choices = 0;
  for (const auto* p : model.free) choices += p->prior;
  return criterion - choices;
}

Candidates::Candidates(const audit::EventsAtHand& log, const audit::Options& options,
                       const model::Case<double>& the_case, const Assumptions& nominal,
                       std::uint64_t violations)
    : log_(log),
      options_(options),
      nominal_(nominal),
      residuals_(log, audit::tolerances_of(the_case, options), the_case),
      parts_(subsets_of(the_case, log.events, residuals_.branches())),
      samples_(log.events, the_case.mill.motion.period()),
      violations_(violations) {
  draw_samples({nominal});
}

void Candidates::draw_samples(const std::vector<Assumptions>& assumptions) {
  std::set<std::size_t> violating;
  for (const auto& assumed : assumptions) violating.merge(events_off(assumed));
  samples_.choose(std::move(violating));
  without_ = misfit(residuals_.on(samples_.whole()), nominal_);
}

void Candidates::count_violations(Candidate& c) const {
  const auto assumed = c.assumed();
  c.of = violations_;
  if (!assumed.is_case()) {
    c.of = events_off(nominal_).size();
    c.left = events_off(assumed).size();
    return;
  }
  c.left = std::numeric_limits<std::uint64_t>::max();
  if (const auto built = assumed.built()) {
    audit::EventsAtHand changed = log_;
    for (auto& event : changed.events) assumed.log.apply(event, built->mill);
    c.left = audit::audit(*built, changed, options_).findings.total();
  }
}

std::set<std::size_t> Candidates::events_off(const Assumptions& assumed) const {
  Samples::Places every(log_.events.size());
  std::iota(every.begin(), every.end(), std::size_t{0});
  const auto all = residuals_.on(every);
  const auto rows = all.rows(assumed);
  std::set<std::size_t> off;
  for (std::size_t k = 0; k < rows.size(); ++k)
    if (std::abs(rows[k]) > 1) off.insert(all.places()[k].event);
  return off;
}

void Candidates::judge(Candidate& c) const {
  const auto sample = residuals_.on(samples_.whole());
  c.criterion = misfit(sample, c.assumed()) + penalty(sample, c.model);
}

Candidate Candidates::with_mistakes(const Assumptions& base, const std::vector<std::string>& names) const {
  Candidate c{.model = {base, {}}, .mistakes = names, .values = {}, .half_widths = {}};
  judge(c);
  return c;
}

Candidate Candidates::fitted(const Model& model, const std::vector<std::string>& mistakes,
                             const std::vector<double>& start) const {
  Candidate c{.model = model, .mistakes = mistakes, .values = start, .half_widths = {}};
  const auto& windows = samples_.windows();
  const bool staged =
      std::any_of(model.free.begin(), model.free.end(), [](const auto* p) { return p->is_speed; });
  for (std::size_t w = staged ? 0 : windows.size() - 1; w < windows.size(); ++w) {
    const auto sample = residuals_.on(windows[w]);
    if (sample.count() < 12 && w + 1 < windows.size()) continue;
    auto result = fit(sample, model, c.values);
    c.values = std::move(result.values);
    c.half_widths = std::move(result.half_widths);
    c.criterion = result.cost + penalty(sample, model);
  }
  return c;
}

std::vector<double> Candidates::starts(const Assumptions& base, const Parameter& p) const {
  if (!p.is_speed && p.cycle == 0) {
    const auto few = residuals_.on(samples_.few());
    double best = misfit(few, base) - strong_evidence, far = p.value;
    for (const double value : p.values_from_afar())
      if (const double now = misfit_with(few, base, p, value); now < best) {
        best = now;
        far = value;
      }
    if (!p.is_of_case()) return {std::isfinite(far) ? far : p.first_values.front()};
    return far == p.value ? std::vector{p.value} : std::vector{p.value, far};
  }
  const auto sample = residuals_.on(samples_.early());
  std::vector<std::pair<double, double>> tried;
  const auto add = [&](double value) { tried.emplace_back(misfit_with(sample, base, p, value), value); };
  add(p.value);
  if (p.cycle > 0) {
    for (int k = 1; k < 16; ++k) add(p.value + p.cycle * (k <= 8 ? k : k - 16) / 16);
  } else {
    const double turns =
        std::abs(log_.events[samples_.early().back()].time * p.value) / (2 * std::numbers::pi);
    const int steps = std::clamp(static_cast<int>(std::ceil(0.12 * turns * 10)), 1, 400);
    for (int k = -steps; k <= steps; ++k)
      if (k != 0) add(p.value * (1 + 0.12 * k / steps));
    // Far off, where the log begins so early that steps of a tenth of a turn are few.
    for (const double factor : {-1.0, 0.5, 2.0}) add(factor * p.value);
    constexpr double most_turns = 15, farthest = 2.5;
    const int far_steps = turns < most_turns ? static_cast<int>(std::ceil(farthest * turns * 10)) : 0;
    for (int k = -far_steps; k <= far_steps; ++k)
      if (k != 0) add(p.value * farthest * k / far_steps);
  }
  std::sort(tried.begin(), tried.end());
  std::vector<double> best = {p.value};
  for (std::size_t k = 0; k < 2; ++k)
    if (tried[k].second != p.value) best.push_back(tried[k].second);
  return best;
}

bool Candidates::accept(Candidate& c) const {
  if (!(without_ - c.criterion >= strong_evidence)) return false;
  c.plainness = 0;
  if (!c.model.free.empty()) {
    auto result = fit(residuals_.on(samples_.many()), c.model, c.values);
    c.values = std::move(result.values);
    c.half_widths = std::move(result.half_widths);
  }
  for (std::size_t k = 0; k < c.values.size(); ++k) {
    const auto& free = *c.model.free[k];
    if (free.dimension == Dimension::time)  // times are rounded
      c.half_widths[k] += 1e-15 * std::abs(log_.events.back().time);
    if (free.is_of_case() && !(std::abs(c.values[k] - free.value) > c.half_widths[k])) return false;
    const bool is_factor = !free.equation.empty() && free.value == 1;
    if (is_factor && !word_for(c.values[k], c.half_widths[k]).empty()) c.plainness += 3;
    widen(c, k);
  }
  count_violations(c);
  return c.left <= c.of && audit::accounts_for(c.of - c.left, c.of) && rows_vanish(c.assumed());
}

/// A number known from one side only, such as a restitution below which all impacts separate at v_s: the
/// interval reaches to zero where that fits as well.
void Candidates::widen(Candidate& c, std::size_t place) const {
  if (c.model.free[place]->value == 0 || c.values[place] == 0) return;
  const auto sample = residuals_.on(samples_.many());
  auto values = c.values;
  values[place] = 0;
  if (misfit(sample, c.model.with(values)) <= misfit(sample, c.assumed()) + 1)
    c.half_widths[place] = std::max(c.half_widths[place], std::abs(c.values[place]));
}

/// Whether the rows that are off vanish when a cause is assumed.
bool Candidates::rows_vanish(const Assumptions& assumed) const {
  const auto sample = residuals_.on(samples_.many());
  const auto before = sample.rows(nominal_), with = sample.rows(assumed);
  std::uint64_t vanished = 0;
  for (std::size_t k = 0; k < before.size(); ++k)
    if (std::abs(before[k]) > 1 && audit::vanishes(std::abs(before[k]), std::abs(with[k]), 1)) ++vanished;
  return audit::accounts_for(vanished, count_off(before));
}

std::vector<Tried> Candidates::promising(const Assumptions& base, const std::vector<Mistake>& mistakes,
                                         std::size_t most) const {
  const auto sample = residuals_.on(samples_.few());
  const double before = misfit(sample, base);
  std::vector<Tried> better;
  for (const auto& mistake : mistakes) {
    const double now = misfit(sample, mistake.on(base));
    if (now < before - strong_evidence) better.push_back({now, mistake});
  }
  sort_by(better, [](const auto& t) { return t.misfit; });
  if (better.size() > most) better.resize(most);
  return better;
}

Residuals Candidates::telling(const Assumptions& base) const {
  auto early = residuals_.on(samples_.early());
  return count_off(early.rows(base)) > 12 ? early : residuals_.on(samples_.whole());
}

std::vector<const Parameter*> Candidates::ranked(const Assumptions& base,
                                                 const std::vector<Parameter>& parameters,
                                                 std::size_t most) const {
  const auto sample = telling(base);
  const auto rows = sample.rows(base);
  const auto slopes = slopes_of(sample, base, parameters);
  std::vector<std::pair<double, const Parameter*>> order;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    if (slopes[k].empty()) continue;
    std::vector<double> change;
    order.emplace_back(linear_misfit(rows, sample.kinds(), {&slopes[k]}, change), &parameters[k]);
  }
  sort_by(order, [](const auto& row) { return row.first; });
  std::vector<const Parameter*> best;
  for (std::size_t k = 0; k < order.size(); ++k)
    if (k < most || order[k].second->is_speed || order[k].second->cycle > 0) best.push_back(order[k].second);
  for (const auto* p : telling_from_afar(base, parameters, most / 2))
    if (std::find(best.begin(), best.end(), p) == best.end()) best.push_back(p);
  return best;
}

/// A number may have no effect near its value, or another one far from it.
std::vector<const Parameter*> Candidates::telling_from_afar(const Assumptions& base,
                                                            const std::vector<Parameter>& parameters,
                                                            std::size_t most) const {
  const auto sample = residuals_.on(samples_.whole());
  const double here = misfit(sample, base);
  std::vector<std::pair<double, const Parameter*>> order;
  for (const auto& p : parameters)
    if (const double best = misfit_from_afar(sample, base, p); best < here - strong_evidence)
      order.emplace_back(best, &p);
  return best_of(std::move(order), most);
}

std::vector<Parameter> Candidates::ranked_in_parts(const Assumptions& base, const std::vector<Parameter>& all,
                                                   std::size_t most, double share) const {
  const auto parameters = of_parts(all);
  const auto sample = residuals_.on(samples_.whole());
  const auto rows = sample.rows(base);
  const auto slopes = slopes_of(sample, base, parameters);
  using InPart = std::pair<const Parameter*, SharedSubset>;
  std::vector<std::pair<double, InPart>> order;
  std::vector<std::size_t> holding;  // parts with so much of what is off
  const auto off = count_off(rows);
  for (std::size_t s = 0; s < parts_.size(); ++s) {
    std::vector<bool> inside;
    std::uint64_t off_inside = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      inside.push_back(parts_[s]->holds(sample.places()[k]));
      if (inside.back() && std::abs(rows[k]) > 1) ++off_inside;
    }
    if (off_inside == 0 || static_cast<double>(off_inside) < share * static_cast<double>(off)) continue;
    holding.push_back(s);
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      if (slopes[p].empty() || !fits(*parts_[s], parameters[p])) continue;
      auto slope = slopes[p];
      bool some = false, others = false;  // a part that holds all of a parameter's rows restricts nothing
      for (std::size_t k = 0; k < slope.size(); ++k) {
        (inside[k] ? some : others) |= slope[k] != 0;
        if (!inside[k]) slope[k] = 0;
      }
      if (!some || !others) continue;
      std::vector<double> change;
      const double left = linear_misfit(rows, sample.kinds(), {&slope}, change);
      order.emplace_back(left, InPart(&parameters[p], parts_[s]));
    }
  }
  std::vector<Parameter> best;
  for (const auto& [parameter, part] : best_of(std::move(order), most))
    best.push_back(restricted_to(part, *parameter, parts_.size()));
  for (auto& p : telling_from_afar_in_parts(base, parameters, holding, most / 2))
    best.push_back(std::move(p));
  return best;
}

/// Of what tells from afar in the whole log, that which does in a part of it.
std::vector<Parameter> Candidates::telling_from_afar_in_parts(const Assumptions& base,
                                                              const std::vector<Parameter>& parameters,
                                                              const std::vector<std::size_t>& parts,
                                                              std::size_t most) const {
  const auto few = residuals_.on(samples_.few());
  const double here = misfit(few, base);
  std::vector<std::pair<double, Parameter>> order;
  for (const auto* p : telling_from_afar(base, parameters, 4))
    for (const auto part : parts) {
      if (!fits(*parts_[part], *p)) continue;
      auto restricted = restricted_to(parts_[part], *p, parts_.size());
      if (const double best = misfit_from_afar(few, base, restricted); best < here - strong_evidence)
        order.emplace_back(best, std::move(restricted));
    }
  return best_of(std::move(order), most);
}

auto Candidates::ranked_pairs(const std::vector<Parameter>& parameters) const -> std::vector<Pair> {
  const auto sample = telling(nominal_);
  const auto rows = sample.rows(nominal_);
  const auto slopes = slopes_of(sample, nominal_, parameters);
  std::vector<Pair> order;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    for (std::size_t j = i + 1; j < parameters.size(); ++j) {
      if (slopes[i].empty() || slopes[j].empty()) continue;
      std::vector<double> change;
      const double left = linear_misfit(rows, sample.kinds(), {&slopes[i], &slopes[j]}, change);
      order.push_back({left, i, j, std::move(change)});
    }
  sort_by(order, [](const auto& p) { return p.misfit; });
  return order;
}

}  // namespace edmill::identify
