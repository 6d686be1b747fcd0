// SPDX-License-Identifier: Apache-2.0
// A server behind its front: who is known by which address, who loses a connection, and that the
// rest goes on.
#include "server/front/front.h"

#include <sys/socket.h>

#include <string>
#include <vector>

#include "tests/server/logged_server.h"
#include "tests/server/raw_call.h"
#include "tests/support/http.h"

namespace weft::server::testing {
namespace {

ServerOptions local() {
  return {.listen = {"127.0.0.1:0"}, .service = {}};
}

std::shared_ptr<grpc::Channel> plain(const LoggedServer& server) {
  return channel_to(server.address(), grpc::InsecureChannelCredentials());
}

// Begins so many calls on one channel, and cancels each.
void cancel_calls(const std::shared_ptr<grpc::Channel>& channel, int count) {
  for (int i = 0; i < count; ++i) {
    grpc::ClientContext context;
    const grpc::internal::RpcMethod rpc("/grpc.health.v1.Health/Watch",
                                        grpc::internal::RpcMethod::SERVER_STREAMING, channel);
    const std::unique_ptr<grpc::ClientReader<grpc::ByteBuffer>> watch(
        grpc::internal::ClientReaderFactory<grpc::ByteBuffer>::Create(channel.get(), rpc, &context,
                                                                      to_buffer("")));
    grpc::ByteBuffer status;
    EXPECT_TRUE(watch->Read(&status));
    context.TryCancel();
    (void)watch->Finish();
  }
}

TEST(Front, ClosesTheConnectionThatResetsTooMuchAndNoOther) {
  ServerOptions options = local();
  options.max_resets = 5;
  LoggedServer server(options);
  const auto guilty = plain(server);
  const auto other = plain(server);
  ASSERT_TRUE(ask(other).ok());
  cancel_calls(guilty, 6);
  EXPECT_TRUE(eventually([&] {
    return server.log().contains("event=connection_closed peer=ipv4:127.0.0.1:");
  })) << server.log().text();
  EXPECT_TRUE(server.log().contains("cause=resets most=5"));
  EXPECT_EQ(other->GetState(false), GRPC_CHANNEL_READY);
  EXPECT_TRUE(ask(other).ok());
  EXPECT_TRUE(eventually([&] { return ask(guilty).ok(); })) << "it may connect again";
}

TEST(Front, NamesThePeerOfACallByItsAddress) {
  LoggedServer server(local());
  EXPECT_FALSE(raw_generate_mesh(plain(server), "").ok());
  EXPECT_TRUE(server.log().contains("peer=ipv4:127.0.0.1:")) << server.log().text();
  EXPECT_FALSE(server.log().contains("unix"));
}

TEST(Front, ClosesAtOnceWhatDoesNotSpeakHttp2) {
  LoggedServer server(local());
  EXPECT_EQ(weft::testing::http(server.address(), "GET", "/"), "");
  EXPECT_TRUE(ask(plain(server)).ok());
}

TEST(Front, ListensAtAllAddressesOfAHostWithOnePort) {
  ServerOptions options{.listen = {"localhost:0"}, .service = {}};
  LoggedServer server(options);
  EXPECT_TRUE(ask(plain(server)).ok());
  const std::string port = server.address().substr(server.address().rfind(':'));
  EXPECT_TRUE(ask(channel_to("127.0.0.1" + port, grpc::InsecureChannelCredentials())).ok());
}

TEST(Front, MakesRoomByClosingWhoIsIdle) {
  ServerOptions options = local();
  options.max_connections = 2;
  LoggedServer server(options);
  std::vector<std::shared_ptr<grpc::Channel>> channels;
  for (int i = 0; i < 6; ++i) {
    channels.push_back(plain(server));
    EXPECT_TRUE(ask(channels.back()).ok());
  }
  EXPECT_TRUE(server.log().contains("cause=connections"));
}

}  // namespace
}  // namespace weft::server::testing
