// Checkpoints: the file around the state, with a digest that fits, and the case in it. What is in
// the state: tests/core/engine/saved_state_test.cpp.
#include "base/digest.hpp"
#include "base/errors.hpp"
#include "base/version.hpp"
#include "casefile/case_spec.hpp"
#include "input.hpp"
#include "io/checkpoint_file.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edmill;
  std::string program = version(), program_commit = commit();
  Archive begin;
  begin(program, program_commit);
  const auto rest = fuzz::text_of(data, size);
  for (const auto& body : {begin.bytes() + std::string(rest), std::string(rest)}) {
    const auto file =
        fuzz::file_of("edmill checkpoint 4\n" + sha256(body) + "\n" + body, "checkpoint");
    try {
      const auto checkpoint = io::read_checkpoint(file.parent_path());
      casefile::parse_case(checkpoint.case_text, checkpoint.case_file, checkpoint.overrides);
    } catch (const InputError&) {
    }
  }
  fuzz::file_of(rest, "checkpoint");
  return 0;
}
