// SPDX-License-Identifier: Apache-2.0
#include "server/net/listen.h"

#include <grpcpp/create_channel.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/files/support/temp_folder.h"
#include "tests/server/harness.h"

namespace weft::server {
namespace {

namespace fs = std::filesystem;

class ListenOnUnixSocket : public ::testing::Test {
 protected:
  ListenOnUnixSocket() {
    path_ = folder_ / "s";
    address_ = "unix:" + path_.string();
  }

  auto start() const {
    return Server::start(
        {.listen = {address_}, .service = {}},
        [](const auto&, ChunkSink& sink, auto&) { return testing::send_chunks(sink, 1); },
        make_logger("off"));
  }

  files::TempFolder folder_;
  fs::path path_;
  std::string address_;
};

TEST_F(ListenOnUnixSocket, ServesAndRemovesTheFileAtTheEnd) {
  {
    auto server = start();
    ASSERT_TRUE(server) << server.error();
    EXPECT_EQ((*server)->addresses(), std::vector{address_});
    auto stub =
        v1::MeshService::NewStub(grpc::CreateChannel(address_, grpc::InsecureChannelCredentials()));
    EXPECT_TRUE(testing::call(*stub, testing::valid_request()).status.ok());
  }
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(ListenOnUnixSocket, ReplacesAStaleFile) {
  const pid_t child = ::fork();
  if (child == 0) {  // leaves a socket file that nobody listens on
    const int fd = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    path_.string().copy(name.sun_path, sizeof(name.sun_path) - 1);
    ::_exit(::bind(fd, reinterpret_cast<const sockaddr*>(&name), sizeof(name)));
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_EQ(status, 0);
  ASSERT_TRUE(fs::is_socket(path_));
  const auto server = start();
  EXPECT_TRUE(server) << server.error();
}

TEST_F(ListenOnUnixSocket, LeavesALiveServersSocketAlone) {
  const auto first = start();
  ASSERT_TRUE(first);
  const auto second = start();
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().find(address_), std::string::npos);
  EXPECT_NE(second.error().find("another server"), std::string::npos);
  EXPECT_TRUE(fs::is_socket(path_));
}

TEST_F(ListenOnUnixSocket, LeavesAnyOtherFileAlone) {
  std::ofstream(path_) << "precious";
  const auto server = start();
  ASSERT_FALSE(server);
  EXPECT_NE(server.error().find("no socket"), std::string::npos);
  EXPECT_TRUE(fs::is_regular_file(path_));
}

TEST_F(ListenOnUnixSocket, RefusesAPathThatIsTooLong) {
  EXPECT_NE(claim("unix:" + std::string(200, 'x')).error().find("1 to 107"), std::string::npos);
}

TEST(Listen, TwoServersDoNotShareAPort) {
  testing::TestServer first(
      [](const auto&, ChunkSink& sink, auto&) { return testing::send_chunks(sink, 1); });
  const auto second =
      Server::start({.listen = {first.address()}, .service = {}}, nullptr, make_logger("off"));
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().find(first.address()), std::string::npos);
  EXPECT_NE(second.error().find("in use"), std::string::npos) << second.error();
}

TEST(Listen, ShowsMetricsToOtherMachinesOnlyIfThatIsWanted) {
  ServerOptions options{.listen = {"127.0.0.1:0"}, .metrics = "0.0.0.0:0"};
  const auto engine = [](const auto&, auto&, auto&) { return Summary(); };
  const auto refused = Server::start(options, engine, make_logger("off"));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().find("0.0.0.0:0 would show the metrics"), std::string::npos)
      << refused.error();
  options.insecure = true;
  EXPECT_TRUE(Server::start(options, engine, make_logger("off")));
  options.insecure = false;
  options.metrics = "127.0.0.1:0";
  EXPECT_TRUE(Server::start(options, engine, make_logger("off")));
}

TEST(Listen, UnderstandsHostsAndBrackets) {
  EXPECT_TRUE(claim("127.0.0.1:0"));
  EXPECT_TRUE(claim("localhost:0"));
  EXPECT_EQ(bound_address("[::1]:0", 77), "[::1]:77");
  EXPECT_EQ(bound_address("localhost:0", 77), "localhost:77");
  EXPECT_EQ(bound_address("unix:/a:b", 1), "unix:/a:b");
}

TEST(Listen, RefusesWhatIsNoAddress) {
  for (const char* address :
       {"", "7421", "host", ":1", "host:", "host:x", "host:70000", "::1:5", "127.0.0.1:-1", "[]:1"})
    EXPECT_FALSE(claim(address)) << address;
}

}  // namespace
}  // namespace weft::server
