// Impacts in bins of energy or of speed. docs/outputs.md, "spectra", "rates_above"
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "base/scalar_list.hpp"
#include "output/table_output.hpp"

namespace edmill::output {

enum class BinnedBy { energy, speed, impact_energy };
inline constexpr std::array<std::string_view, 3> choices_of(BinnedBy) {
  return {"energy", "speed", "impact_energy"};
}
/// Names of the spectra for each choice.
inline const std::array<std::vector<std::string>, 3> spectra_by{
    {{"normal", "tangential", "total"}, {"approach", "slip"}, {"impact"}}};

struct SpectraKeys {
  BinnedBy by = BinnedBy::energy;
  Quantity low, high;  ///< [m/s] or [J]
  std::uint64_t bins_per_decade = 10;

  static void keys(auto& output, auto&& row) {
    auto& k = output.template make_own<SpectraKeys>();
    row(Parameter{"of",
            "quantity of the spectrum: the dissipated energy; or `speed`; or `impact_energy`, M/2 "
            "v^2 along the normal"}
            .as("name")
            .usually("`\"energy\"`"),
        k.by);
    const bool speed = k.by == BinnedBy::speed;
    const auto dimension = speed ? Dimension::speed : Dimension::energy;
    row(Parameter{"low", dimension, "start of the first bin", Range::any,
            speed ? "1 mm/s" : "1e-9 J"}
            .as("energy or speed")
            .usually("`\"1e-9 J\"`, `\"1 mm/s\"`"),
        k.low);
    row(Parameter{"high", dimension, "end of the last bin", Range::any, speed ? "10 m/s" : "1 J"}
            .as("energy or speed")
            .usually("`\"1 J\"`, `\"10 m/s\"`"),
        k.high);
    row({"bins_per_decade", "number of bins per factor of ten", table_size, "10"},
        k.bins_per_decade);
  }
  static void check(Section& s, const CaseSpec&, OutputSpec& output) {
    const auto& k = output.own_keys<SpectraKeys>();
    s.require(k.low.positive(), "low", "a value above 0: the bins are logarithmic");
    const double low = k.low.to<double>(), high = k.high.to<double>();
    const bool ascending = low > 0 && high > low * (1 + 1e-6) && std::isfinite(high);
    const bool low_is_wrong = s.has("low") && !s.has("high");
    s.require(ascending || !k.low.positive(), low_is_wrong ? "low" : "high",
        low_is_wrong ? "a value below high" : "a value above low");
  }
};

/// Edges low 10^(k / bins_per_decade) up to high; the last bin may be shorter. They are computed in
/// a wider scalar, so that they are the same bits everywhere.
/// @pre 0 < low < high, bins_per_decade > 0
template <class Real> std::vector<Real> edges_of(const SpectraKeys& keys) {
  using Fine = std::conditional_t<std::is_void_v<Wider<Real>>, Real, Wider<Real>>;
  const Fine first = keys.low.to<Fine>(), last = keys.high.to<Fine>();
  const Fine short_of_last = last * (1 - Fine(1) / 1000000000);  // no bin by rounding alone
  std::vector<Real> edges{keys.low.to<Real>()};
  for (std::uint64_t k = 1;; ++k) {
    using std::pow;
    const Fine edge = first * pow(Fine(10), Fine(k) / Fine(keys.bins_per_decade));
    if (edge > short_of_last) break;
    edges.push_back(static_cast<Real>(edge));
  }
  edges.push_back(keys.high.to<Real>());
  return edges;
}

template <class Real> class SpectraOutput : public TableOutput<Real> {
 public:
  SpectraOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : TableOutput<Real>(spec, run), by_(spec.own_keys<SpectraKeys>().by),
        edges_(edges_of<Real>(spec.own_keys<SpectraKeys>())),
        spectra_(names().size(),
            Spectrum(edges_.size() + 1, PartnerTally<Real>(run.partners.count()))) {}
 protected:
  void archive_record(Archive& a) override { a(spectra_); }

  void record(const ImpactFacts<Real>& f) override {
    const auto& o = f.outcome;
    if (by_ == BinnedBy::impact_energy) {
      add(f, 0, o.impact_energy(), o.milling_dose);
    } else if (by_ == BinnedBy::speed) {
      add(f, 0, o.approach_speed, o.milling_dose);
      add(f, 1, o.slip_speed, o.milling_dose);
    } else {
      const Real tangential = o.milling_dose - o.normal_dose;
      add(f, 0, o.normal_dose, o.normal_dose);
      add(f, 1, tangential, tangential);
      add(f, 2, o.milling_dose, o.milling_dose);
    }
  }

  void end_of_record(const Simulation<Real>&, const Real& until) override {
    const std::string unit = by_ == BinnedBy::speed ? "m/s" : "J";
    std::vector<Column> columns{
        {"spectrum", text, "", "the part of the dose, the speed or the energy that is binned"},
        {"bin", text, "", "number of the bin from 1, or below or above all"},
        {"low", number, unit, "lower edge of the bin"},
        {"high", number, unit, "upper edge of the bin, not in it"}};
    add_partner_columns(
        columns, this->run.partners, {"impacts", integer, "1", "number of impacts"});
    add_partner_columns(columns, this->run.partners,
        {"energy", number, "J",
            by_ == BinnedBy::energy ? "this part of the dose of the impacts"
                                    : "dose of the impacts"});
    this->begin(std::move(columns), {this->window(until)});
    for (std::size_t s = 0; s < spectra_.size(); ++s)
      for (std::size_t bin = 0; bin < spectra_[s].size(); ++bin) {
        this->put(names()[s]);
        this->put_bin(edges_, bin);
        const auto put = [&](const auto& value) { this->put(value); };
        const auto& tallies = spectra_[s][bin];
        put_partners(tallies, put, [](const auto& t) { return t.impacts; });
        put_partners(tallies, put, [](const auto& t) { return t.energy.value(); });
      }
  }
 private:
  using Spectrum = std::vector<PartnerTally<Real>>;  ///< below all bins, the bins, above all

  void add(const ImpactFacts<Real>& f, std::size_t place, const Real& value, const Real& energy) {
    of_partner(f, spectra_[place][bin_of<Real>(edges_, value)]).add(energy);
  }

  const auto& names() const { return spectra_by[static_cast<std::size_t>(by_)]; }

  BinnedBy by_;
  std::vector<Real> edges_;
  std::vector<Spectrum> spectra_;
};

struct RatesAboveKeys {
  std::optional<std::vector<std::string>> texts;
  std::vector<Quantity> cutoffs;  ///< ascending [m/s]

  static void keys(auto& output, auto&& row) {
    row(Parameter{"cutoffs", "approach speeds, with a row for each"}
            .as("list of speeds")
            .usually("0, 1 mm/s, 1 cm/s, 0.1 m/s, 1 m/s"),
        output.template make_own<RatesAboveKeys>().texts);
  }
  static void check(Section& s, const CaseSpec&, OutputSpec& output) {
    auto& own = output.make_own<RatesAboveKeys>();
    const std::string expected = "an array of speeds of 0 or more";
    const std::vector<std::string> usual{"0 m/s", "1 mm/s", "1 cm/s", "0.1 m/s", "1 m/s"};
    for (const auto& text : own.texts.value_or(usual)) {
      const auto speed = casefile::parse_quantity(text, casefile::Dimension::speed);
      const auto* quantity = std::get_if<Quantity>(&speed);
      if (!quantity)
        s.problem("cutoffs", std::get<casefile::QuantityProblem>(speed).found, expected);
      else if (quantity->negative())
        s.problem("cutoffs", "\"" + text + "\"", expected);
      else
        own.cutoffs.push_back(*quantity);
    }
    std::sort(own.cutoffs.begin(), own.cutoffs.end());
  }
};

/// Rates of the impacts above speed cutoffs. docs/outputs.md, "rates_above"
template <class Real> class RatesAboveOutput : public TableOutput<Real> {
 public:
  RatesAboveOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : TableOutput<Real>(spec, run) {
    for (const auto& cutoff : spec.own_keys<RatesAboveKeys>().cutoffs)
      cutoffs_.push_back(cutoff.to<Real>());
    from_.resize(cutoffs_.size() + 1, PartnerTally<Real>(run.partners.count()));
  }
 protected:
  void archive_record(Archive& a) override { a(from_); }

  void record(const ImpactFacts<Real>& f) override {
    const Real& approach = f.outcome.approach_speed;
    const Real speed = approach > 0 ? approach : Real(0);
    of_partner(f, from_[bin_of<Real>(cutoffs_, speed)]).add(f.outcome.milling_dose);
  }

  void end_of_record(const Simulation<Real>&, const Real& until) override {
    const auto& partners = this->run.partners;
    std::vector<Column> columns{
        {"cutoff", number, "m/s", "the approach speed from which on impacts count"}};
    add_partner_columns(columns, partners, {"rate", number, "1/s", "collision rate"});
    add_partner_columns(columns, partners, {"dose_rate", number, "W", "milling dose rate"});
    this->begin(std::move(columns), {this->window(until)});
    const Real duration = until - this->timer().from();
    if (!(duration > 0)) return;  // nothing defines a rate
    for (std::size_t k = 0; k < cutoffs_.size(); ++k) {
      PartnerTally<Real> above(partners.count());
      for (std::size_t bin = cutoffs_.size(); bin > k; --bin)
        for (int p = 0; p < partners.count(); ++p) above[p].add(from_[bin][p]);
      this->put(cutoffs_[k]);
      const auto put = [&](const Real& value) { this->put(value); };
      put_partners(above, put, [&](const auto& t) { return Real(Real(t.impacts) / duration); });
      put_partners(above, put, [&](const auto& t) { return Real(t.energy.value() / duration); });
    }
  }
 private:
  std::vector<Real> cutoffs_;             ///< ascending [m/s]
  std::vector<PartnerTally<Real>> from_;  ///< below all cutoffs, then from each up to the next
};

}  // namespace edmill::output
