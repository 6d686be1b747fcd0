// SPDX-License-Identifier: Apache-2.0
// A kind of store as the tests of the laws see it: something that opens, opens again, and ages.
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <ostream>
#include <string>
#include <string_view>
#include <system_error>

#include "server/store/job_store.h"
#include "tests/support/postgres.h"

namespace weft::server {

class Backend {
 public:
  virtual ~Backend() = default;
  // What was stored before is there. At most one is open at once, unless it is a kind for many.
  virtual StoreResult<std::unique_ptr<JobStore>> open() = 0;
  // Makes all that is stored older.
  virtual void pass(std::chrono::microseconds time) = 0;
  // Stores other bytes under the digest of a chunk, as a disk that errs.
  virtual void damage(const std::string& sha256, const std::string& bytes) = 0;
};

// Where stores are made: in memory where there is room, for the disks of some machines take
// milliseconds to sync, and no test outlives the machine.
inline std::filesystem::path folder_for_tests() {
  constexpr std::uintmax_t kRoom = std::uintmax_t{1} << 30;
  const std::filesystem::path memory = "/dev/shm";
  std::error_code error;
  const bool roomy = access(memory.c_str(), W_OK) == 0 &&
                     std::filesystem::space(memory, error).available >= kRoom && !error;
  return roomy ? memory : std::filesystem::temp_directory_path();
}

inline std::string hex(std::string_view bytes) {
  std::string digits;
  for (const unsigned char byte : bytes) {
    digits += "0123456789abcdef"[byte >> 4];
    digits += "0123456789abcdef"[byte & 15];
  }
  return digits;
}

// A kind, with a name for the tests.
struct BackendKind {
  const char* name;
  std::unique_ptr<Backend> (*make)();
};

inline void PrintTo(const BackendKind& kind, std::ostream* out) {
  *out << kind.name;
}

std::unique_ptr<Backend> make_sqlite_backend();
std::unique_ptr<Backend> make_postgres_backend();

// The one of this program, started when it is first asked for.
PostgresServer& postgres_server();

}  // namespace weft::server
