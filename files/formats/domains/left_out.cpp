// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/left_out.h"

#include <vector>

#include "files/base/text.h"

namespace weft::files {

void LeftOut::add(Kind kind, const std::string& path) {
  if (first_.empty()) first_ = path;
  ++counts_[kind];
}

std::string LeftOut::sentence() const {
  constexpr const char* kOne[] = {"ring without an area", "line without a length",
                                  "empty geometry"};
  constexpr const char* kMany[] = {"rings without an area", "lines without a length",
                                   "empty geometries"};
  std::vector<std::string> parts;
  for (std::size_t kind = 0; kind < counts_.size(); ++kind) {
    const std::size_t count = counts_[kind];
    if (count > 0)
      parts.push_back(with_separators(count) + " " + (count == 1 ? kOne : kMany)[kind]);
  }
  if (parts.empty()) return "";
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i)
    text += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
  return text + (this->count() == 1 ? " is left out: " : " are left out, the first is ") + first_;
}

}  // namespace weft::files
