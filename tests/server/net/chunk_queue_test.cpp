// SPDX-License-Identifier: Apache-2.0
#include "server/net/chunk_queue.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/server/harness.h"
#include "tests/server/raw_call.h"

namespace weft::server {
namespace {

using testing::to_buffer;
using testing::to_string;

TEST(ChunkQueue, GivesMessagesBackInOrder) {
  ChunkQueue queue({.bytes = 100, .count = 100});
  for (const char* text : {"a", "b", "c"}) ASSERT_TRUE(queue.push(to_buffer(text)));
  for (const char* text : {"a", "b", "c"}) EXPECT_EQ(to_string(*queue.try_pop()), text);
  EXPECT_FALSE(queue.try_pop());
}

TEST(ChunkQueue, AdmitsOneMessageHoweverLarge) {
  ChunkQueue queue({.bytes = 1, .count = 1});
  EXPECT_TRUE(queue.push(to_buffer(std::string(1000, 'x'))));
}

// Pushes a second message on a thread of its own, which must wait until `release`.
void expect_second_push_waits(ChunkQueue::Bounds bounds, std::size_t size) {
  ChunkQueue queue(bounds);
  ASSERT_TRUE(queue.push(to_buffer(std::string(size, '1'))));
  std::atomic<bool> popped{false};
  std::thread pusher([&] {
    EXPECT_TRUE(queue.push(to_buffer(std::string(size, '2'))));
    EXPECT_TRUE(popped) << "it did not wait";
  });
  popped = true;
  EXPECT_TRUE(queue.try_pop());
  pusher.join();
  EXPECT_TRUE(queue.try_pop());
}

TEST(ChunkQueue, WaitsWhereTheBytesWouldBeTooMany) {
  expect_second_push_waits({.bytes = 15, .count = 100}, 10);
}

TEST(ChunkQueue, WaitsWhereTheMessagesWouldBeTooMany) {
  expect_second_push_waits({.bytes = 1000, .count = 1}, 10);
}

TEST(ChunkQueue, ClosingWakesWhoeverWaits) {
  ChunkQueue queue({.bytes = 1, .count = 1});
  ASSERT_TRUE(queue.push(to_buffer("x")));
  std::thread pusher([&] { EXPECT_FALSE(queue.push(to_buffer("y"))); });
  queue.close();
  pusher.join();
  EXPECT_FALSE(queue.try_pop());
  EXPECT_FALSE(queue.push(to_buffer("z")));
}

}  // namespace
}  // namespace weft::server
