// SPDX-License-Identifier: Apache-2.0
// What of a file with layers and attributes is the domain.
#pragma once

#include <string>
#include <vector>

namespace weft::client {

struct LayerOptions {
  std::vector<std::string> layers{};  // names; empty: the only one that holds anything
  std::string where{};                // an SQL expression of attributes; empty: all features

  bool wanted() const { return !layers.empty() || !where.empty(); }
};

}  // namespace weft::client
