// SPDX-License-Identifier: Apache-2.0
#include "server/front/probe.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <optional>
#include <string>

#include "tests/files/support/temp_folder.h"
#include "tests/server/logged_server.h"
#include "tests/support/certificates.h"
#include "tests/support/event.h"

namespace weft::server::testing {
namespace {

using std::chrono::milliseconds;
using tcp = boost::asio::ip::tcp;
using weft::testing::TestCa;
using weft::testing::TestCertificate;

constexpr milliseconds kShort{50};

// Listens, and accepts nothing until it is told to.
class DeafListener {
 public:
  std::string address() const {
    return "127.0.0.1:" + std::to_string(acceptor_.local_endpoint().port());
  }
  // Takes and ends what waits.
  void accept_some() {
    acceptor_.non_blocking(true);
    boost::system::error_code error;
    while (!error) acceptor_.accept(error);
  }

 private:
  boost::asio::io_context io_;
  tcp::acceptor acceptor_{io_, tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0)};
};

TEST(Answers, AServerAtEachOfItsAddresses) {
  const files::TempFolder folder;
  const std::string socket = "unix:" + (folder / "s").string();
  LoggedServer server({.listen = {"127.0.0.1:0", socket}, .service = {}});
  for (const std::string& address : server->addresses())
    EXPECT_TRUE(answers(address, false, kPatience)) << address;
}

TEST(Answers, AServerThatEncryptsAndWantsCertificates) {
  const files::TempFolder folder;
  const TestCa ca("a CA");
  const TestCertificate own = ca.issue({.common_name = "weftd", .names = {"IP:127.0.0.1"}});
  LoggedServer server({.listen = {"127.0.0.1:0"},
                       .service = {},
                       .tls = {.certificate = folder.write("pem", own.pem),
                               .key = folder.write("key", own.key),
                               .client_ca = folder.write("ca", ca.pem())}});
  EXPECT_TRUE(answers(server.address(), true, kPatience));
}

TEST(Answers, NobodyWhereNobodyAccepts) {
  const DeafListener deaf;
  EXPECT_FALSE(answers(deaf.address(), false, kShort));
  EXPECT_FALSE(answers(deaf.address(), true, kShort));
}

TEST(Answers, NobodyWhereNobodyListens) {
  std::string address;
  {
    const DeafListener gone;
    address = gone.address();
  }
  EXPECT_FALSE(answers(address, false, kShort));
}

TEST(Probe, TellsOfASilentAddressAndThatItIsLost) {
  const DeafListener deaf;
  Log log;
  Event lost;
  const Probe probe({.addresses = {deaf.address()},
                     .interval = milliseconds(1),
                     .patience = kShort,
                     .lost =
                         [&](const std::string& address) {
                           EXPECT_EQ(address, deaf.address());
                           lost.set();
                         }},
                    log.logger());
  EXPECT_TRUE(probe.all_answer());
  EXPECT_TRUE(eventually([&] { return !probe.all_answer(); }));
  EXPECT_TRUE(log.contains("event=address_silent address=")) << log.text();
  EXPECT_TRUE(lost.wait());
  EXPECT_TRUE(log.contains("event=address_lost address=")) << log.text();
}

TEST(Probe, TakesBackWhatItSaidOnceTheAddressAnswers) {
  DeafListener deaf;
  Log log;
  const Probe probe(
      {.addresses = {deaf.address()}, .interval = milliseconds(1), .patience = kShort},
      log.logger());
  EXPECT_TRUE(eventually([&] { return !probe.all_answer(); }));
  EXPECT_TRUE(eventually([&] {
    deaf.accept_some();
    return probe.all_answer();
  }));
  EXPECT_TRUE(log.contains("event=address_answers address=")) << log.text();
}

}  // namespace
}  // namespace weft::server::testing
