// SPDX-License-Identifier: Apache-2.0
// Floods of HTTP/2 by callers without a token, over TCP and TLS, at servers that require tokens and
// at servers that do not: memory stays, an honest caller is answered, and afterwards every address
// answers. Before, a header block without an end took 2,098 MiB in 8 s and was never closed, 300
// connections of health checks 1,464 MiB, resets over 128 connections 767 MiB; and 1,100 bare
// connections closed the TCP address for ever.
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include "tests/e2e/fleet.h"
#include "tests/e2e/hostile/bystander.h"
#include "tests/e2e/hostile/floods.h"
#include "tests/e2e/hostile/http2_client.h"
#include "tests/e2e/programs.h"
#include "tests/support/certificates.h"
#include "tests/support/event.h"
#include "tests/support/paths.h"
#include "weft/v1/mesh_service.grpc.pb.h"

namespace weft::e2e {
namespace {

using std::chrono::steady_clock;
using testing::TestCa;
using testing::TestCertificate;
using Words = std::vector<std::string>;

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
constexpr const char* kToken = "an-honest-clients-token";

struct Kind {
  bool encrypted;
  bool tokens;
};

std::string name_of(const Kind& kind) {
  return std::string(kind.encrypted ? "Tls" : "Tcp") + (kind.tokens ? "WithTokens" : "");
}

// A server of this kind, with 512 MiB, and its honest caller.
class Scene {
 public:
  explicit Scene(const Kind& kind, unsigned descriptors = 0) : encrypted_(kind.encrypted) {
    Words words{"--listen", "127.0.0.1:0", "--memory", "512MiB", "--metrics", "127.0.0.1:0"};
    if (kind.encrypted) {
      const TestCertificate own = ca_.issue({.common_name = "weftd", .names = {"IP:127.0.0.1"}});
      words.insert(words.end(), {"--tls-cert", folder_.write("server.pem", own.pem).string(),
                                 "--tls-key", folder_.write("server.key", own.key).string()});
    }
    if (kind.tokens)
      words.insert(
          words.end(),
          {"--tokens", folder_.write("tokens", std::string("ann ") + kToken + "\n").string()});
    server_.emplace(words, descriptors);
  }

  Server& server() { return *server_; }
  Target target() const { return {server_->addresses().at(1), encrypted_}; }
  std::shared_ptr<grpc::Channel> channel() const {
    grpc::ChannelArguments own;
    own.SetInt("grpc.use_local_subchannel_pool", 1);
    // All come from one address, whose connections the server closes if they are too many. So an
    // honest caller's may be among them, and it calls again, as `weft` does.
    own.SetServiceConfigJSON(R"({"methodConfig": [{"name": [{}], "retryPolicy": {
        "maxAttempts": 5, "initialBackoff": "0.05s", "maxBackoff": "1s", "backoffMultiplier": 2,
        "retryableStatusCodes": ["UNAVAILABLE"]}}]})");
    return grpc::CreateCustomChannel(
        target().address,
        encrypted_ ? grpc::SslCredentials({ca_.pem(), "", ""}) : grpc::InsecureChannelCredentials(),
        own);
  }
  // On a new connection.
  bool answers() const {
    const auto stub = v1::MeshService::NewStub(channel());
    grpc::ClientContext context;
    context.AddMetadata("authorization", std::string("Bearer ") + kToken);
    context.set_deadline(std::chrono::system_clock::now() + kPatience);
    context.set_wait_for_ready(true);
    v1::GetServerInfoResponse info;
    return stub->GetServerInfo(&context, {}, &info).ok();
  }

 private:
  const bool encrypted_;
  const Folder folder_;
  const TestCa ca_{"a CA"};
  std::optional<Server> server_;
};

class Floods : public ::testing::TestWithParam<std::tuple<std::size_t, Kind>> {};

TEST_P(Floods, HarmNobody) {
  const auto& [number, kind] = GetParam();
  Scene scene(kind);
  ASSERT_TRUE(scene.answers());
  Bystander honest(scene.channel(), kToken);
  const std::uint64_t before = scene.server().resident_bytes();
  const auto end = steady_clock::now() + std::chrono::seconds(few_or_many(2, 30));
  const Flooded flooded =
      kFloods[number].run(scene.target(), [&] { return steady_clock::now() >= end; });
  honest.stop();
  EXPECT_GT(flooded.connections, 0u);
  EXPECT_EQ(honest.failures(), 0u) << "of " << honest.answers();
  EXPECT_TRUE(scene.answers());
  if (kMemoryTells) {
    EXPECT_LT(scene.server().peak_bytes(), before + 128 * kMiB);
  }
  std::printf("%llu connections, %llu closed; %.0f MiB more at most; %zu answers, p99 %.1f ms\n",
              static_cast<unsigned long long>(flooded.connections),
              static_cast<unsigned long long>(flooded.closed),
              static_cast<double>(scene.server().peak_bytes() - before) / kMiB, honest.answers(),
              1e3 * honest.seconds_of(0.99));
}

INSTANTIATE_TEST_SUITE_P(OfEachKind, Floods,
                         ::testing::Combine(::testing::Range(std::size_t{0}, std::size(kFloods)),
                                            ::testing::Values(Kind{false, false},
                                                              Kind{true, true})),
                         [](const auto& info) {
                           std::string name;
                           for (const char* each = kFloods[std::get<0>(info.param)].name;
                                *each != '\0'; ++each)
                             if (*each != '-') name += *each;
                           return name + name_of(std::get<1>(info.param));
                         });

class AllFloods : public ::testing::TestWithParam<Kind> {};

TEST_P(AllFloods, HarmNobodyTogether) {
  Scene scene(GetParam());
  ASSERT_TRUE(scene.answers());
  const std::uint64_t before = scene.server().resident_bytes();
  const auto seconds = std::to_string(few_or_many(3, 60));
  Words words{scene.target().address, seconds, scene.target().encrypted ? "tls" : "tcp"};
  for (const Flood& flood : kFloods) words.emplace_back(flood.name);
  Bystander honest(scene.channel(), kToken);
  const Outcome hostile = run_program(testing::kHostileClients, words);
  honest.stop();
  EXPECT_EQ(hostile.exit_code, 0) << hostile.err;
  EXPECT_EQ(honest.failures(), 0u) << "of " << honest.answers();
  EXPECT_TRUE(scene.answers());
  if (kMemoryTells) {
    EXPECT_LT(scene.server().peak_bytes(), before + 128 * kMiB);
  }
  std::printf("%s%.0f MiB more at most, %.0f at the end; %zu answers, median %.1f, p99 %.1f ms\n",
              hostile.out.c_str(), static_cast<double>(scene.server().peak_bytes() - before) / kMiB,
              static_cast<double>(scene.server().resident_bytes()) / kMiB -
                  static_cast<double>(before) / kMiB,
              honest.answers(), 1e3 * honest.seconds_of(0.5), 1e3 * honest.seconds_of(0.99));
}

INSTANTIATE_TEST_SUITE_P(OfEachKind, AllFloods,
                         ::testing::Values(Kind{false, false}, Kind{false, true}, Kind{true, false},
                                           Kind{true, true}),
                         [](const auto& info) { return name_of(info.param); });

// Whoever is cut off learns why.
TEST(FloodOfContinuations, EndsWithAWordOfWhy) {
  Scene scene({.encrypted = false, .tokens = false});
  Http2Client client(scene.target().address);
  const std::string fields = [] {
    std::string many;
    while (many.size() < 1'000) many += literal_header("x", "y");
    return many;
  }();
  client.frame(1, 0, 1, literal_header(":method", "POST"));
  for (int i = 0; i < 9; ++i) client.frame(9, 0, 1, fields);
  const auto end = steady_clock::now() + kPatience;
  while (client.alive() && steady_clock::now() < end) client.listen(std::chrono::milliseconds(100));
  EXPECT_EQ(client.goaway(), kEnhanceYourCalm);
  EXPECT_NE(scene.server().log().find("cause=continuations most=8"), std::string::npos)
      << scene.server().log();
}

// As many descriptors as this, of which the connections of strangers must leave some.
class Descriptors : public ::testing::TestWithParam<unsigned> {};

TEST_P(Descriptors, RunOutForNobodyElse) {
  Scene scene({.encrypted = false, .tokens = false}, GetParam());
  ASSERT_TRUE(scene.answers());
  const auto end = steady_clock::now() + std::chrono::seconds(1);
  (void)kFloods[0].run(scene.target(), [&] { return steady_clock::now() >= end; });
  EXPECT_TRUE(scene.answers());
  EXPECT_LT(scene.server().open_files(), std::size_t{GetParam()});
}

INSTANTIATE_TEST_SUITE_P(OfEachNumber, Descriptors, ::testing::Values(64u, 256u, 1024u),
                         [](const auto& info) { return "Of" + std::to_string(info.param); });

}  // namespace
}  // namespace weft::e2e
