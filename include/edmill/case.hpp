// A case: everything that a run depends on.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "edmill/errors.hpp"

namespace edmill {

namespace casefile {
struct CaseSpec;
}

template <class Real> class Run;
struct CaseAccess;

/// A case as read from its file, in exact quantities; no scalar is chosen yet. Copies share their
/// data.
class Case {
 public:
  /// Reads and checks a case file; its keys: docs/reference.md.
  /// @param path      of the file
  /// @param settings  "section.key=value" texts that override the file, as with `edmill run --set`
  /// @throws InputError with every problem of the file
  static Case read(const std::string& path, const std::vector<std::string>& settings = {});
  /// Reads and checks the text of a case; messages refer to it as `name`.
  static Case parse(const std::string& text, const std::string& name = "case.toml",
      const std::vector<std::string>& settings = {});

  /// SHA-256 of the canonical text: in one scalar, cases with the same digest give the same bits.
  const std::string& digest() const;
  /// Scalar that the case requests, "double" or "float128" for example; a program may choose
  /// another one.
  const std::string& precision() const;
  int ball_count() const;
 private:
  template <class Real> friend class Run;
  friend struct CaseAccess;
  explicit Case(casefile::CaseSpec spec);
  std::shared_ptr<const casefile::CaseSpec> spec_;
};

}  // namespace edmill
