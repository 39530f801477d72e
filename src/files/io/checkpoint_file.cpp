#include "io/checkpoint_file.hpp"

#include <fstream>

#include "base/digest.hpp"
#include "base/errors.hpp"
#include "base/version.hpp"
#include "io/atomic_file.hpp"
#include "io/input_file.hpp"
#include "io/output_folder.hpp"

namespace edmill::io {

namespace fs = std::filesystem;

// The first line, with the number of the format. Then a line with the SHA-256 of what follows.
const std::string magic = "edmill checkpoint 4\n";
constexpr std::size_t digest_size = 64;

fs::path checkpoint_place(const fs::path& folder) { return folder / "checkpoint"; }

void require_no_checkpoint(const fs::path& folder) {
  if (const auto found = checkpoint_place(folder); fs::exists(found))
    throw InputError(found.string() +
        ": this folder has an unfinished run: continue with `edmill resume " + folder.string() +
        "`, or remove this file");
}

void write_checkpoint(const fs::path& folder, Checkpoint checkpoint) {
  std::string program = version(), program_commit = commit();
  Archive archive;
  archive(program, program_commit, checkpoint);
  AtomicFile file(checkpoint_place(folder));
  file.stream() << magic << sha256(archive.bytes()) << '\n' << archive.bytes();
  file.sync();
  file.commit();
  sync_to_disk(folder);
}

Checkpoint read_checkpoint(const fs::path& folder) {
  const auto place = checkpoint_place(folder);
  const auto fail = [&](const std::string& problem) {
    throw InputError(place.string() + ": " + problem);
  };
  std::error_code ignored;
  if (!std::ifstream(place) || !fs::is_regular_file(place, ignored))
    fail("no such file: the folder has no unfinished run");
  const std::string text = content_of(place);
  const std::size_t begin = magic.size() + digest_size + 1;
  if (text.size() < begin || text.substr(0, magic.size()) != magic)
    fail("this file is not a checkpoint of a run");
  const std::string_view body = std::string_view(text).substr(begin);
  if (sha256(body) + '\n' != text.substr(magic.size(), digest_size + 1))
    fail("the checkpoint is damaged");

  Archive archive(body);
  std::string program, program_commit;
  archive(program, program_commit);
  if (program != version() || program_commit != commit())
    throw InputError(place.string() + ": found a checkpoint of edmill " + program + " (" +
        program_commit + "), expected one of this program, " + version() + " (" + commit() + ")");
  Checkpoint checkpoint;
  archive(checkpoint);
  archive.finish();
  return checkpoint;
}

}  // namespace edmill::io
