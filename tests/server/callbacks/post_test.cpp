// SPDX-License-Identifier: Apache-2.0
#include "server/callbacks/post.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/server/callbacks/receiver.h"
#include "tests/support/event.h"

namespace weft::server {
namespace {

using std::chrono::milliseconds;
using testing::answer_of;
using testing::Received;
using testing::Receiver;

AddressRules loopback() {
  AddressRules rules;
  rules.allow(Network::parse("127.0.0.0/8").value());
  return rules;
}

Posted post(Poster& poster, const std::string& url) {
  return poster.post({.url = CallbackUrl::parse(url).value(),
                      .headers = {{"webhook-id", "1"}},
                      .body = "{\"a\": 1}"});
}

Posted post(const AddressRules& rules, const std::string& url, const PostLimits& limits = {}) {
  Poster poster(rules, limits);
  return post(poster, url);
}

TEST(Post, SendsJsonAndReturnsTheStatus) {
  const Receiver receiver([](const Received&) { return answer_of(200, "", "thanks"); });
  const Posted posted = post(loopback(), receiver.url());
  EXPECT_EQ(posted.status, 200U) << posted.error;
  ASSERT_EQ(receiver.all().size(), 1U);
  const Received request = receiver.all().front();
  EXPECT_EQ(request.line, "POST /hook HTTP/1.1");
  EXPECT_EQ(request.headers.at("host"), "127.0.0.1:" + std::to_string(receiver.port()));
  EXPECT_EQ(request.headers.at("content-type"), "application/json");
  EXPECT_EQ(request.headers.at("webhook-id"), "1");
  EXPECT_EQ(request.body, "{\"a\": 1}");
}

// All of these end at this machine.
TEST(Post, DoesNotReachThisMachineUnlessItIsAllowed) {
  const Receiver receiver([](const Received&) { return answer_of(200); });
  for (const char* host : {"127.0.0.1", "2130706433", "0x7f000001", "017700000001", "0177.0.0.1",
                           "127.1", "0x7f.1", "0.0.0.0", "0", "[::1]", "[::]", "[::ffff:127.0.0.1]",
                           "[::ffff:7f00:1]", "localhost", "LOCALHOST"}) {
    const Posted posted = post({}, receiver.url(host));
    EXPECT_EQ(posted.status, 0U) << host;
    EXPECT_TRUE(posted.refused) << host << ": " << posted.error;
    EXPECT_EQ(posted.error, "the host has no address that callbacks may go to") << host;
  }
  EXPECT_TRUE(receiver.all().empty());
}

TEST(Post, DoesNotReachTheMachinesAroundIt) {
  for (const char* url : {"http://169.254.169.254/latest/meta-data/", "http://[fd00:ec2::254]/",
                          "http://10.0.0.1/", "http://192.168.0.1/", "http://[fe80::1]/",
                          "http://[64:ff9b::a9fe:a9fe]/", "http://100.100.100.200/"})
    EXPECT_TRUE(post({}, url).refused) << url;
}

TEST(Post, ReachesAnAllowedNetworkByAName) {
  const Receiver receiver([](const Received&) { return answer_of(204); });
  EXPECT_EQ(post(loopback(), receiver.url("localhost")).status, 204U);
}

TEST(Post, FollowsNoRedirection) {
  const Receiver inner([](const Received&) { return answer_of(200); });
  const Receiver outer(
      [&](const Received&) { return answer_of(307, "Location: " + inner.url() + "\r\n"); });
  EXPECT_EQ(post(loopback(), outer.url()).status, 307U);
  EXPECT_TRUE(inner.all().empty());
}

TEST(Post, ReadsOfAnAnswerNoMoreThanItsBounds) {
  const Receiver large(
      [](const Received&) { return answer_of(200, "", std::string(1 << 20, 'x')); });
  EXPECT_EQ(post(loopback(), large.url()).status, 200U);
  const Receiver endless(
      [](const Received&) { return "HTTP/1.1 200 OK\r\nX: " + std::string(1 << 20, 'x'); });
  const Posted posted = post(loopback(), endless.url());
  EXPECT_EQ(posted.status, 0U);
  EXPECT_FALSE(posted.error.empty());
}

TEST(Post, WhatIsNoHttpIsNoAnswer) {
  const Receiver receiver([](const Received&) { return "220 smtp.example.org ESMTP\r\n"; });
  const Posted posted = post(loopback(), receiver.url());
  EXPECT_EQ(posted.status, 0U);
  EXPECT_FALSE(posted.error.empty());
}

TEST(Post, WaitsForAnAnswerForALimitedTime) {
  const Receiver silent([](const Received&) { return ""; });
  const Posted posted = post(loopback(), silent.url(), {.total = milliseconds(200)});
  EXPECT_EQ(posted.status, 0U);
  EXPECT_EQ(posted.error, "it took too long");
}

TEST(Post, WaitsForANameServerForALimitedTime) {
  static Event answered;
  Poster poster(loopback(), {.total = milliseconds(200)}, [](const auto&, const auto&, auto&) {
    EXPECT_TRUE(answered.wait());
    return std::vector<boost::asio::ip::tcp::endpoint>();
  });
  EXPECT_EQ(post(poster, "http://slow.example/").error, "looking up the host took too long");
  poster.stop();
  answered.set();
}

TEST(Post, ABodyThatNeverEndsDoesNotHideItsStatus) {
  const Receiver slow(
      [](const Received&) { return "HTTP/1.1 200 OK\r\nContent-Length: 9\r\n\r\nabc"; });
  EXPECT_EQ(post(loopback(), slow.url(), {.total = milliseconds(500)}).status, 200U);
}

TEST(Post, EndsWhenItIsStopped) {
  const Receiver silent([](const Received&) { return ""; });
  Poster poster(loopback(), {.total = std::chrono::hours(1)});
  Posted posted;
  std::thread sending([&] { posted = post(poster, silent.url()); });
  EXPECT_TRUE(silent.wait_for(1));
  poster.stop();
  sending.join();
  EXPECT_EQ(posted.status, 0U);
  EXPECT_FALSE(posted.error.empty());
  EXPECT_EQ(post(poster, silent.url()).status, 0U);
  EXPECT_EQ(silent.all().size(), 1U);
}

TEST(Post, AHostThatIsNotFoundIsNoRefusal) {
  const Posted posted = post({}, "http://no-such-host.invalid/");
  EXPECT_FALSE(posted.refused);
  EXPECT_TRUE(posted.error.starts_with("the host is not found")) << posted.error;
}

TEST(Post, SendsNothingOverHttpsWithoutACertificateThatItTrusts) {
  const Receiver plain([](const Received&) { return answer_of(200); });
  // It waits for the end of a header, which the first bytes of TLS do not have.
  const Posted posted = post(loopback(), "https://127.0.0.1:" + std::to_string(plain.port()) + "/",
                             {.total = milliseconds(500)});
  EXPECT_EQ(posted.status, 0U);
  EXPECT_FALSE(posted.error.empty());
  EXPECT_TRUE(plain.all().empty());
}

}  // namespace
}  // namespace weft::server
