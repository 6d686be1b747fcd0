// SPDX-License-Identifier: Apache-2.0
// Which connection ends when there are too many, or when they ask too much together.
#include "server/net/connection_table.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace weft::server::testing {
namespace {

using Connection = std::shared_ptr<ConnectionTable::Connection>;

class Table : public ::testing::Test {
 protected:
  void make(const ConnectionTable::Bounds& bounds) {
    table_ = std::make_unique<ConnectionTable>(bounds, "secret");
  }
  // Under this name in `ended_`; a host of its own, unless one is given.
  Connection enter(const std::string& name, const std::string& host = "") {
    return table_->enter("ipv4:" + (host.empty() ? name : host) + ":1",
                         [this, name](const char* cause) { ended_[name] = cause; });
  }
  // gRPC sees it, under the peer that is returned.
  std::string hand_over(const Connection& connection, const std::string& name,
                        const std::string& certificate = "") {
    const std::string inner = table_->next_name();
    EXPECT_TRUE(table_->hand_over(
        connection, {.name = inner,
                     .certificate_name = certificate,
                     .close = [this, name](const char* cause) { ended_[name] = cause; }}));
    return "unix-abstract:" + inner;
  }
  Connection enter_and_hand_over(const std::string& name) {
    Connection connection = enter(name);
    hand_over(connection, name);
    return connection;
  }

  std::map<std::string, std::string> ended_;  // with their causes
  std::unique_ptr<ConnectionTable> table_;
};

TEST(HostOfPeer, IsAnAddressOrTheNetworkOfOne) {
  for (const auto& [peer, host] : std::map<std::string, std::string>{
           {"ipv4:192.0.2.7:4711", "ipv4:192.0.2.7"},
           {"ipv6:%5B2001:db8:1:2:3:4:5:6%5D:4711", "ipv6:%5B2001:db8:1:2::%5D/64"},
           {"ipv6:%5B2001:db8:1:2::7%5D:1", "ipv6:%5B2001:db8:1:2::%5D/64"},
           {"ipv6:%5B2001:db8:1:3::7%5D:1", "ipv6:%5B2001:db8:1:3::%5D/64"},
           {"ipv6:%5B::1%5D:1", "ipv6:%5B::1%5D"},
           {"ipv6:%5B::ffff:192.0.2.7%5D:1", "ipv6:%5B::ffff:192.0.2.7%5D"},
           {"ipv6:%5Bx%5D:1", "ipv6:%5Bx%5D"},
           {"ipv6:%5D:1", "ipv6:%5D"},
           {"unknown", "unknown"}})
    EXPECT_EQ(host_of_peer(peer), host);
}

TEST_F(Table, KnowsAConnectionByThePeerOfItsCalls) {
  make({});
  Connection one = enter("10.0.0.1");
  const std::string peer = hand_over(one, "one", "ann");
  EXPECT_TRUE(table_->has_named(peer));
  EXPECT_EQ(table_->find(peer), one);
  EXPECT_EQ(one->peer(), "ipv4:10.0.0.1:1");
  EXPECT_EQ(one->certificate_name(), "ann");
  one.reset();
  EXPECT_EQ(table_->find(peer), nullptr);
  EXPECT_TRUE(table_->has_named(peer)) << "though it has ended";
  EXPECT_FALSE(table_->has_named("unix-abstract:weft-another-1"));
  EXPECT_FALSE(table_->has_named("unix:"));
  EXPECT_EQ(table_->size(), 0u);
}

TEST_F(Table, ClosesTheOldestThatHasSentNothingForANewOne) {
  make({.connections = 3});
  const Connection known = enter_and_hand_over("known");
  const Connection older = enter("older");
  const Connection newer = enter("newer");
  EXPECT_NE(enter("fourth"), nullptr);
  EXPECT_EQ(ended_, (std::map<std::string, std::string>{{"older", kCauseConnections}}));
}

TEST_F(Table, ClosesTheLongestIdleThatWasNeverAnsweredThenTheLongestIdle) {
  make({.connections = 3});
  const Connection answered = enter_and_hand_over("answered");
  table_->set_load(*answered, {.open = 0, .resets = 0, .answered = 1});
  const Connection silent = enter_and_hand_over("silent");
  const Connection busy = enter_and_hand_over("busy");
  table_->set_load(*busy, {.open = 1});
  const Connection fourth = enter_and_hand_over("fourth");
  table_->set_load(*fourth, {.open = 1});
  EXPECT_EQ(ended_.size(), 1u);
  EXPECT_TRUE(ended_.contains("silent"));
  const Connection fifth = enter_and_hand_over("fifth");
  table_->set_load(*fifth, {.open = 1});
  EXPECT_TRUE(ended_.contains("answered"));
  EXPECT_EQ(enter("sixth"), nullptr) << "all others have calls";
  EXPECT_EQ(ended_.size(), 2u);
}

TEST_F(Table, ClosesOneOfAHostThatHasTooMany) {
  make({.connections = 10, .per_host = 2});
  const Connection other = enter("other");
  const Connection first = enter("first", "10.0.0.1");
  const Connection second = enter("second", "10.0.0.1");
  const Connection third = enter("third", "10.0.0.1");
  EXPECT_NE(third, nullptr);
  EXPECT_EQ(ended_, (std::map<std::string, std::string>{{"first", kCauseConnections}}));
}

TEST_F(Table, GivesAPlaceBackWhenAConnectionEnds) {
  make({.connections = 1, .per_host = 1});
  Connection one = enter_and_hand_over("one");
  table_->set_load(*one, {.open = 1});
  EXPECT_EQ(enter("two", "one"), nullptr);
  one.reset();
  EXPECT_NE(enter("two", "one"), nullptr);
  EXPECT_TRUE(ended_.empty());
}

TEST_F(Table, DoesNotHandOverWhatIsBeingClosed) {
  make({.connections = 1});
  const Connection one = enter("one");
  const Connection two = enter("two");
  EXPECT_FALSE(table_->hand_over(one, {.name = table_->next_name()}));
  EXPECT_EQ(table_->size(), 1u);
}

TEST_F(Table, ClosesTheLargestLoadAndOfEqualsTheYoungest) {
  make({.load = 10});
  const Connection small = enter_and_hand_over("small");
  const Connection large = enter_and_hand_over("large");
  const Connection young = enter_and_hand_over("young");
  table_->set_load(*small, {.open = 2});
  table_->set_load(*large, {.open = 2, .resets = 2});
  table_->set_load(*young, {.open = 4});
  EXPECT_TRUE(ended_.empty());
  table_->set_load(*small, {.open = 3});
  EXPECT_EQ(ended_, (std::map<std::string, std::string>{{"young", kCauseLoad}}));
}

TEST_F(Table, ClosesIdentifiedCallersLast) {
  make({.load = 10});
  const Connection identified = enter_and_hand_over("identified");
  identified->set_identified();
  const Connection stranger = enter_and_hand_over("stranger");
  table_->set_load(*stranger, {.open = 3});
  table_->set_load(*identified, {.open = 9});
  EXPECT_EQ(ended_, (std::map<std::string, std::string>{{"stranger", kCauseLoad}}));
}

TEST_F(Table, LetsCallsBeginInTurns) {
  make({});
  std::vector<Connection> greedy;
  for (std::size_t i = 0; i < ConnectionTable::kMaxTurns / ConnectionTable::kMaxTurnsOfOne; ++i) {
    greedy.push_back(enter(std::to_string(i)));
    for (std::size_t turn = 0; turn < ConnectionTable::kMaxTurnsOfOne; ++turn)
      ASSERT_TRUE(table_->take_turn(*greedy.back()));
    ASSERT_FALSE(table_->take_turn(*greedy.back())) << "one has its share";
  }
  const Connection first = enter("first");
  const Connection second = enter("second");
  EXPECT_FALSE(table_->take_turn(*first));
  std::string woken;
  table_->wait_for_turn(*first, [&] { woken += "first "; });
  table_->wait_for_turn(*second, [&] { woken += "second "; });
  EXPECT_EQ(woken, "");
  const std::string peer = hand_over(greedy.front(), "greedy");
  table_->call_began(peer);
  EXPECT_EQ(woken, "first ");
  EXPECT_FALSE(table_->take_turn(*greedy.front())) << "others wait";
  EXPECT_TRUE(table_->take_turn(*first));
  table_->set_load(*greedy.front(), {.answered = 2});
  EXPECT_EQ(woken, "first second ");
}

TEST_F(Table, EndsTurnsThatTakeTooLongAndThoseOfWhatHasEnded) {
  make({});
  Connection one = enter("one");
  hand_over(one, "one");
  Connection gone = enter("gone");
  const auto take_all = [&](ConnectionTable::Connection& connection) {
    std::size_t count = 0;
    while (table_->take_turn(connection)) ++count;
    return count;
  };
  EXPECT_EQ(take_all(*one), ConnectionTable::kMaxTurnsOfOne);
  EXPECT_TRUE(table_->has_turns(*one));
  const auto now = ConnectionTable::Clock::now();
  table_->pass_time(now);
  EXPECT_TRUE(table_->has_turns(*one));
  table_->pass_time(now + ConnectionTable::kLongestTurn);
  EXPECT_FALSE(table_->has_turns(*one));
  for (int i = 0; i < 100; ++i) {
    gone = enter("gone");
    ASSERT_EQ(take_all(*gone), ConnectionTable::kMaxTurnsOfOne);
  }
}

TEST_F(Table, ForgetsTheLoadOfWhatHasEnded) {
  make({.load = 10});
  for (int i = 0; i < 100; ++i) {
    const Connection each = enter_and_hand_over(std::to_string(i));
    table_->set_load(*each, {.open = 9});
  }
  EXPECT_TRUE(ended_.empty());
}

}  // namespace
}  // namespace weft::server::testing
