// SPDX-License-Identifier: Apache-2.0
// How the file of a domain is read: what of it is the domain, if it has layers and attributes, and
// whether it must be without faults.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace weft::files {

struct LayerOptions {
  std::vector<std::string> layers{};  // names; empty: the only one that holds anything
  std::string where{};                // an SQL expression of attributes; empty: all features
  // By the name of a property (feature_properties.h), the attribute of features that stands for it.
  std::map<std::string, std::string> attributes{};

  bool strict = false;    // refuse a file of which something is left out or repaired
  bool lonlat = false;    // coordinates are degrees, and rings are judged on the sphere
  bool even_odd = false;  // outlines in outlines are holes, so no warning tells of them

  // Whether a part of the file is wanted.
  bool wanted() const { return !layers.empty() || !where.empty() || !attributes.empty(); }
};

}  // namespace weft::files
