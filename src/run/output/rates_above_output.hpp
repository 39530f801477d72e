// Rates of the impacts above speed cutoffs. docs/outputs.md, "rates_above"
#pragma once

#include <algorithm>

#include "casefile/output_entry.hpp"
#include "output/by_partner.hpp"
#include "output/log_bins.hpp"
#include "output/table_output.hpp"

namespace edmill::output {

using Cutoffs = std::vector<casefile::Quantity>;  ///< ascending [m/s]

inline constexpr casefile::KeyText rates_above_keys[] = {
    {"cutoffs", "list of speeds", "0, 1 mm/s, 1 cm/s, 0.1 m/s, 1 m/s", "a row for each"}};

inline void read_rates_above(casefile::Section& s, const casefile::CaseSpec&, casefile::OutputSpec& output) {
  Cutoffs cutoffs;
  if (!s.has("cutoffs")) {
    cutoffs.push_back(casefile::Quantity{0});
    for (const int per_metre : {1000, 100, 10, 1}) cutoffs.push_back(casefile::Quantity{1, per_metre});
    output.own = std::move(cutoffs);
    return;
  }
  const std::string expected = "an array of speeds of 0 or more";
  for (const auto& text : s.settings("cutoffs")) {
    const auto speed = casefile::parse_quantity(text, casefile::Dimension::speed);
    const auto* quantity = std::get_if<casefile::Quantity>(&speed);
    if (!quantity)
      s.problem("cutoffs", std::get<casefile::QuantityProblem>(speed).found, expected);
    else if (quantity->negative())
      s.problem("cutoffs", "\"" + text + "\"", expected);
    else
      cutoffs.push_back(*quantity);
  }
  std::sort(cutoffs.begin(), cutoffs.end());
  output.own = std::move(cutoffs);
}

template <class Real>
class RatesAboveOutput : public TableOutput<Real> {
 public:
  RatesAboveOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                   const RunContext<Real>& run)
      : TableOutput<Real>(spec, folder, run), partners_(run.partners) {
    for (const auto& cutoff : spec.own_keys<Cutoffs>()) cutoffs_.push_back(cutoff.to<Real>());
    from_.resize(cutoffs_.size() + 1, PartnerTally<Real>(partners_.count()));
  }

 protected:
  void archive_record(Archive& a) override { a(from_); }

  void record(const ImpactFacts<Real>& f) override {
    const Real& approach = f.outcome.approach_speed;
    const Real speed = approach > 0 ? approach : Real(0);
    of_partner(f, from_[bin_of<Real>(cutoffs_, speed)]).add(f.outcome.milling_dose);
  }

  void end_of_record(const engine::Simulation<Real>&, const Real& until) override {
    std::vector<Column> columns{
        {"cutoff", Column::Type::number, "m/s", "the approach speed from which on impacts count"}};
    add_partner_columns(columns, partners_, {"rate", Column::Type::number, "1/s", "collision rate"});
    add_partner_columns(columns, partners_, {"dose_rate", Column::Type::number, "W", "milling dose rate"});
    this->begin(std::move(columns), {this->window(until)});
    const Real duration = until - this->timer().from();
    if (!(duration > 0)) return;  // nothing defines a rate
    for (std::size_t k = 0; k < cutoffs_.size(); ++k) {
      PartnerTally<Real> above(partners_.count());
      for (std::size_t bin = cutoffs_.size(); bin > k; --bin)
        for (int p = 0; p < partners_.count(); ++p) above[p].add(from_[bin][p]);
      this->put(cutoffs_[k]);
      const auto put = [&](const Real& value) { this->put(value); };
      put_partners<Real>(
          above, [&](const Tally<Real>& t) { return Real(Real(t.impacts) / duration); }, put);
      put_partners<Real>(
          above, [&](const Tally<Real>& t) { return Real(t.energy.value() / duration); }, put);
    }
  }

 private:
  model::Partners partners_;
  std::vector<Real> cutoffs_;             ///< ascending [m/s]
  std::vector<PartnerTally<Real>> from_;  ///< below all cutoffs, then from each up to the next
};

}  // namespace edmill::output
