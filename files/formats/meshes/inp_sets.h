// SPDX-License-Identifier: Apache-2.0
// The sets of elements of an input file of Abaqus, by names in which the case of letters does not
// matter. A set lists numbers, ranges of numbers and other sets, of which some may come later or
// never.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/bytes/node_numbers.h"

namespace weft::files {

class InpSets {
 public:
  struct Range {
    std::int64_t first, last, step;
  };

  // The set of this name, which is new if there was none. Before the last point of a name stands
  // that of an instance: "Plate-1.fluid".
  std::size_t of(std::string_view name);
  const std::string& name(std::size_t set) const { return sets_[set].name; }
  std::size_t size() const { return sets_.size(); }

  // REQUIRES: step >= 1.
  void add(std::size_t set, const Range& numbers) { sets_[set].ranges.push_back(numbers); }
  void add_set(std::size_t set, std::size_t other) { sets_[set].others.push_back(other); }
  // Elements by their indices, from `first` to before `end`.
  void add_indices(std::size_t set, std::uint32_t first, std::uint32_t end) {
    sets_[set].indices.emplace_back(first, end);
  }

  // Calls `act` with the index of each element of the set, of some perhaps twice. `numbers`: of all
  // elements.
  void each_of(std::size_t set, const NodeNumbers& numbers,
               const std::function<void(std::uint32_t)>& act) const;

 private:
  struct Set {
    std::string name;
    std::vector<Range> ranges{};
    std::vector<std::size_t> others{};
    std::vector<std::pair<std::uint32_t, std::uint32_t>> indices{};
  };

  std::vector<Set> sets_;
  std::map<std::string, std::size_t> by_name_;  // in lower case
};

}  // namespace weft::files
