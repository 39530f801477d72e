#include "io/crate.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <ctime>

#include "base/version.hpp"
#include "io/json_text.hpp"

namespace edmill::io {

namespace {

struct Kind {
  const char *ending, *encoding;
};
constexpr Kind kinds[] = {{".csv", "text/csv"},          {".json", "application/json"},
                          {".toml", "application/toml"}, {".h5", "application/x-hdf5"},
                          {".x3d", "model/x3d+xml"},     {".pvd", "application/xml"},
                          {".vtp", "application/xml"}};

std::string today() {
  std::time_t now = std::time(nullptr);
  if (const char* fixed = std::getenv("SOURCE_DATE_EPOCH")) now = std::atoll(fixed);
  std::tm date{};
  gmtime_r(&now, &date);
  return fmt::format("{:04}-{:02}-{:02}", date.tm_year + 1900, date.tm_mon + 1, date.tm_mday);
}

std::string id(const std::string& name) { return "{\"@id\": " + JsonText::of(name) + "}"; }

std::string entity(const std::string& name, const char* type, const std::string& others) {
  return ",\n    {\"@id\": " + JsonText::of(name) + ", \"@type\": \"" + type + "\", " + others + "}";
}

}  // namespace

std::string crate_text(const Crate& crate) {
  std::string parts, entities;
  for (const auto& file : crate.files) {
    const auto name = file.generic_string();
    parts += (parts.empty() ? "" : ", ") + id(name);
    std::string others = "\"name\": " + JsonText::of(name);
    for (const auto& kind : kinds)
      if (file.extension() == kind.ending)
        others += fmt::format(", \"encodingFormat\": \"{}\"", kind.encoding);
    entities += entity(name, "File", others);
  }
  const std::string about =
      fmt::format("Simulation of a ball mill by edmill {} in {}; case.toml has digest {}", version(),
                  crate.precision, crate.case_digest);
  return "{\n  \"@context\": \"https://w3id.org/ro/crate/1.1/context\",\n  \"@graph\": [\n    "
         "{\"@id\": \"ro-crate-metadata.json\", \"@type\": \"CreativeWork\", \"about\": {\"@id\": "
         "\"./\"}, \"conformsTo\": {\"@id\": \"https://w3id.org/ro/crate/1.1\"}}" +
         entity("./", "Dataset",
                fmt::format("\"name\": {}, \"description\": {}, \"datePublished\": \"{}\", \"hasPart\": "
                            "[{}], \"mentions\": {{\"@id\": \"#run\"}}",
                            JsonText::of(std::string("Simulation of a ball mill")), JsonText::of(about),
                            today(), parts)) +
         entity("#run", "CreateAction",
                "\"name\": \"edmill run\", \"instrument\": " + id("#edmill") +
                    ", \"object\": " + id("case.toml") + ", \"result\": [" + parts + "]") +
         entity("#edmill", "SoftwareApplication",
                fmt::format("\"name\": \"edmill\", \"softwareVersion\": {}", JsonText::of(version()))) +
         entities + "\n  ]\n}\n";
}

}  // namespace edmill::io
