// Another code's collision log against the physics of a case, and what explains its violations.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "audit/audit.hpp"
#include "casefile/case_spec.hpp"
#include "identify/identify.hpp"

namespace edmill::app {

/// They override the case's section [audit].
struct AuditOptions {
  std::string log;
  std::vector<std::string> columns;  ///< "ours=theirs [unit]"
  std::optional<double> tolerance, gap_tolerance;
  std::optional<int> first_ball;
  std::string walls;
  bool from_start = false;
  bool identify = false;  ///< search for the cause
  std::size_t examples = 3;
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double time, std::uint64_t events)> progress{};
  identify::Progress searching{};  ///< called at each stage of a search for the cause
};

struct Audited {
  audit::Audit result;
  std::optional<identify::Identification> identified;

  std::string table() const;
  std::string json() const;
  std::string junit() const;
};

/// @throws InputError
Audited audit(const casefile::CaseSpec& spec, const AuditOptions& options);

}  // namespace edmill::app
