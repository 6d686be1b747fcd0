// SPDX-License-Identifier: Apache-2.0
#include "server/net/connection_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/ip/address_v6.hpp>
#include <tuple>
#include <utility>
#include <vector>

namespace weft::server {
namespace {

// How gRPC spells a peer with an abstract unix socket, and what is around an address of IPv6.
constexpr std::string_view kAbstract = "unix-abstract:";
constexpr std::string_view kBeforeAddress = "ipv6:%5B";
constexpr std::string_view kAfterAddress = "%5D";

}  // namespace

std::string host_of_peer(const std::string& peer) {
  std::string host = peer.substr(0, peer.rfind(':'));
  std::string_view text = host;
  if (!text.starts_with(kBeforeAddress) || !text.ends_with(kAfterAddress)) return host;
  text.remove_prefix(kBeforeAddress.size());
  text.remove_suffix(kAfterAddress.size());
  boost::system::error_code failed;
  auto address = boost::asio::ip::make_address_v6(text, failed);
  auto bytes = address.to_bytes();
  const auto half = bytes.begin() + bytes.size() / 2;
  // Loopback, and IPv4 within IPv6, have zeros there.
  if (failed || std::all_of(bytes.begin(), half, [](auto byte) { return byte == 0; })) return host;
  std::fill(half, bytes.end(), 0);
  address = boost::asio::ip::address_v6(bytes);
  return fmt::format("{}{}{}/64", kBeforeAddress, address.to_string(), kAfterAddress);
}

std::size_t connections_of_host(std::size_t connections, double share) {
  constexpr std::size_t kFew = 16;
  return std::max(kFew, static_cast<std::size_t>(share * static_cast<double>(connections)));
}

std::shared_ptr<ConnectionTable::Connection> ConnectionTable::enter(std::string peer, Close close) {
  std::lock_guard lock(mutex_);
  const auto host = hosts_.try_emplace(host_of_peer(peer)).first;
  Host& own = host->second;
  ++own.connections;  // so that it stays while another one of it ends
  const bool too_many_of_host = own.connections > bounds_.per_host;
  if (too_many_of_host || entries_.size() >= bounds_.connections) {
    Connection* const idle = idle_one(too_many_of_host ? &own : nullptr);
    if (idle == nullptr) {
      if (--own.connections == 0) hosts_.erase(host);
      return nullptr;
    }
    end(*idle, kCauseConnections);
  }
  std::shared_ptr<Connection> connection(new Connection, [this](Connection* last) {
    leave(*last);
    delete last;
  });
  connection->peer_ = std::move(peer);
  connection->close_ = std::move(close);
  connection->last_active_ = Clock::now().time_since_epoch().count();
  connection->host_ = &own;
  connection->place_ = entries_.insert(entries_.end(), connection.get());
  return connection;
}

bool ConnectionTable::hand_over(const std::shared_ptr<Connection>& connection, Handover handover) {
  std::lock_guard lock(mutex_);
  if (!connection->listed_) return false;
  connection->name_ = std::move(handover.name);
  connection->certificate_name_ = std::move(handover.certificate_name);
  connection->close_ = std::move(handover.close);
  if (!connection->certificate_name_.empty()) connection->identified_ = true;
  connection->handed_over_ = true;
  handed_over_[connection->name_] = connection;
  return true;
}

bool ConnectionTable::has_named(std::string_view peer) const {
  return peer.starts_with(kAbstract) && peer.substr(kAbstract.size()).starts_with(prefix_);
}

std::shared_ptr<ConnectionTable::Connection> ConnectionTable::find(std::string_view peer) const {
  if (!has_named(peer)) return nullptr;
  std::lock_guard lock(mutex_);
  const auto found = handed_over_.find(std::string(peer.substr(kAbstract.size())));
  return found == handed_over_.end() ? nullptr : found->second.lock();
}

void ConnectionTable::set_load(Connection& connection, const Load& load) {
  connection.open_ = load.open;
  const bool answered_more = connection.answered_.exchange(load.answered) != load.answered;
  connection.last_active_ = Clock::now().time_since_epoch().count();
  const std::uint64_t own = load.open + load.resets;
  const std::uint64_t before = connection.load_.exchange(own);
  const std::uint64_t all = load_ += own - before;  // modulo 2^64
  const bool too_much = all > bounds_.load && own > before;
  if (!answered_more && !too_much) return;
  std::lock_guard lock(mutex_);
  if (answered_more) end_turns(connection, load.answered);
  if (too_much) shed();
}

bool ConnectionTable::take_turn(Connection& connection) {
  std::lock_guard lock(mutex_);
  if (!std::exchange(connection.granted_, false)) {
    const bool has_enough = connection.passed_ - connection.turns_over_ >= kMaxTurnsOfOne;
    if (has_enough || turns_ >= kMaxTurns || !waiting_.empty()) return false;
    ++turns_;
  }
  if (connection.passed_++ == connection.turns_over_) connection.turn_since_ = Clock::now();
  return true;
}

void ConnectionTable::wait_for_turn(Connection& connection, std::function<void()> wake) {
  std::lock_guard lock(mutex_);
  waiting_.emplace_back(&connection, std::move(wake));
  grant_turns();
}

void ConnectionTable::call_began(std::string_view peer) {
  const auto connection = find(peer);
  if (connection == nullptr) return;
  std::lock_guard lock(mutex_);
  end_turns(*connection, ++connection->begun_);
}

void ConnectionTable::pass_time(Clock::time_point now) {
  std::vector<std::shared_ptr<Connection>> all;  // released once the table is unlocked
  std::lock_guard lock(mutex_);
  all.reserve(handed_over_.size());
  for (const auto& [name, weak] : handed_over_) {
    const auto& connection = all.emplace_back(weak.lock());
    if (connection == nullptr || connection->passed_ == connection->turns_over_) continue;
    if (now - connection->turn_since_ >= kLongestTurn) end_turns(*connection, connection->passed_);
  }
}

void ConnectionTable::retire(Connection& connection) {
  std::lock_guard lock(mutex_);
  unlist(connection);
}

bool ConnectionTable::has_turns(const Connection& connection) const {
  std::lock_guard lock(mutex_);
  return connection.passed_ != connection.turns_over_;
}

void ConnectionTable::end_turns(Connection& connection, std::uint64_t upto) {
  upto = std::min(upto, connection.passed_);
  if (upto <= connection.turns_over_) return;
  turns_ -= upto - connection.turns_over_;
  connection.turns_over_ = upto;
  connection.turn_since_ = Clock::now();
  grant_turns();
}

void ConnectionTable::grant_turns() {
  for (auto next = waiting_.begin(); next != waiting_.end() && turns_ < kMaxTurns;) {
    Connection& connection = *next->first;
    if (connection.passed_ - connection.turns_over_ >= kMaxTurnsOfOne) {
      ++next;
      continue;
    }
    ++turns_;
    connection.granted_ = true;
    next->second();
    next = waiting_.erase(next);
  }
}

std::size_t ConnectionTable::size() const {
  std::lock_guard lock(mutex_);
  return entries_.size();
}

void ConnectionTable::unlist(Connection& connection) {
  if (!std::exchange(connection.listed_, false)) return;
  entries_.erase(connection.place_);
  load_ -= connection.load_.exchange(0);
  Host& host = *connection.host_;
  if (--host.connections == 0) hosts_.erase(host_of_peer(connection.peer_));
}

void ConnectionTable::end(Connection& connection, const char* cause) {
  unlist(connection);
  connection.close_(cause);
}

void ConnectionTable::leave(Connection& connection) {
  std::lock_guard lock(mutex_);
  unlist(connection);
  load_ -= connection.load_.exchange(0);  // what it did while it was being closed
  waiting_.remove_if([&](const auto& each) { return each.first == &connection; });
  if (std::exchange(connection.granted_, false)) --turns_;
  end_turns(connection, connection.passed_);
  grant_turns();
  if (connection.handed_over_) handed_over_.erase(connection.name_);
}

ConnectionTable::Connection* ConnectionTable::idle_one(const Host* only) const {
  // Less goes first.
  const auto rank = [](const Connection& connection) {
    return std::tuple(connection.identified_.load(), connection.answered_ != 0,
                      connection.last_active_.load());
  };
  Connection* found = nullptr;
  for (Connection* const each : entries_) {
    if (only != nullptr && each->host_ != only) continue;
    if (!each->handed_over_) return each;
    if (each->open_ == 0 && (found == nullptr || rank(*each) < rank(*found))) found = each;
  }
  return found;
}

void ConnectionTable::shed() {
  // More goes first.
  const auto rank = [](const Connection& connection) {
    return std::pair(!connection.identified_, connection.load_.load());
  };
  while (load_ > bounds_.load) {
    Connection* largest = nullptr;
    for (Connection* const each : entries_)  // of equals, the youngest
      if (largest == nullptr || rank(*each) >= rank(*largest)) largest = each;
    if (largest == nullptr || largest->load_ == 0) return;
    end(*largest, kCauseLoad);
  }
}

}  // namespace weft::server
