// SPDX-License-Identifier: Apache-2.0
#include "server/store/job_id.h"

#include <sys/random.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <span>

namespace weft::server {
namespace {

constexpr std::string_view kDigits = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";
constexpr std::size_t kLength = 26;
constexpr std::size_t kTimeBytes = 6;

void fill_at_random(std::span<std::uint8_t> bytes) {
  // Cannot fail for so few bytes, unless the kernel has no random numbers at all.
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) std::abort();
}

}  // namespace

std::string JobIds::next(WallTime now) {
  const auto since = std::chrono::duration_cast<std::chrono::milliseconds>(now.time_since_epoch());
  const auto ms = static_cast<std::uint64_t>(since.count());
  std::array<std::uint8_t, 16> fresh;
  for (std::size_t i = 0; i < kTimeBytes; ++i) {
    fresh[i] = static_cast<std::uint8_t>(ms >> (8 * (kTimeBytes - 1 - i)));
  }
  const std::lock_guard lock(mutex_);
  if (std::memcmp(fresh.data(), last_.data(), kTimeBytes) > 0) {
    fill_at_random(std::span(fresh).subspan(kTimeBytes));
    last_ = fresh;
  } else {
    // In the same millisecond, or if the clock was set back, the next number follows.
    for (std::size_t i = last_.size(); i-- > 0 && ++last_[i] == 0;) {
    }
  }
  // 26 digits hold 130 bits: the first holds but three of the number's.
  std::string id(kLength, '0');
  for (std::size_t digit = 0; digit < kLength; ++digit) {
    unsigned value = 0;
    for (std::size_t bit = 5 * digit; bit < 5 * digit + 5; ++bit) {
      value <<= 1;
      if (bit >= 2) value |= (last_[(bit - 2) / 8] >> (7 - (bit - 2) % 8)) & 1U;
    }
    id[digit] = kDigits[value];
  }
  return id;
}

bool is_job_id(std::string_view text) {
  return text.size() == kLength && std::all_of(text.begin(), text.end(), [](char digit) {
           return kDigits.find(digit) != std::string_view::npos;
         });
}

}  // namespace weft::server
