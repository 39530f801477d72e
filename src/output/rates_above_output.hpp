// Rates of the impacts above speed cutoffs. docs/outputs.md, "rates_above"
#pragma once

#include "output/by_partner.hpp"
#include "output/log_bins.hpp"
#include "output/output.hpp"

namespace edmill::output {

template <class Real>
class RatesAboveOutput : public TableOutput<Real> {
 public:
  RatesAboveOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                   const RunFacts<Real>& run)
      : TableOutput<Real>(spec, folder, run) {
    for (const auto& cutoff : spec.cutoffs) cutoffs_.push_back(cutoff.to<Real>());
    from_.resize(cutoffs_.size() + 1);
  }

 protected:
  void archive_record(Archive& a) override { a(from_); }

  void record(const Seen<Real>& seen) override {
    const Real& approach = seen.impact.outcome.approach_speed;
    const Real speed = approach > 0 ? approach : Real(0);
    from_[bin_of<Real>(cutoffs_, speed)].add(partner_of(seen.facts), seen.facts.milling_dose);
  }

  void end_of_record(const engine::Simulation<Real>&, const Real& until) override {
    this->write_window(until);
    this->out() << '\n';
    this->describe("cutoff", "the approach speed from which on impacts count");
    this->describe("rate", "collision rate");
    this->describe("dose_rate", "milling dose rate");
    auto& out = this->out();
    out << title_of("cutoff", "m/s") << partner_titles("rate", "1/s") << partner_titles("dose_rate", "W")
        << '\n';
    const Real duration = until - this->timer().from();
    if (!(duration > 0)) return;  // nothing defines a rate
    for (std::size_t k = 0; k < cutoffs_.size(); ++k) {
      PartnerTally<Real> above;
      for (std::size_t bin = cutoffs_.size(); bin > k; --bin) above.add(from_[bin]);
      out << to_text<Real>(cutoffs_[k]);
      write_partners<Real>(out, [&](int p) { return Real(Real(above.impacts[p]) / duration); });
      write_partners<Real>(out, [&](int p) { return Real(above.energy[p].value() / duration); });
      out << '\n';
    }
  }

 private:
  std::vector<Real> cutoffs_;             ///< ascending [m/s]
  std::vector<PartnerTally<Real>> from_;  ///< below all cutoffs, then from each up to the next
};

}  // namespace edmill::output
