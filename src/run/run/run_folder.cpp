#include "run/run_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>

#include "base/errors.hpp"
#include "base/version.hpp"
#include "casefile/quantity.hpp"
#include "io/json_text.hpp"

namespace edmill::run {

namespace fs = std::filesystem;

namespace {

constexpr std::pair<const char*, const char*> encodings[] = {{".csv", "text/csv"},
    {".json", "application/json"}, {".toml", "application/toml"}, {".h5", "application/x-hdf5"},
    {".x3d", "model/x3d+xml"}, {".pvd", "application/xml"}, {".vtp", "application/xml"}};

std::string today() {
  std::time_t now = std::time(nullptr);
  if (const char* fixed = std::getenv("SOURCE_DATE_EPOCH")) now = std::atoll(fixed);
  std::tm date{};
  gmtime_r(&now, &date);
  return fmt::format("{:04}-{:02}-{:02}", date.tm_year + 1900, date.tm_mon + 1, date.tm_mday);
}

std::string id(const std::string& name) { return "{\"@id\": " + io::JsonText::of(name) + "}"; }

std::string entity(const std::string& name, const char* type, const std::string& others) {
  return ",\n    {\"@id\": " + io::JsonText::of(name) + ", \"@type\": \"" + type + "\", " + others +
      "}";
}

}  // namespace

RunFolder::RunFolder(
    fs::path place, const casefile::CaseSpec& spec, std::optional<io::Checkpoint> checkpoint)
    : place_(std::move(place)), checkpoint_(std::move(checkpoint)) {
  take(place_);
  const bool begins = !checkpoint_ || (checkpoint_->state.empty() && checkpoint_->result.empty());
  if (begins) {
    io::require_no_checkpoint(place_);
    io::require_own_files(place_, {"case.toml", "final_state.csv", "summary.json", crate_file});
    if (fs::exists(place_ / "runs") && fs::exists(place_ / "runs.csv"))
      throw InputError(place_.string() +
          ": this folder has the runs of a sweep, an optimisation or several seeds: use another "
          "--out");
  }
  if (!begins && io::read_checkpoint(place_).state != checkpoint_->state)
    throw InputError(io::checkpoint_place(place_).string() +
        ": another process has just changed this checkpoint: run one at a time");
  for (const auto& output : spec.outputs) {
    if (checkpoint_) io::Destination(place_ / output.folder / output.file).require_file();
    take(place_ / output.folder);
  }
  // A run that continues may still be refused, and must then leave everything unchanged.
  if (begins) remove_leftovers();
}

/// Makes a folder when it is absent, and keeps other processes out.
void RunFolder::take(const fs::path& folder) {
  io::prepare_folder(folder);
  const auto one_of_paths = fs::canonical(folder);
  if (std::find(folders_.begin(), folders_.end(), one_of_paths) != folders_.end()) return;
  folders_.push_back(one_of_paths);
  locks_.emplace_back(folder);
}

RunFolder::~RunFolder() {
  own_files_.clear();
  std::error_code error;
  if (!fs::exists(io::checkpoint_place(place_), error) && !error) remove_leftovers();
}

void RunFolder::remove_leftovers() const {
  for (const auto& folder : folders_) io::remove_temporaries(folder);
  for (const auto& folder : io::recorded_folders(place_)) io::remove_temporaries(folder);
}

Checkpoints RunFolder::checkpoints() {
  if (!checkpoint_) return {};
  const auto save = [this](const std::string& state) {
    checkpoint_->state = state;
    io::write_checkpoint(place_, *checkpoint_);
  };
  return {parse_checkpoint_interval(checkpoint_->interval), save, checkpoint_->state};
}

void RunFolder::write(const std::string& name, const std::function<void(std::ostream&)>& put) {
  auto& file = own_files_.emplace_back(place_ / name);
  put(file.stream());
  file.complete();
}

void RunFolder::write_crate(const std::string& case_digest, const std::string& precision,
    const std::vector<fs::path>& files) {
  std::string parts, entities;
  for (const auto& file : files) {
    const auto name = file.generic_string();
    parts += (parts.empty() ? "" : ", ") + id(name);
    std::string others = "\"name\": " + io::JsonText::of(name);
    for (const auto& [ending, encoding] : encodings)
      if (file.extension() == ending)
        others += fmt::format(", \"encodingFormat\": \"{}\"", encoding);
    entities += entity(name, "File", others);
  }
  const auto dataset = fmt::format(
      "\"name\": \"Simulation of a ball mill\", \"description\": \"Simulation of a ball mill by "
      "edmill {} in {}; case.toml has digest {}\", \"datePublished\": \"{}\", \"hasPart\": [{}], "
      "\"mentions\": {{\"@id\": \"#run\"}}",
      version(), precision, case_digest, today(), parts);
  const auto action = "\"name\": \"edmill run\", \"instrument\": " + id("#edmill") +
      ", \"object\": " + id("case.toml") + ", \"result\": [" + parts + "]";
  const auto program = "\"name\": \"edmill\", \"softwareVersion\": \"" + version() + "\"";
  write(crate_file, [&](std::ostream& out) {
    out << "{\n  \"@context\": \"https://w3id.org/ro/crate/1.1/context\",\n  \"@graph\": [\n    "
           "{\"@id\": \"ro-crate-metadata.json\", \"@type\": \"CreativeWork\", \"about\": "
           "{\"@id\": \"./\"}, \"conformsTo\": {\"@id\": \"https://w3id.org/ro/crate/1.1\"}}"
        << entity("./", "Dataset", dataset) << entity("#run", "CreateAction", action)
        << entity("#edmill", "SoftwareApplication", program) << entities << "\n  ]\n}\n";
  });
}

void RunFolder::commit(std::vector<io::WholeFile*> files) {
  for (auto& own : own_files_) files.push_back(&own);
  std::vector<fs::path> places;
  for (const auto* file : files) places.push_back(file->place());
  io::record_files(place_, places);
  for (auto* file : files) file->commit();
  own_files_.clear();
  io::remove_other_files(place_, places);
}

void RunFolder::remove_checkpoint(const std::string& result) {
  if (!checkpoint_) return;
  if (checkpoint_->result.empty()) {
    // A run killed between the steps below must not continue: its temporary files go.
    checkpoint_->state.clear();
    checkpoint_->result = result;
    io::write_checkpoint(place_, *checkpoint_);
  }
  // Leftovers go before the checkpoint, without which they would not be found.
  remove_leftovers();
  fs::remove(io::checkpoint_place(place_));
}

CheckpointInterval parse_checkpoint_interval(const std::string& text) {
  const std::string mark = " simulated";
  const bool simulated = text.ends_with(mark);
  const auto parsed = casefile::parse_quantity(
      text.substr(0, text.size() - (simulated ? mark.size() : 0)), casefile::Dimension::time);
  const auto* time = std::get_if<casefile::Quantity>(&parsed);
  if (!time || !time->positive())
    throw InputError("--checkpoint: found " +
        (time ? "\"" + text + "\"" : std::get<casefile::QuantityProblem>(parsed).found) +
        ", expected a positive time, such as '10 min' by the clock or '2 s simulated'");
  return {time->to<double>(), simulated};
}

}  // namespace edmill::run
