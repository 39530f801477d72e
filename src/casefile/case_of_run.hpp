// A case as a run leaves it in its folder, and outputs beside those of its file.
#pragma once

#include <string>
#include <vector>

#include "casefile/case_spec.hpp"

namespace edmill::casefile {

/// The text of a case file, followed by the settings over it as comments, for readers.
std::string text_with_settings(const CaseSpec& spec);

/// The case that a run left in its folder: `text_with_settings` as a file. The file that the run began from
/// is not looked for; what cannot be known without it, the digest, is empty then.
/// @param settings  over the file, as the run had them
/// @throws InputError also when the case has another digest
CaseSpec read_case_of_run(const std::string& path, const std::vector<std::string>& settings,
                          const std::string& digest);

/// Adds the entries [[output]] of a text to a case.
/// @throws InputError when one is wrong, or its file's name is taken
void add_outputs(const std::string& text, const std::string& name, CaseSpec& spec);

}  // namespace edmill::casefile
