// SPDX-License-Identifier: Apache-2.0
// Counts what of a file is left out because nothing can be meshed of it, and makes one sentence of
// it, however much there is:
//   "3 rings without an area and 1 empty geometry are left out, the first is features[4].geometry"
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace weft::files {

class LeftOut {
 public:
  enum Kind { kRing, kLine, kGeometry };

  // `path`: its place in the file.
  void add(Kind kind, const std::string& path);

  // Empty if nothing was.
  std::string sentence() const;
  // Its place in the file.
  const std::string& first() const { return first_; }
  std::size_t count() const { return counts_[kRing] + counts_[kLine] + counts_[kGeometry]; }

 private:
  std::array<std::size_t, 3> counts_{};  // by kind
  std::string first_;
};

}  // namespace weft::files
