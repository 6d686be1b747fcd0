// SPDX-License-Identifier: Apache-2.0
// The numbers by which a file calls its points, in the order in which it lists them: any, each
// once.
//
//   NodeNumbers numbers;
//   numbers.add(scanner, "the point number");                    // for each point
//   Result<std::uint32_t> i = numbers.read(scanner, "a corner");  // index of a point, from 0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <unordered_map>

#include "files/base/error.h"
#include "files/bytes/line_scanner.h"

namespace weft::files {

class NodeNumbers {
 public:
  // Reads the number of the next point. Error: it is that of another point, too. REQUIRES: fewer
  // than 2^32 points.
  Result<void> add(LineScanner& scanner, std::string_view what);

  // The index of the point that has this number; nullopt if none has.
  std::optional<std::uint32_t> find(std::int64_t number) const;

  // Calls `act` with the index of each point whose number is first, first + step, ... and at most
  // `last`, in any order. Takes time in the points or in the numbers, whichever are fewer.
  // REQUIRES: step >= 1.
  void each_of(std::int64_t first, std::int64_t last, std::int64_t step,
               const std::function<void(std::uint32_t)>& act) const;

  // Reads the number of a point, as its index. Error: no point has it.
  Result<std::uint32_t> read(LineScanner& scanner, std::string_view what) const;

 private:
  std::int64_t first_ = 1;
  std::int64_t count_ = 0;
  std::int64_t least_ = 0;
  std::int64_t most_ = 0;
  // The index of each number; empty while they count up from the first, as they mostly do.
  std::unordered_map<std::int64_t, std::uint32_t> index_;
};

}  // namespace weft::files
