// Impacts by energy or by speed. docs/outputs.md, "spectra"
#pragma once

#include <cmath>

#include "casefile/output_entry.hpp"
#include "output/by_partner.hpp"
#include "output/log_bins.hpp"
#include "output/table_output.hpp"

namespace edmill::output {

struct SpectraKeys {
  bool of_speed = false;         ///< of energy otherwise
  casefile::Quantity low, high;  ///< [m/s] or [J]
  std::uint64_t bins_per_decade = 10;

  static void keys(auto& k, auto&& row) {
    row(casefile::Parameter{"bins_per_decade", Dimension::none, "in which impacts are counted",
                            casefile::table_size, "10"},
        k.bins_per_decade);
  }
};

inline constexpr casefile::KeyText spectra_keys[] = {
    {"of", "name", "`\"energy\"`", "this or `speed`"},
    {"low", "energy or speed", "`\"1e-9 J\"`, `\"1 mm/s\"`", "begin of the first bin"},
    {"high", "energy or speed", "`\"1 J\"`, `\"10 m/s\"`", "end of the last bin"}};

inline void read_spectra(casefile::Section& s, const casefile::CaseSpec&, casefile::OutputSpec& output) {
  SpectraKeys spectra;
  spectra.of_speed = s.choice("of", {"energy", "speed"}) == "speed";
  const bool speed = spectra.of_speed;
  const auto dimension = speed ? casefile::Dimension::speed : casefile::Dimension::energy;
  spectra.low = s.quantity("low", dimension, casefile::Quantity{1, speed ? 1000 : 1000000000});
  spectra.high = s.quantity("high", dimension, casefile::Quantity{speed ? 10 : 1});
  s.require(spectra.low.positive(), "low", "a value above 0: the bins are logarithmic");
  const double low = spectra.low.to<double>(), high = spectra.high.to<double>();
  const bool ascending = low > 0 && high > low * (1 + 1e-6) && std::isfinite(high);
  const bool low_is_wrong = s.has("low") && !s.has("high");
  s.require(ascending || !spectra.low.positive(), low_is_wrong ? "low" : "high",
            low_is_wrong ? "a value below high" : "a value above low");
  casefile::read_keys(s, spectra);
  output.own = spectra;
}

template <class Real>
class SpectraOutput : public TableOutput<Real> {
 public:
  SpectraOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                const RunContext<Real>& run)
      : TableOutput<Real>(spec, folder, run),
        partners_(run.partners),
        of_speed_(spec.own_keys<SpectraKeys>().of_speed),
        edges_(edges_of(spec.own_keys<SpectraKeys>())),
        spectra_(of_speed_ ? 2 : 3, Spectrum(edges_.size() + 1, PartnerTally<Real>(partners_.count()))) {}

 protected:
  void archive_record(Archive& a) override { a(spectra_); }

  void record(const ImpactFacts<Real>& f) override {
    const auto& o = f.outcome;
    if (of_speed_) {
      add(f, 0, o.approach_speed, o.milling_dose);
      add(f, 1, o.slip_speed, o.milling_dose);
    } else {
      const Real tangential = o.milling_dose - o.normal_dose;
      add(f, 0, o.normal_dose, o.normal_dose);
      add(f, 1, tangential, tangential);
      add(f, 2, o.milling_dose, o.milling_dose);
    }
  }

  void end_of_record(const engine::Simulation<Real>&, const Real& until) override {
    using enum Column::Type;
    const std::string unit = of_speed_ ? "m/s" : "J";
    std::vector<Column> columns{{"spectrum", text, "", "the part of the dose, or the speed, that is binned"},
                                {"bin", text, "", "number of the bin from 1, or below or above all"},
                                {"low", number, unit, "lower edge of the bin"},
                                {"high", number, unit, "upper edge of the bin, not in it"}};
    add_partner_columns(columns, partners_, {"impacts", integer, "1", "number of impacts"});
    add_partner_columns(
        columns, partners_,
        {"energy", number, "J", of_speed_ ? "dose of the impacts" : "this part of the dose of the impacts"});
    this->begin(std::move(columns), {this->window(until)});
    const std::vector<std::string> names = of_speed_
                                               ? std::vector<std::string>{"approach", "slip"}
                                               : std::vector<std::string>{"normal", "tangential", "total"};
    for (std::size_t s = 0; s < spectra_.size(); ++s)
      for (std::size_t bin = 0; bin < spectra_[s].size(); ++bin) {
        const bool below = bin == 0, above = bin == edges_.size();
        this->put(names[s], below ? "below" : above ? "above" : std::to_string(bin));
        this->put(io::value_if(!below, [&] { return edges_[bin - 1]; }),
                  io::value_if(!above, [&] { return edges_[bin]; }));
        const auto put = [&](const auto& value) { this->put(value); };
        const auto& tallies = spectra_[s][bin];
        put_partners<std::uint64_t>(
            tallies, [](const Tally<Real>& t) { return t.impacts; }, put);
        put_partners<Real>(
            tallies, [](const Tally<Real>& t) { return t.energy.value(); }, put);
      }
  }

 private:
  using Spectrum = std::vector<PartnerTally<Real>>;  ///< below the first edge, the bins, above the last

  static std::vector<Real> edges_of(const SpectraKeys& keys) {
    return log_edges<Real>(keys.low, keys.high, keys.bins_per_decade);
  }
  void add(const ImpactFacts<Real>& f, std::size_t spectrum, const Real& value, const Real& energy) {
    of_partner(f, spectra_[spectrum][bin_of<Real>(edges_, value)]).add(energy);
  }

  model::Partners partners_;
  bool of_speed_;
  std::vector<Real> edges_;
  std::vector<Spectrum> spectra_;
};

}  // namespace edmill::output
