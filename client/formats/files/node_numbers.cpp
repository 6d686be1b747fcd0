// SPDX-License-Identifier: Apache-2.0
#include "client/formats/files/node_numbers.h"

#include <algorithm>
#include <string>

namespace weft::client {

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

Result<std::uint32_t> NodeNumbers::read(LineScanner& scanner, std::string_view what) const {
  const auto number = scanner.integer(what);
  if (!number) return tl::unexpected(number.error());
  if (index_.empty() && *number >= first_ && *number <= most_ && count_ > 0)
    return static_cast<std::uint32_t>(*number - first_);
  if (const auto found = index_.find(*number); found != index_.end()) return found->second;
  const std::string is = std::string(what) + " is " + std::to_string(*number);
  if (count_ == 0) return scanner.error(is + ", but there are no points");
  const std::string range = std::to_string(least_) + " to " + std::to_string(most_);
  if (index_.empty()) return scanner.error(is + ", the numbers run from " + range);
  return scanner.error(is + ", which no point has; the numbers are from " + range);
}

}  // namespace weft::client
