#include "app/check_log.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "dem/contacts.hpp"
#include "io/csv_reader.hpp"
#include "io/input_file.hpp"
#include "io/json_text.hpp"
#include "logs/event_log.hpp"

namespace edmill::app {

namespace {

constexpr int version = 1;
constexpr std::size_t most_problems = 10;

/// The unit of a column by its name: "vx_before" is a velocity.
std::string unit_of(const std::string& column) {
  const auto name = column.starts_with("partner_") ? column.substr(8) : column;
  if (name == "time" || name == "end" || name.starts_with("free_")) return "s";
  if (name.ends_with("_speed")) return "m/s";
  if (name == "milling_dose" || name == "wall_work") return "J";
  const auto quantity = name.substr(0, name.find('_'));
  if (quantity.size() == 1 && quantity >= "x" && quantity <= "z") return "m";
  if (quantity.size() == 2 && quantity[0] == 'v') return "m/s";
  if (quantity.size() == 2 && quantity[0] == 'w') return "rad/s";
  return "";
}

/// Problems of single lines, of which only the first are listed.
class Problems {
 public:
  explicit Problems(std::string file) : file_(std::move(file)) {}
  void add(std::uint64_t line, const std::string& problem) {
    if (list_.size() < most_problems) list_.push_back(fmt::format("{}:{}: {}", file_, line, problem));
    ++count_;
  }
  /// Those of lines that cannot be read.
  void add(const std::vector<std::string>& problems) {
    list_.insert(list_.end(), problems.begin(), problems.end());
    count_ += problems.size();
  }
  void throw_any() {
    if (count_ > list_.size())
      list_.push_back(fmt::format("{}: {} more problems", file_, count_ - list_.size()));
    if (count_ > 0) throw InputError(list_);
  }

 private:
  std::string file_;
  std::vector<std::string> list_;
  std::size_t count_ = 0;
};

/// @throws InputError when a comment before the header, "# collision log 2", names an unknown version
void check_version(const std::string& file) {
  io::InputFile in(file, "a collision log");
  std::string line;
  const std::string mark = "# collision log ";
  while (std::getline(in, line) && (line.empty() || line[0] == '#'))
    if (line.starts_with(mark) && trimmed(line.substr(mark.size())) != std::to_string(version))
      throw InputError(fmt::format("{}: the log has version {}, this program reads version {}", file,
                                   clean_text(line.substr(mark.size())), version));
}

void take_columns(LogDescription& log, const std::string& file) {
  const auto& known = logs::column_names();
  const io::CsvReader csv(file, "a collision log");
  for (const auto& name : csv.header())
    if (log.kind == "contacts" || std::find(known.begin(), known.end(), name) != known.end())
      log.columns.push_back({name, unit_of(name)});
    else if (name != "index")
      log.skipped.push_back(name);
}

void take_row(LogDescription& log, double time, int ball, bool with_wall, int partner) {
  ++log.rows;
  if (!log.first) log.first = time;
  log.last = std::max(log.last.value_or(time), time);
  log.balls = std::max({log.balls, ball + 1, with_wall ? 0 : partner + 1});
  if (with_wall) log.walls = std::max(log.walls, partner + 1);
}

void read_impacts(LogDescription& log, const std::string& file) {
  constexpr int any = 1000000000, walls = 1000;
  logs::EventLog in(file, {}, any, walls, 1e15);
  Problems problems(in.file());
  const auto next = [&]() -> std::optional<logs::LoggedEvent> {
    try {
      return in.next();
    } catch (const InputError& error) {
      problems.add(error.problems());
      return std::nullopt;
    }
  };
  while (const auto event = next()) {
    if (!event->problem.empty()) {
      problems.add(event->line, event->problem);
      continue;
    }
    if (event->earlier_by > 0)
      problems.add(event->line,
                   fmt::format("the time is {:g} s before that of an earlier line", event->earlier_by));
    take_row(log, event->time, event->ball, event->with_wall, event->partner);
  }
  problems.throw_any();
}

void read_contacts(LogDescription& log, const std::string& file) {
  dem::ContactLogReader in(file);
  while (const auto contact = in.next())
    take_row(log, contact->begin, contact->ball, contact->bodies == 1 && contact->partner >= 0,
             contact->partner);
}

}  // namespace

std::string LogDescription::text() const {
  std::string out = fmt::format("a log of {}, version {}\n", kind, version);
  const auto row = [&](const char* name, const std::string& value) {
    out += fmt::format("  {:<18}{}\n", name, value);
  };
  row("rows", std::to_string(rows));
  if (first) row("time", fmt::format("{:.6g} s to {:.6g} s", *first, *last));
  row("balls, walls", fmt::format("{}, {}", balls, walls));
  std::string names, others;
  for (const auto& column : columns)
    names +=
        (names.empty() ? "" : ", ") + column.name + (column.unit.empty() ? "" : " [" + column.unit + "]");
  for (const auto& name : skipped) others += (others.empty() ? "" : ", ") + name;
  row("columns", names);
  if (!others.empty()) row("skipped", others);
  return out;
}

std::string LogDescription::json() const {
  std::string list;
  for (const auto& column : columns)
    list += fmt::format("{}{{\"name\": {}, \"unit\": {}}}", list.empty() ? "" : ", ",
                        io::JsonText::of(column.name), io::JsonText::of(column.unit));
  return fmt::format(
      "{{\n  \"format\": \"collision log\",\n  \"version\": {},\n  \"kind\": \"{}\",\n  \"units\": \"SI\",\n "
      " "
      "\"frame\": \"inertial\",\n  \"columns\": [{}],\n  \"skipped\": {},\n  \"rows\": {},\n  \"first\": "
      "{},\n "
      " \"last\": {},\n  \"balls\": {},\n  \"walls\": {}\n}}\n",
      version, kind, list, io::JsonText::of(skipped), rows, io::JsonText::of(first), io::JsonText::of(last),
      balls, walls);
}

bool is_log(const std::string& file) try {
  io::InputFile in(file, "a log");
  std::string line;
  while (std::getline(in, line))
    if (const auto text = trimmed(line); !text.empty() && text[0] != '#')
      return text[0] != '[' && text.find_first_of(",;\t") != text.npos && text.find('=') == text.npos;
  return false;
} catch (const InputError&) {  // reading the case says why
  return false;
}

LogDescription describe_log(const std::string& file) {
  LogDescription log;
  log.kind = dem::is_contact_log(file) ? "contacts" : "impacts";
  check_version(file);
  take_columns(log, file);
  log.kind == "contacts" ? read_contacts(log, file) : read_impacts(log, file);
  return log;
}

}  // namespace edmill::app
