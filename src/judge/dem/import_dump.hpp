// Converts a dump of frames to a log of contacts.
#pragma once

#include <atomic>

#include "casefile/case_spec.hpp"
#include "dem/contacts.hpp"
#include "identify/assumed.hpp"

namespace edmill::dem {

using casefile::CaseSpec;

struct ImportOptions {
  std::string dump, log;             ///< files to read and to write
  std::string deck;                  ///< deck that made the dump: time step, units, frame; optional
  std::optional<double> time_step;   ///< [s]
  std::optional<std::string> units;  ///< "si", "cgs", "mm", ...
  Vector origin{0, 0, 0};            ///< of the dump, in the case [m]
  identify::Axes axes{};             ///< of the case, in those of the dump
  bool in_vessel = false;            ///< places and velocities are those in the vessel's frame
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double time, std::uint64_t contacts)> progress = {};
};

struct Imported {
  std::string log;
  ContactLogFacts facts = {};
  ByClass<std::uint64_t> counts{};
  bool interrupted = false;  ///< the log contains what was read until then

  void count(const Contact& contact) {
    const auto kind = static_cast<std::size_t>(contact.kind);
    ++facts.contacts;
    ++counts[kind];
    facts.doses[kind] += contact.dose;
  }
};

/// Writes the log of contacts. Memory does not depend on the length of a dump of frames.
/// @throws InputError when it cannot be read, lacks what is needed or has other balls than the case
Imported import_dump(const CaseSpec& spec, const ImportOptions& options);

std::string table(const Imported& imported);

/// "x z -y": the case's X, Y and Z are the dump's x, z and -y. @throws InputError
identify::Axes axes_from(const std::string& text);

}  // namespace edmill::dem
