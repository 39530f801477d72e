// Contacts that last, as a table: what `edmill import` writes and `audit`, `compare` and `limit` read.
// docs/dem.md
#pragma once

#include <cstdio>
#include <memory>
#include <ostream>
#include <string>

#include "dem/contact_finder.hpp"
#include "io/csv_reader.hpp"

namespace edmill::dem {

/// What holds for a whole log.
struct ContactLogFacts {
  std::string dump;  ///< that it was made from
  std::uint64_t frames = 0, contacts = 0;
  double first = 0, last = 0;  ///< times of the frames [s]
  FrameStatistics statistics;
  double mass_factor = 1,
         radius_factor = 1;  ///< of the dump's balls over the case's; 1 where it does not tell
  int facets = 0;            ///< of the prism that stands for a round wall; 0 for a round wall
  std::array<double, contact_class_names.size()> doses{};  ///< by class [J]

  double dose() const;
  double duration() const { return last - first; }
  /// Made from a list of contacts with walls: no frames, no pairs, no gravity, no places.
  bool of_list() const { return frames == 0; }
};

/// Collects rows on disk until the facts are known.
class ContactLogWriter {
 public:
  ContactLogWriter();
  void add(const Contact& contact);
  void write(std::ostream& out, const ContactLogFacts& facts);

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> rows_;
};

/// Whether a file is such a log, by its first line.
bool is_contact_log(const std::string& file);

class ContactLogReader {
 public:
  /// @throws InputError when it is none
  explicit ContactLogReader(const std::string& file);

  const ContactLogFacts& facts() const { return facts_; }
  /// @throws InputError for a log of a list, whose dose rate is not that of all contacts
  void need_frames() const;
  /// The next contact; nothing at the end. @throws InputError with the bad lines
  std::optional<Contact> next();

 private:
  std::optional<Contact> parse();

  ContactLogFacts facts_;
  io::CsvReader csv_;
};

}  // namespace edmill::dem
