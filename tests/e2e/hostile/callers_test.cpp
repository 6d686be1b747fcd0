// SPDX-License-Identifier: Apache-2.0
// What callers that the server knows can do to it: a message takes no more memory than its bytes
// and what the limits admit, and one that does not come is given up.
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tests/e2e/fleet.h"
#include "tests/e2e/hostile/http2_client.h"
#include "tests/e2e/programs.h"
#include "tests/server/raw_call.h"
#include "tests/support/event.h"

namespace weft::e2e {
namespace {

using server::testing::raw_stream;
using server::testing::raw_unary;
using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

std::string repeated(std::string_view part, std::size_t bytes) {
  std::string all;
  all.reserve(bytes + part.size());
  while (all.size() < bytes) all += part;
  return all;
}

// A tag of field 1 and a length before the content: a message, or a text, in a message.
std::string in_field_1(const std::string& content) {
  std::string out = "\x0a";
  std::size_t length = content.size();
  for (; length >= 128; length >>= 7) out += static_cast<char>(length | 128);
  out += static_cast<char>(length);
  return out + content;
}

TEST(HostileCallers, PayForUnknownFieldsWithTheirOwnBytes) {
  const Server server;
  const std::uint64_t before = server.peak_bytes();
  const std::string junk = repeated("\x7b\x7c", 32 * kMiB);  // 1 GiB if it were kept
  const auto channel = connect(server.address());
  EXPECT_EQ(raw_stream(channel, "/weft.v1.MeshService/GenerateMesh", junk).error_code(),
            grpc::INVALID_ARGUMENT)
      << "it has no domain";
  EXPECT_EQ(raw_stream(channel, "/weft.v1.MeshService/GenerateMesh", in_field_1(junk)).error_code(),
            grpc::INVALID_ARGUMENT)
      << "its domain has no points";
  if (kMemoryTells) {
    EXPECT_LT(server.peak_bytes(), before + 4 * 32 * kMiB);
  }
}

// Numbers of one byte become four, and twice that while an array grows.
TEST(HostileCallers, AreRefusedArraysBeforeTheyAreParsed) {
  const Server server({"--max-segments", "1000"});
  const std::uint64_t before = server.peak_bytes();
  const std::string numbers(64 * kMiB, '\x01');
  std::string segments = in_field_1(numbers);
  segments[0] = '\x12';  // Domain.segments
  const grpc::Status status = raw_stream(connect(server.address()),
                                         "/weft.v1.MeshService/GenerateMesh", in_field_1(segments));
  EXPECT_EQ(status.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_NE(status.error_message().find("33554432 segments"), std::string::npos)
      << status.error_message();
  if (kMemoryTells) {
    EXPECT_LT(server.peak_bytes(), before + 2 * 64 * kMiB);
  }
}

TEST(HostileCallers, SeeNoLongIdAgainAndLogNone) {
  const Folder folder;
  const Server server({"--data", folder / "data"});
  const auto channel = connect(server.address());
  for (const char* method : {"GetJob", "CancelJob", "DeleteJob", "WatchJob", "FetchMesh"}) {
    const std::string path = std::string("/weft.v1.JobService/") + method;
    for (const std::size_t bytes : {std::size_t{60'000}, std::size_t{8} << 20}) {
      const grpc::Status status =
          raw_stream(channel, path.c_str(), in_field_1(std::string(bytes, 'A')));
      EXPECT_EQ(status.error_code(),
                bytes < 65'536 ? grpc::INVALID_ARGUMENT : grpc::RESOURCE_EXHAUSTED)
          << method;
      EXPECT_LT(status.error_message().size() + status.error_details().size(), 1000u) << method;
    }
  }
  EXPECT_LT(server.logged_bytes(), 10'000u);
}

TEST(HostileCallers, AreGivenUpWhenTheirMessageDoesNotCome) {
  const Server server({"--listen", "127.0.0.1:0", "--request-timeout", "0.5"});
  std::vector<std::unique_ptr<Http2Client>> clients;
  std::vector<std::uint32_t> streams;
  for (int i = 0; i < 4; ++i) {
    auto& client = clients.emplace_back(std::make_unique<Http2Client>(server.addresses().at(1)));
    streams.push_back(client->open("/weft.v1.MeshService/GenerateMesh"));
    client->send(streams.back(), message_prefix(200 * kMiB) + std::string(1000, 'x'));
  }
  const auto end = steady_clock::now() + kPatience;
  for (std::size_t i = 0; i < clients.size(); ++i) {
    while (!clients[i]->ended(streams[i]) && steady_clock::now() < end)
      clients[i]->listen(milliseconds(50));
    EXPECT_TRUE(clients[i]->ended(streams[i]));
  }
  EXPECT_NE(server.log().find("status=DEADLINE_EXCEEDED"), std::string::npos) << server.log();
}

// Messages on their way are held within an eighth of --memory, or twice --max-request-bytes.
TEST(HostileCallers, HoldNoMoreThanTheQuotaWithMessagesThatNeverEnd) {
  const Server server(
      {"--listen", "127.0.0.1:0", "--memory", "256MiB", "--max-request-bytes", "48MiB"});
  const std::uint64_t before = server.peak_bytes();
  std::vector<std::unique_ptr<Http2Client>> clients;
  std::vector<std::uint32_t> streams;
  for (int i = 0; i < 8; ++i) {
    auto& client = clients.emplace_back(std::make_unique<Http2Client>(server.addresses().at(1)));
    streams.push_back(client->open("/weft.v1.MeshService/GenerateMesh"));
    client->send(streams.back(), message_prefix(47 * kMiB));
  }
  const std::string junk(kMiB, '\x0a');
  std::vector<std::uint64_t> sent(clients.size());
  const auto end = steady_clock::now() + seconds(3);
  while (steady_clock::now() < end)
    for (std::size_t i = 0; i < clients.size(); ++i) {
      if (!clients[i]->alive() || clients[i]->ended(streams[i])) continue;
      if (sent[i] < 46 * kMiB) sent[i] += clients[i]->send(streams[i], junk);
      clients[i]->listen(milliseconds(1));
    }
  if (kMemoryTells) {
    EXPECT_LT(server.peak_bytes(), before + 160 * kMiB) << "8 of 46 MiB are 368";
  }
  const auto other = raw_unary(connect(server.address()), "/weft.v1.MeshService/GetServerInfo", "");
  EXPECT_TRUE(other.first.ok()) << other.first.error_message();
}

}  // namespace
}  // namespace weft::e2e
