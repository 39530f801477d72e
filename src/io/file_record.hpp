// `.edmill-files`: what edmill has put into a folder, so that a later run takes away just that.
#pragma once

#include <filesystem>
#include <vector>

namespace edmill::io {

inline constexpr const char* file_record_name = ".edmill-files";

/// Adds files to the record of a folder; to be called before they are put in place. Files outside the folder
/// are left out.
/// @throws std::runtime_error when the record was not written
void record_files(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& files);

/// Removes the recorded files that are not among these, and folders that are empty then. These become the
/// record.
/// @throws std::runtime_error when the record was not written
void remove_other_files(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& files);

/// Folders below this one that hold recorded files.
std::vector<std::filesystem::path> recorded_folders(const std::filesystem::path& folder);

}  // namespace edmill::io
