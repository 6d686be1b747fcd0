// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/node_numbers.h"

#include <algorithm>
#include <string>

namespace weft::files {

Result<void> NodeNumbers::add(LineScanner& scanner, std::string_view what) {
  const auto number = scanner.integer(what);
  if (!number) return tl::unexpected(number.error());
  const bool in_order = count_ == 0 || (index_.empty() && *number > most_ && most_ + 1 == *number);
  if (count_ == 0) first_ = least_ = most_ = *number;
  if (!in_order && index_.empty())
    for (std::int64_t i = 0; i < count_; ++i)
      index_.emplace(first_ + i, static_cast<std::uint32_t>(i));
  if (!in_order && !index_.emplace(*number, static_cast<std::uint32_t>(count_)).second)
    return scanner.error(std::string(what) + " is " + std::to_string(*number) +
                         ", as that of another one before it");
  least_ = std::min(least_, *number);
  most_ = std::max(most_, *number);
  ++count_;
  return {};
}

std::optional<std::uint32_t> NodeNumbers::find(std::int64_t number) const {
  if (index_.empty() && number >= first_ && number <= most_ && count_ > 0)
    return static_cast<std::uint32_t>(number - first_);
  const auto found = index_.find(number);
  return found != index_.end() ? std::optional(found->second) : std::nullopt;
}

void NodeNumbers::each_of(std::int64_t first, std::int64_t last, std::int64_t step,
                          const std::function<void(std::uint32_t)>& act) const {
  if (last < first) return;
  const auto above = [first](std::int64_t number) {
    return static_cast<std::uint64_t>(number) - static_cast<std::uint64_t>(first);
  };
  const auto by = static_cast<std::uint64_t>(step);
  if (above(last) / by > static_cast<std::uint64_t>(count_)) {
    const auto try_one = [&](std::int64_t number, std::uint32_t index) {
      if (number >= first && number <= last && above(number) % by == 0) act(index);
    };
    for (const auto& [number, index] : index_) try_one(number, index);
    for (std::int64_t i = 0; index_.empty() && i < count_; ++i)
      try_one(first_ + i, static_cast<std::uint32_t>(i));
    return;
  }
  for (std::uint64_t k = 0; k <= above(last) / by; ++k)
    if (const auto i = find(static_cast<std::int64_t>(static_cast<std::uint64_t>(first) + k * by)))
      act(*i);
}

Result<std::uint32_t> NodeNumbers::read(LineScanner& scanner, std::string_view what) const {
  const auto number = scanner.integer(what);
  if (!number) return tl::unexpected(number.error());
  if (const auto found = find(*number)) return *found;
  const std::string is = std::string(what) + " is " + std::to_string(*number);
  if (count_ == 0) return scanner.error(is + ", but there are no points");
  const std::string range = std::to_string(least_) + " to " + std::to_string(most_);
  if (index_.empty()) return scanner.error(is + ", the numbers run from " + range);
  return scanner.error(is + ", which no point has; the numbers are from " + range);
}

}  // namespace weft::files
