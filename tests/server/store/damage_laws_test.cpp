// SPDX-License-Identifier: Apache-2.0
// The laws of a store whose disk loses bits.
#include <random>
#include <string>

#include "tests/server/store/store_test.h"

namespace weft::server {
namespace {

// Both parts of a mesh, which are long enough to lie on pages of their own.
std::vector<std::string> chunks_of(int number) {
  return {std::to_string(number) + std::string(20'000, 'a'),
          std::to_string(number) + std::string(500, 'b')};
}

std::string flipped(std::string bytes, std::size_t bit) {
  bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
  return bytes;
}

TEST_P(StoreTest, ADamagedChunkIsDroppedWithTheMeshesThatItIsPartOf) {
  const std::string chunk = chunks_of(1)[0];
  const JobRecord job = made("one", {chunk, "other"});
  made("two", {"more", chunk});
  made("three", {"more"});
  const std::string damaged = flipped(chunk, 1000);
  backend_->damage(sha256_of(chunk), damaged);
  ASSERT_EQ(*store_->chunk(sha256_of(chunk)), damaged);
  EXPECT_EQ(store_->drop_damaged(sha256_of(chunk), damaged), 2U);
  EXPECT_FALSE(mesh("one") || mesh("two"));
  EXPECT_TRUE(mesh("three"));
  EXPECT_FALSE(has_chunk(chunk));
  EXPECT_EQ(get(job).state, JobState::kSucceeded);
  EXPECT_FALSE(submit("ann", "one").from_store) << "it is to be made anew";
  const Claim claimed = claim();
  EXPECT_EQ(store_->finish(claimed.ref, put({chunk, "other"})), Held::kHeld);
  EXPECT_TRUE(has_chunk(chunk));
  EXPECT_TRUE(submit("ann", "one").from_store);
}

TEST_P(StoreTest, AChunkThatHasOtherBytesByNowIsNotDropped) {
  const std::string chunk = chunks_of(1)[0];
  made("one", {chunk});
  EXPECT_EQ(store_->drop_damaged(sha256_of(chunk), flipped(chunk, 3)), 0U);
  EXPECT_EQ(store_->drop_damaged(sha256_of("none"), "x"), 0U);
  EXPECT_TRUE(mesh("one"));
  EXPECT_TRUE(has_chunk(chunk));
}

TEST_P(StoreTest, ADamagedChunkIsMendedByWhoeverPutsIt) {
  const std::string chunk = chunks_of(1)[0];
  made("one", {chunk});
  EXPECT_EQ(store_->put_chunk(sha256_of(chunk), chunk), false);
  for (const std::string& damaged : {flipped(chunk, 77), chunk.substr(1), std::string()}) {
    backend_->damage(sha256_of(chunk), damaged);
    EXPECT_EQ(store_->put_chunk(sha256_of(chunk), chunk), true);
    EXPECT_TRUE(has_chunk(chunk));
  }
  EXPECT_TRUE(mesh("one"));
  EXPECT_EQ(mesh("one")->chunks[0].bytes, chunk.size());
}

TEST_P(StoreTest, ABitThatFlipsInAnyOfManyMeshesIsFoundAndMended) {
  constexpr int kMeshes = 100;
  std::mt19937_64 random(11);
  for (int i = 0; i < kMeshes; ++i) {
    made(std::to_string(i), chunks_of(i));
    const std::string chunk = chunks_of(i)[random() % 2];
    backend_->damage(sha256_of(chunk), flipped(chunk, random() % (8 * chunk.size())));
  }
  int found = 0;
  for (int i = 0; i < kMeshes; ++i) {
    for (const std::string& whole : chunks_of(i)) {
      const auto read = store_->chunk(sha256_of(whole));
      ASSERT_TRUE(read && *read);
      if (sha256_of(**read) == sha256_of(whole)) continue;
      ++found;
      EXPECT_EQ(store_->drop_damaged(sha256_of(whole), **read), 1U);
    }
    EXPECT_FALSE(mesh(std::to_string(i)));
    made(std::to_string(i), chunks_of(i));
    ASSERT_TRUE(mesh(std::to_string(i)));
    for (const std::string& whole : chunks_of(i)) EXPECT_TRUE(has_chunk(whole));
  }
  EXPECT_EQ(found, kMeshes);
}

}  // namespace
}  // namespace weft::server
