// SPDX-License-Identifier: Apache-2.0
// Standard input as a file that readers can open by its name, and what is asked of standard output.
#pragma once

#include <stop_token>
#include <string>

#include "files/base/data_path.h"
#include "files/base/error.h"

namespace weft::files {

// If `file` is kStandardInput, takes in all of it; from then on the path is that of a file without
// another name, which vanishes with the process. Errors: kUsage without a format, or for one whose
// files are read by their names; kUnreadableInput.
Result<void> take_standard_input(const DataPath& file, const std::stop_token& stop);

// Succeeds unless `file` is kStandardOutput without a format; otherwise kUsage, with `formats`,
// which lists those that there are.
Result<void> check_has_format(const DataPath& file, const std::string& formats);

}  // namespace weft::files
