// SPDX-License-Identifier: Apache-2.0
// Converts the server's types to SQL and back. Both stores return a job as the same columns, those
// of a view, in the order in which `read_job` reads them.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/store/job_store.h"

namespace weft::server {

// The nearest time in the clock's range, because a damaged row may have any number.
inline WallTime from_micros(std::int64_t micros) {
  constexpr auto kFirst = std::chrono::ceil<std::chrono::microseconds>(WallTime::duration::min());
  constexpr auto kLast = std::chrono::floor<std::chrono::microseconds>(WallTime::duration::max());
  return WallTime(std::chrono::duration_cast<WallTime::duration>(
      std::clamp(std::chrono::microseconds(micros), kFirst, kLast)));
}
inline std::int64_t to_micros(WallTime time) {
  return std::chrono::duration_cast<std::chrono::microseconds>(time.time_since_epoch()).count();
}
inline std::int64_t to_micros(std::chrono::microseconds duration) {
  return duration.count();
}

// The number, limited to SQL's largest integer.
inline std::int64_t to_sql(std::uint64_t number) {
  constexpr auto kMax = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  return static_cast<std::int64_t>(std::min(number, kMax));
}
inline std::uint64_t to_unsigned(std::int64_t number) {
  return static_cast<std::uint64_t>(number);
}

// One bit per state; all bits if there are none.
inline std::int64_t bits_of(const std::vector<JobState>& states) {
  std::int64_t bits = states.empty() ? ~std::int64_t{0} : 0;
  for (const JobState state : states) bits |= std::int64_t{1} << static_cast<int>(state);
  return bits;
}

// Each name in hexadecimal digits, a comma before the first and after each: whatever is in names,
// a statement can look for one. Empty if there are none.
inline std::string list_of(const std::vector<std::string>& names) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string list;
  for (const std::string& name : names) {
    if (list.empty()) list = ",";
    for (const char byte : name) {
      const auto number = static_cast<unsigned char>(byte);
      list += kDigits[number / 16];
      list += kDigits[number % 16];
    }
    list += ',';
  }
  return list;
}

template <class Rows>
JobRecord read_job(const Rows& rows) {
  const auto time = [&](int column) {
    return rows.null(column) ? std::nullopt : std::optional(from_micros(rows.integer(column)));
  };
  JobRecord job;
  job.id = rows.bytes(0);
  job.owner = rows.bytes(1);
  job.request_id = rows.bytes(2);
  job.key = rows.bytes(3);
  job.state = static_cast<JobState>(rows.integer(4));
  job.created = from_micros(rows.integer(5));
  job.started = time(6);
  job.ended = time(7);
  job.attempts = static_cast<std::uint32_t>(rows.integer(8));
  job.from_store = rows.integer(9) != 0;
  job.worker = rows.bytes(10);
  job.progress = rows.bytes(11);
  job.error = rows.bytes(12);
  if (!rows.null(13)) job.task = rows.integer(13);
  job.brief = rows.bytes(14);
  job.callback.url = rows.bytes(15);
  job.callback.state = static_cast<CallbackState>(rows.integer(16));
  job.callback.attempts = static_cast<std::uint32_t>(rows.integer(17));
  job.callback.error = rows.bytes(18);
  return job;
}

}  // namespace weft::server
