// An output that is one file, to which each impact adds.
#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "output/output.hpp"

namespace edmill::output {

template <class Real, class File>
class OneFileOutput : public Output<Real> {
 public:
  /// @param arguments  of the file's constructor, after its place
  template <class... Arguments>
  OneFileOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                const RunContext<Real>& run, Arguments&&... arguments)
      : Output<Real>(spec, run),
        file_(folder / spec.folder / spec.file, std::forward<Arguments>(arguments)...) {}

  void complete() override { file_.complete(); }
  void commit() override { file_.commit(); }
  std::vector<std::filesystem::path> places() const override { return file_.places(); }

 protected:
  void archive_record(Archive& a) override { a(file_); }

  File file_;
};

}  // namespace edmill::output
