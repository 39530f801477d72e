// The outputs of a case, as one observer.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "casefile/case_spec.hpp"
#include "engine/simulation.hpp"
#include "io/atomic_file.hpp"

namespace edmill::output {

template <class Real> class Output;

template <class Real> class Outputs : public engine::Observer<Real> {
 public:
  /// Opens the files.
  /// @param mill  of the run; a program's own vessel takes the place of the case's
  /// @throws InputError when one cannot be written, or needs surfaces that the vessel does not have
  Outputs(const casefile::CaseSpec& spec, const model::Mill<Real>& mill,
      const std::filesystem::path& folder, const Real& start);
  ~Outputs() override;

  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override;
  void on_end(const engine::Simulation<Real>& simulation);
  void archive(Archive& a) override;
  /// Writes the remaining rows of all files.
  /// @param goes_on  the run will be resumed: files that it shares with other runs get its rows
  /// only at its end
  /// @return the files to be put in place
  std::vector<io::WholeFile*> complete(bool goes_on);
 private:
  std::vector<std::unique_ptr<Output<Real>>> outputs_;
  Real previous_;  ///< time of the last impact of any ball [s]
  int walls_;      ///< of the vessel
};

}  // namespace edmill::output
