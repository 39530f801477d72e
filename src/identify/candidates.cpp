#include "identify/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "audit/naming.hpp"

namespace edmill::identify {

namespace {

double misfit_of(const Residuals& sample, const Assumptions& assumed) {
  return misfit(sample.rows(assumed), sample.kinds());
}

double penalty(const Residuals& sample, std::size_t parameters) {
  return static_cast<double>(parameters) * std::log(static_cast<double>(sample.count()));
}

}  // namespace

std::set<std::string> Candidate::names() const {
  std::set<std::string> all(mistakes.begin(), mistakes.end());
  for (const auto* p : model.free) all.insert(p->key);
  return all;
}

void sort(std::vector<Candidate>& list) { std::ranges::stable_sort(list, {}, &Candidate::criterion); }

Candidates::Candidates(const audit::EventsAtHand& log, const audit::Options& options,
                       const model::Case<double>& the_case, const Assumptions& nominal,
                       std::uint64_t violations)
    : log_(log),
      options_(options),
      nominal_(nominal),
      period_(the_case.mill.motion.period()),
      residuals_(log, audit::tolerances_of(the_case, options), the_case),
      samples_(log.events, period_),
      violations_(violations) {
  draw_samples({nominal});
}

void Candidates::draw_samples(const std::vector<Assumptions>& assumptions) {
  samples_.forget_violating();
  for (const auto& assumed : assumptions) {
    const auto all = residuals_.on(samples_.every());
    const auto rows = all.rows(assumed);
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (std::abs(rows[k]) > 1) samples_.note_violating(all.events()[k]);
  }
  samples_.choose();
  without_ = misfit_of(residuals_.on(samples_.whole()), nominal_);
}

std::uint64_t Candidates::violations_with(const Assumptions& assumed) const {
  const auto built = assumed.built();
  if (!built) return std::numeric_limits<std::uint64_t>::max();
  if (assumed.log.none()) return audit::audit(*built, log_, options_).findings.total();
  audit::EventsAtHand changed = log_;
  for (auto& event : changed.events) assumed.log.apply(event);
  return audit::audit(*built, changed, options_).findings.total();
}

void Candidates::judge(Candidate& c) const {
  const auto sample = residuals_.on(samples_.whole());
  c.criterion = misfit_of(sample, c.assumed()) + penalty(sample, c.model.free.size());
}

Candidate Candidates::with_mistakes(const Assumptions& base, const std::vector<std::string>& names) const {
  Candidate c{{base, {}}, names, {}, {}, 0, 0};
  judge(c);
  return c;
}

Candidate Candidates::fitted(const Model& model, const std::vector<std::string>& mistakes,
                             const std::vector<double>& start) const {
  Candidate c{model, mistakes, start, {}, 0, 0};
  const auto& windows = samples_.windows();
  const bool staged = std::ranges::any_of(model.free, [](const auto* p) { return p->is_speed; });
  for (std::size_t w = staged ? 0 : windows.size() - 1; w < windows.size(); ++w) {
    const auto sample = residuals_.on(windows[w]);
    if (sample.count() < 12 && w + 1 < windows.size()) continue;
    auto result = fit(sample, model, c.values);
    c.values = std::move(result.values), c.half_widths = std::move(result.half_widths);
    c.criterion = result.cost + penalty(sample, model.free.size());
  }
  return c;
}

std::vector<double> Candidates::starts(const Assumptions& base, const Parameter& p) const {
  if (!p.is_speed && !p.is_phase) {
    if (p.value != 0) return {p.value};
    return {p.value, 0.1 * p.change, p.change, 10 * p.change};
  }
  const auto sample = residuals_.on(samples_.early());
  std::vector<std::pair<double, double>> tried;
  const auto add = [&](double value) {
    Assumptions moved = base;
    p.set(moved, value);
    tried.emplace_back(misfit_of(sample, moved), value);
  };
  add(p.value);
  if (p.is_phase) {
    for (int k = 1; k < 16; ++k) add(period_ * (k <= 8 ? k : k - 16) / 16);
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

bool Candidates::accept(Candidate& c) const {
  if (!(without_ - c.criterion >= strong_evidence)) return false;
  if (!c.model.free.empty()) {
    auto result = fit(residuals_.on(samples_.many()), c.model, c.values);
    c.values = std::move(result.values), c.half_widths = std::move(result.half_widths);
  }
  for (std::size_t k = 0; k < c.values.size(); ++k)
    if (!(std::abs(c.values[k] - c.model.free[k]->value) > c.half_widths[k])) return false;
  c.left = violations_with(c.assumed());
  return c.left <= violations_ && audit::accounts_for(violations_ - c.left, violations_) &&
         rows_vanish(c.assumed());
}

/// Whether the rows that are off vanish when a cause is assumed.
bool Candidates::rows_vanish(const Assumptions& assumed) const {
  const auto sample = residuals_.on(samples_.many());
  const auto before = sample.rows(nominal_), with = sample.rows(assumed);
  std::uint64_t off = 0, vanished = 0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (!(std::abs(before[k]) > 1)) continue;
    ++off;
    if (audit::vanishes(std::abs(before[k]), std::abs(with[k]), 1)) ++vanished;
  }
  return audit::accounts_for(vanished, off);
}

std::vector<Tried> Candidates::promising(const Assumptions& base, const std::vector<Mistake>& mistakes,
                                         std::size_t most) const {
  const auto sample = residuals_.on(samples_.few());
  const double before = misfit_of(sample, base);
  std::vector<Tried> better;
  for (const auto& mistake : mistakes) {
    Assumptions assumed = base;
    mistake.make(assumed);
    const double now = misfit_of(sample, assumed);
    if (now < before - strong_evidence) better.push_back({now, mistake});
  }
  std::ranges::stable_sort(better, {}, &Tried::misfit);
  if (better.size() > most) better.resize(most);
  return better;
}

Residuals Candidates::telling(const Assumptions& base) const {
  auto early = residuals_.on(samples_.early());
  const auto rows = early.rows(base);
  const auto off = std::ranges::count_if(rows, [](double r) { return std::abs(r) > 1; });
  return off > 12 ? early : residuals_.on(samples_.whole());
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
  std::ranges::stable_sort(order, {}, [](const auto& row) { return row.first; });
  std::vector<const Parameter*> best;
  for (std::size_t k = 0; k < order.size(); ++k)
    if (k < most || order[k].second->is_speed || order[k].second->is_phase) best.push_back(order[k].second);
  return best;
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
      if (change.size() == 2) order.push_back({left, i, j, change});
    }
  std::ranges::stable_sort(order, {}, &Pair::misfit);
  return order;
}

}  // namespace edmill::identify
