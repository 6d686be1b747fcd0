// SPDX-License-Identifier: Apache-2.0
// Names for jobs, as ULIDs: 26 characters of Crockford's base 32, the first 10 of them the time in
// milliseconds, the others random. Names of one JobIds sort in the order in which they were given.
//
// Thread-safety: every function may be called from any thread.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

#include "server/store/job_store.h"

namespace weft::server {

class JobIds {
 public:
  std::string next(WallTime now);

 private:
  std::mutex mutex_;                     // guards the one below
  std::array<std::uint8_t, 16> last_{};  // 48 bits of time, 80 random bits; the highest byte first
};

// Whether the text has the form of a job's name.
bool is_job_id(std::string_view text);

}  // namespace weft::server
