// Impacts by energy or by speed. docs/outputs.md, "spectra"
#pragma once

#include "output/by_partner.hpp"
#include "output/log_bins.hpp"
#include "output/output.hpp"

namespace edmill::output {

template <class Real>
class SpectraOutput : public TableOutput<Real> {
 public:
  SpectraOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                const RunFacts<Real>& run)
      : TableOutput<Real>(spec, folder, run),
        of_speed_(spec.spectra.of_speed),
        edges_(log_edges<Real>(spec.spectra.low, spec.spectra.high, spec.spectra.bins_per_decade)),
        spectra_(of_speed_ ? 2 : 3, Spectrum(edges_.size() + 1)) {}

 protected:
  void archive_record(Archive& a) override { a(spectra_); }

  void record(const Seen<Real>& seen) override {
    const auto& f = seen.facts;
    const auto& o = seen.impact.outcome;
    if (of_speed_) {
      add(f, 0, o.approach_speed, f.milling_dose);
      add(f, 1, o.slip_speed, f.milling_dose);
    } else {
      const Real tangential = f.milling_dose - f.dose_normal;
      add(f, 0, f.dose_normal, f.dose_normal);
      add(f, 1, tangential, tangential);
      add(f, 2, f.milling_dose, f.milling_dose);
    }
  }

  void end_of_record(const engine::Simulation<Real>&, const Real& until) override {
    this->write_window(until);
    this->out() << '\n';
    this->describe("low", "lower edge of the bin");
    this->describe("high", "upper edge of the bin, not in it");
    this->describe("energy", of_speed_ ? "dose of the impacts" : "this part of the dose of the impacts");
    const std::string unit = of_speed_ ? "m/s" : "J";
    auto& out = this->out();
    out << "spectrum,bin," << title_of("low", unit) << ',' << title_of("high", unit)
        << partner_titles("impacts", "1") << partner_titles("energy", "J") << '\n';
    const std::vector<std::string> names = of_speed_
                                               ? std::vector<std::string>{"approach", "slip"}
                                               : std::vector<std::string>{"normal", "tangential", "total"};
    for (std::size_t s = 0; s < spectra_.size(); ++s)
      for (std::size_t bin = 0; bin < spectra_[s].size(); ++bin) {
        const bool below = bin == 0, above = bin == edges_.size();
        out << names[s] << ','
            << (below   ? "below"
                : above ? "above"
                        : std::to_string(bin))
            << ',' << (below ? "" : to_text<Real>(edges_[bin - 1])) << ','
            << (above ? "" : to_text<Real>(edges_[bin]));
        const auto& tally = spectra_[s][bin];
        write_partners<std::uint64_t>(out, [&](int k) { return tally.impacts[k]; });
        write_partners<Real>(out, [&](int k) { return tally.energy[k].value(); });
        out << '\n';
      }
  }

 private:
  using Spectrum = std::vector<PartnerTally<Real>>;  ///< below the first edge, the bins, above the last

  void add(const model::ImpactFacts<Real>& f, std::size_t spectrum, const Real& value, const Real& energy) {
    spectra_[spectrum][bin_of<Real>(edges_, value)].add(partner_of(f), energy);
  }

  bool of_speed_;
  std::vector<Real> edges_;
  std::vector<Spectrum> spectra_;
};

}  // namespace edmill::output
