// SPDX-License-Identifier: Apache-2.0
#include "server/options.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace weft::server {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
constexpr std::uint64_t kGiB = std::uint64_t{1} << 30;

std::variant<Options, Exit> parse(std::vector<const char*> flags) {
  flags.insert(flags.begin(), "weftd");
  return parse_options(static_cast<int>(flags.size()), flags.data(),
                       {.threads = 2, .memory = 16 * kGiB});
}
ServiceOptions service_of(std::vector<const char*> flags) {
  const auto parsed = parse(std::move(flags));
  EXPECT_TRUE(std::holds_alternative<Options>(parsed));
  return std::holds_alternative<Options>(parsed) ? std::get<Options>(parsed).server.service
                                                 : ServiceOptions{};
}
std::string complaint_about(std::vector<const char*> flags) {
  ::testing::internal::CaptureStderr();
  const auto parsed = parse(std::move(flags));
  const std::string text = ::testing::internal::GetCapturedStderr();
  const Exit* const exit = std::get_if<Exit>(&parsed);
  EXPECT_TRUE(exit != nullptr && exit->code == kExitUsage) << text;
  return text;
}

// What --memory leaves for runs: of 12 GiB, an eighth is for messages, a 32nd for pages that are
// kept, 64 MiB for finished meshes and 32 for the process.
constexpr std::uint64_t for_runs(std::uint64_t memory) {
  return memory - memory / 8 - memory / 32 - 96 * kMiB;
}

TEST(MemoryOptions, LetAllRunsTogetherHaveWhatIsLeftForThem) {
  const ServiceOptions service = service_of({});
  EXPECT_EQ(service.jobs, 4u);
  EXPECT_EQ(service.limits.max_bytes, for_runs(12 * kGiB) / 4);
  EXPECT_EQ(service_of({"--jobs", "1"}).limits.max_bytes, for_runs(12 * kGiB));
  EXPECT_EQ(service_of({"--memory", "8GiB"}).limits.max_bytes, for_runs(8 * kGiB) / 4);
}

TEST(CallbackOptions, AllowNetworksByTheirCidr) {
  const auto parsed = parse({"--data", "d", "--notify-secrets", "f", "--notify-allow",
                             "10.0.0.0/8,fd00::/8", "--notify-allow", "127.0.0.0/8"});
  ASSERT_TRUE(std::holds_alternative<Options>(parsed));
  const CallbackOptions& callbacks = std::get<Options>(parsed).server.callbacks;
  EXPECT_EQ(callbacks.clients, "f");
  EXPECT_EQ(callbacks.allowed.size(), 3u);
  EXPECT_NE(complaint_about({"--data", "d", "--notify-secrets", "f", "--notify-allow", "10.0.0.1"})
                .find("10.0.0.1 is no network such as 10.0.0.0/8"),
            std::string::npos);
  EXPECT_NE(
      complaint_about({"--data", "d", "--notify-allow", "10.0.0.0/8"}).find("--notify-secrets"),
      std::string::npos);
}

TEST(MemoryOptions, LeaveRoomForTwoMessagesButNoMoreThanHalf) {
  EXPECT_EQ(service_of({}).cache_bytes, 64 * kMiB);
  const ServiceOptions little = service_of({"--memory", "1GiB", "--jobs", "1"});
  EXPECT_EQ(little.cache_bytes, 32 * kMiB);
  EXPECT_EQ(little.limits.max_bytes, kGiB / 2 - kGiB / 32 - 64 * kMiB);
  const ServiceOptions given = service_of(
      {"--memory", "1GiB", "--max-request-bytes", "100MiB", "--cache-bytes", "0", "--jobs", "1"});
  EXPECT_EQ(given.cache_bytes, 0u);
  EXPECT_EQ(given.limits.max_bytes, kGiB - 2 * 100 * kMiB - kGiB / 32 - 32 * kMiB);
}

// It receives them, too, before they are received from it.
TEST(MemoryOptions, LeaveAPartForMessagesOfTheConsole) {
  EXPECT_EQ(service_of({"--console", "127.0.0.1:8080", "--jobs", "1"}).limits.max_bytes,
            for_runs(12 * kGiB) - 12 * kGiB / 8);
}

TEST(MemoryOptions, ThatLeaveNothingForRunsAreRefused) {
  EXPECT_EQ(service_of({"--memory", "147MiB"}).jobs, 4u);
  const std::string text = complaint_about({"--memory", "128MiB"});
  EXPECT_NE(text.find("134217728 bytes leave 25165824 for runs"), std::string::npos) << text;
  complaint_about({"--memory", "1GiB", "--cache-bytes", "1GiB"});
}

TEST(MemoryOptions, GiveFewerRunsMoreEachIfThatIsWanted) {
  const ServiceOptions service = service_of({"--max-bytes", "5GiB"});
  EXPECT_EQ(service.jobs, 2u);  // of 10.0 GiB
  EXPECT_EQ(service.limits.max_bytes, 5 * kGiB);
  EXPECT_EQ(service_of({"--max-bytes", "1GiB"}).jobs, 4u);
}

TEST(MemoryOptions, ThatPromiseMoreThanThereIsAreRefused) {
  const std::string text = complaint_about({"--max-bytes", "5GiB", "--jobs", "3"});
  EXPECT_NE(text.find("5368709120 bytes for each of 3 runs"), std::string::npos) << text;
  EXPECT_NE(text.find("12884901888"), std::string::npos) << text;
  complaint_about({"--max-bytes", "13GiB"});
  complaint_about({"--memory", "1GiB", "--max-bytes", "2GiB", "--jobs", "1"});
  EXPECT_EQ(service_of({"--max-bytes", "3GiB", "--jobs", "3"}).jobs, 3u);
}

TEST(ClientShare, LeavesSomethingToOthersIfThereMayBeAny) {
  EXPECT_EQ(service_of({}).client_share, 1);
  EXPECT_EQ(service_of({"--listen", "unix:/tmp/x"}).client_share, 1);
  EXPECT_EQ(service_of({"--tokens", "file"}).client_share, 0.75);
  EXPECT_EQ(service_of({"--listen", "0.0.0.0:7421", "--insecure"}).client_share, 0.75);
  EXPECT_EQ(service_of({"--tokens", "file", "--client-share", "0.5"}).client_share, 0.5);
  EXPECT_EQ(service_of({"--tokens", "file", "--client-share", "1"}).client_share, 1);
  for (const char* bad : {"0", "-1", "1.1", "nan"}) complaint_about({"--client-share", bad});
}

TEST(ReaderOptions, HaveALeastRate) {
  EXPECT_EQ(service_of({}).patience.least_rate, 4096u);
  EXPECT_EQ(service_of({"--min-rate", "0"}).patience.least_rate, 0u);
}

TEST(ConsoleOptions, NameOriginsAsBrowsersSpellThem) {
  const auto parsed = parse({"--console-origin", "https://a.example.org,http://localhost:5173"});
  ASSERT_TRUE(std::holds_alternative<Options>(parsed));
  EXPECT_EQ(std::get<Options>(parsed).server.console.origins,
            (std::vector<std::string>{"https://a.example.org", "http://localhost:5173"}));
  for (const char* wrong : {"*", "example.org", "https://example.org/"})
    EXPECT_NE(complaint_about({"--console-origin", wrong}).find("is not an origin"),
              std::string::npos)
        << wrong;
}

TEST(ConsoleOptions, LeaveSomethingToOthersIfOtherMachinesCanConnect) {
  EXPECT_EQ(service_of({"--console", "127.0.0.1:8080"}).client_share, 1);
  EXPECT_LT(service_of({"--console", "0.0.0.0:8080"}).client_share, 1);
}

}  // namespace
}  // namespace weft::server
