// SPDX-License-Identifier: Apache-2.0
// What the tests of the laws share: each runs on a fresh store of every kind.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/store/job_store.h"
#include "tests/server/store/backend.h"

namespace weft::server {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;

std::string sha256_of(std::string_view bytes);
// A key: 32 bytes that begin with the name.
std::string key_of(std::string_view name);

class StoreTest : public testing::TestWithParam<BackendKind> {
 protected:
  static constexpr std::uint64_t kAnyEstimate = std::numeric_limits<std::uint64_t>::max();

  void SetUp() override;

  // Closes the store, and opens it again.
  void reopen();

  // The shortcuts fail the test where the store answers with an error, or otherwise than meant.
  JobRecord submit(const Submission& submission);
  JobRecord submit(const std::string& owner, const std::string& key_name);
  JobRecord get(const JobRecord& job);
  std::optional<Claim> try_claim(milliseconds lease = hours(1),
                                 std::uint64_t estimate = kAnyEstimate);
  Claim claim(milliseconds lease = hours(1));
  // A mesh of chunks that are put.
  StoredMesh put(const std::vector<std::string>& chunks);
  // A job that has succeeded with these chunks.
  JobRecord made(const std::string& key_name, const std::vector<std::string>& chunks);
  std::optional<StoredMesh> mesh(const std::string& key_name);
  StoreStats stats();
  // With this many attempts for a task, and no delay between them.
  Reaped reap(std::uint32_t max_attempts = 3);
  std::vector<std::string> list(const ListQuery& query);  // the ids
  bool has_chunk(const std::string& bytes);

  std::unique_ptr<Backend> backend_;
  std::unique_ptr<JobStore> store_;
};

// For INSTANTIATE_TEST_SUITE_P.
inline auto kinds_of_store() {
  return testing::Values(BackendKind{"Sqlite", &make_sqlite_backend},
                         BackendKind{"Postgres", &make_postgres_backend});
}
inline std::string kind_name(const testing::TestParamInfo<BackendKind>& info) {
  return info.param.name;
}

}  // namespace weft::server
