// SPDX-License-Identifier: Apache-2.0
#include "client/call/mesh_report.h"

#include <algorithm>

namespace weft::client {

void add_warnings(const std::vector<std::string>& warnings, MeshReport& report) {
  for (const std::string& warning : warnings)
    if (std::find(report.warnings.begin(), report.warnings.end(), warning) == report.warnings.end())
      report.warnings.push_back(warning);
}

}  // namespace weft::client
