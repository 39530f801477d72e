// One page that shows runs side by side.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/rate_of.hpp"
#include "report/run_folder.hpp"

namespace edmill::report {

/// Whether two rates differ: the 95 % interval of their difference, by half-widths in quadrature, leaves out
/// zero. Nothing where a rate has no interval.
std::optional<bool> differ(const RateOf& a, const RateOf& b);

/// @param runs  two or more
std::string comparison_page(const std::vector<RunFolder>& runs);

/// @throws InputError when a folder is no run, or the file cannot be written
void write_comparison(const std::vector<std::string>& folders, const std::filesystem::path& file);

}  // namespace edmill::report
