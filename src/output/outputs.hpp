// The outputs of a case, as one observer.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "casefile/case_spec.hpp"
#include "engine/simulation.hpp"

namespace edmill::output {

template <class Real>
class Output;

template <class Real>
class Outputs : public engine::Observer<Real> {
 public:
  /// Opens the files. @throws InputError when one cannot be written
  Outputs(const casefile::CaseSpec& spec, const std::filesystem::path& folder, const Real& start);
  ~Outputs() override;

  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override;
  void on_end(const engine::Simulation<Real>& simulation) override;
  void archive(Archive& a) override;
  /// Puts all files in place. A run that goes on later adds its rows to files of other runs only then.
  void commit(bool goes_on);

 private:
  std::vector<std::unique_ptr<Output<Real>>> outputs_;
  Real previous_;  ///< time of the last impact of any ball [s]
  int walls_;      ///< of the vessel
};

}  // namespace edmill::output
