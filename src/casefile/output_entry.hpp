// How an entry [[output]] is read. What is special to a type of output stands with that output:
// output/registry.hpp
#pragma once

#include <span>

#include "casefile/key_reader.hpp"
#include "casefile/output_columns.hpp"

namespace edmill::casefile {

/// Reads the keys that an entry of one type has beyond those of every entry.
using ReadOutputKeys = void(Section& entry, const CaseSpec& spec, OutputSpec& output);

struct OutputType {
  std::string_view name;       ///< `type` in a case
  std::string_view extension;  ///< of its file unless the entry names one; ".csv" for tables
  std::string_view what;       ///< it writes, for readers
  ReadOutputKeys* read;
  std::span<const KeyText> keys = {};        ///< that `read` looks up
  void (*see)(const SeeKey& see) = nullptr;  ///< shows those of a struct that lists them
};

/// Of outputs without keys of their own.
inline void read_no_keys(Section&, const CaseSpec&, OutputSpec&) {}
/// Reads keys that a struct lists, into OutputSpec::own.
template <class Keys>
void read_own(Section& entry, const CaseSpec&, OutputSpec& output) {
  Keys keys;
  read_keys(entry, keys);
  output.own = keys;
}

/// Every type of output. The registry of the outputs defines it, and makes outputs from the same rows.
std::span<const OutputType> output_types();

/// Reads one entry and adds it to the case.
void read_output(Section entry, CaseSpec& spec);

}  // namespace edmill::casefile
