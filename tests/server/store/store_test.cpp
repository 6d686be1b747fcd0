// SPDX-License-Identifier: Apache-2.0
// Runs the laws of job_store.h, which are in the files beside this one, on each store.
#include "tests/server/store/store_test.h"

#include <openssl/sha.h>

#include <utility>

namespace weft::server {

std::string sha256_of(std::string_view bytes) {
  std::string digest(SHA256_DIGEST_LENGTH, '\0');
  SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
         reinterpret_cast<unsigned char*>(digest.data()));
  return digest;
}

std::string key_of(std::string_view name) {
  std::string key(name);
  key.resize(32, '\0');
  return key;
}

INSTANTIATE_TEST_SUITE_P(, StoreTest, kinds_of_store(), kind_name);

void StoreTest::SetUp() {
  backend_ = GetParam().make();
  reopen();
}

void StoreTest::reopen() {
  store_.reset();
  auto opened = backend_->open();
  ASSERT_TRUE(opened) << opened.error().message;
  store_ = std::move(*opened);
}

JobRecord StoreTest::submit(const Submission& submission) {
  const auto submitted = store_->submit(submission);
  if (!submitted) {
    ADD_FAILURE() << submitted.error().message;
    return {};
  }
  EXPECT_EQ(submitted->outcome, SubmitOutcome::kAccepted);
  return submitted->job;
}

JobRecord StoreTest::submit(const std::string& owner, const std::string& key_name) {
  return submit({.owner = owner, .key = key_of(key_name), .request = "make " + key_name});
}

JobRecord StoreTest::get(const JobRecord& job) {
  const auto found = store_->get(job.owner, job.id);
  if (!found) {
    ADD_FAILURE() << found.error().message;
    return {};
  }
  EXPECT_TRUE(*found) << "there is no job " << job.id;
  return found->value_or(JobRecord{});
}

std::optional<Claim> StoreTest::try_claim(milliseconds lease, std::uint64_t estimate) {
  auto claimed = store_->claim("worker", lease, estimate);
  if (!claimed) {
    ADD_FAILURE() << claimed.error().message;
    return std::nullopt;
  }
  return std::move(*claimed);
}

Claim StoreTest::claim(milliseconds lease) {
  std::optional<Claim> claimed = try_claim(lease);
  EXPECT_TRUE(claimed) << "there is no task to claim";
  return claimed.value_or(Claim{});
}

StoredMesh StoreTest::put(const std::vector<std::string>& chunks) {
  StoredMesh mesh{.summary = "summary", .brief = "brief", .chunks = {}};
  for (const std::string& chunk : chunks) {
    mesh.chunks.push_back({sha256_of(chunk), chunk.size()});
    const auto done = store_->put_chunk(mesh.chunks.back().sha256, chunk);
    EXPECT_TRUE(done) << done.error().message;
  }
  return mesh;
}

JobRecord StoreTest::made(const std::string& key_name, const std::vector<std::string>& chunks) {
  const JobRecord job =
      submit({.owner = "ann", .key = key_of(key_name), .request = "", .no_cache = true});
  const Claim claimed = claim();
  EXPECT_EQ(claimed.key, key_of(key_name));
  EXPECT_EQ(store_->finish(claimed.ref, put(chunks)), Held::kHeld);
  return get(job);
}

std::optional<StoredMesh> StoreTest::mesh(const std::string& key_name) {
  auto found = store_->mesh(key_of(key_name));
  if (!found) {
    ADD_FAILURE() << found.error().message;
    return std::nullopt;
  }
  return std::move(*found);
}

StoreStats StoreTest::stats() {
  const auto stats = store_->stats();
  EXPECT_TRUE(stats) << stats.error().message;
  return stats.value_or(StoreStats{});
}

Reaped StoreTest::reap(std::uint32_t max_attempts) {
  const auto reaped = store_->reap(
      {.max_attempts = max_attempts, .first_delay = milliseconds(0), .error = "tried too often"});
  EXPECT_TRUE(reaped) << reaped.error().message;
  return reaped.value_or(Reaped{});
}

std::vector<std::string> StoreTest::list(const ListQuery& query) {
  const auto jobs = store_->list(query);
  EXPECT_TRUE(jobs) << jobs.error().message;
  std::vector<std::string> ids;
  for (const JobRecord& job : jobs.value_or(std::vector<JobRecord>{})) ids.push_back(job.id);
  return ids;
}

bool StoreTest::has_chunk(const std::string& bytes) {
  const auto chunk = store_->chunk(sha256_of(bytes));
  EXPECT_TRUE(chunk) << chunk.error().message;
  return chunk && *chunk == bytes;
}

}  // namespace weft::server
