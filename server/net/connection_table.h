// SPDX-License-Identifier: Apache-2.0
// All connections that weftd accepted over TCP: who is at their other ends, and which of them ends
// when there are too many, or when they ask too much together.
//
//   ConnectionTable table({.connections = 1000, .per_host = 750, .load = 1024}, secret);
//   auto connection = table.enter("ipv4:192.0.2.7:4711", close);   // may close another
//   if (connection == nullptr) return;                             // nobody gives way
//   table.set_load(*connection, {.open = 3, .resets = 0, ...});
//   ... connection.reset() ...
//
// A connection beyond a bound takes the place of another one: of its own host if that has too many.
// First go those that have sent nothing that gRPC may see, the oldest first; then those without a
// call, first if none of theirs was ever answered, the longest idle first. One that has an open
// call is not closed for a new connection.
//
// The load of a connection is the streams that it has open and those that it has reset in this
// second: gRPC 1.51 keeps 10 to 70 KB for each. If the load of all is above the bound, the
// connection with the largest ends; of equals the youngest. A caller who was identified
// ends last.
//
// Calls begin in turns: gRPC has at most kMaxTurns calls that were passed to it and that it has not
// handed over, of one connection kMaxTurnsOfOne. Without that bound, calls wait in gRPC, where it
// serves neither the memory nor other callers' patience. Connections that wait have the next turn
// in the order in which they came. A turn is over when the call begins, is answered by gRPC
// itself, or after kLongestTurn.
//
// Thread-safety: every function may be called from any thread.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace weft::server {

class ConnectionTable {
 public:
  using Clock = std::chrono::steady_clock;
  struct Bounds {
    std::size_t connections = 1024;
    std::size_t per_host = 1024;
    std::uint64_t load = 1024;  // see above
  };
  class Connection;
  // Called with the cause, one of kCauses, on any thread, at most once, while the table is locked.
  using Close = std::function<void(const char* cause)>;

  // `secret` is part of the names that connections have within the process, so that nobody else can
  // have one.
  ConnectionTable(const Bounds& bounds, std::string_view secret)
      : bounds_(bounds), prefix_("weft-" + std::string(secret) + "-") {}

  // `peer` is an address as gRPC spells it, see host_of_peer. Null if the connection must be
  // closed. The connection leaves the table when its last owner releases it; the table outlives it.
  std::shared_ptr<Connection> enter(std::string peer, Close close);

  // The name of the abstract unix socket by which gRPC tells the next connection from others.
  std::string next_name() { return prefix_ + std::to_string(++names_); }

  struct Handover {
    std::string name;              // from next_name
    std::string certificate_name;  // empty if the client has shown none that was verified
    Close close;                   // instead of the first one
  };
  // From now on gRPC may see what it sends. False if it is being closed.
  bool hand_over(const std::shared_ptr<Connection>& connection, Handover handover);

  // Whether a call with this peer, as gRPC spells it, came through a connection of this table.
  bool has_named(std::string_view peer) const;
  // That connection; null if it has ended.
  std::shared_ptr<Connection> find(std::string_view peer) const;

  struct Load {
    std::uint64_t open = 0;      // streams
    std::uint64_t resets = 0;    // in this second
    std::uint64_t answered = 0;  // streams, ever
  };
  void set_load(Connection& connection, const Load& load);

  static constexpr std::size_t kMaxTurns = 64;
  static constexpr std::size_t kMaxTurnsOfOne = 16;
  static constexpr std::chrono::milliseconds kLongestTurn{250};

  // Whether the connection may pass a call to gRPC now.
  bool take_turn(Connection& connection);
  // Calls `wake` once it may, perhaps at once; it then takes its turn. At most one waits.
  void wait_for_turn(Connection& connection, std::function<void()> wake);
  // gRPC has handed over a call of this peer.
  void call_began(std::string_view peer);
  // Ends turns that have taken too long.
  void pass_time(Clock::time_point now);

  // It no longer counts, and never closes; calls that were passed to gRPC still begin.
  void retire(Connection& connection);
  // Whether all calls that it has passed to gRPC have begun.
  bool has_turns(const Connection& connection) const;

  std::size_t size() const;

 private:
  using Entries = std::list<Connection*>;
  struct Host {
    std::size_t connections = 0;
  };

  void leave(Connection& connection);

  // REQUIRES of those below: mutex_ is held.
  void unlist(Connection& connection);
  void end(Connection& connection, const char* cause);
  Connection* idle_one(const Host* only) const;
  void shed();
  void end_turns(Connection& connection, std::uint64_t upto);
  void grant_turns();

  const Bounds bounds_;
  const std::string prefix_;
  std::atomic<std::uint64_t> names_{0};
  std::atomic<std::uint64_t> load_{0};
  mutable std::mutex mutex_;  // guards all below
  Entries entries_;           // the oldest first, without those that are being closed
  std::map<std::string, Host> hosts_;
  std::unordered_map<std::string, std::weak_ptr<Connection>> handed_over_;  // by name
  std::size_t turns_ = 0;  // that are taken or granted
  std::list<std::pair<Connection*, std::function<void()>>> waiting_;
};

// One connection. Its strings do not change once it was handed over.
class ConnectionTable::Connection {
 public:
  const std::string& peer() const { return peer_; }
  const std::string& certificate_name() const { return certificate_name_; }

  // A caller on it has been identified.
  void set_identified() { identified_ = true; }

 private:
  friend class ConnectionTable;

  std::string peer_;
  std::string name_;
  std::string certificate_name_;
  Close close_;
  Host* host_ = nullptr;
  std::atomic<bool> identified_{false};
  std::atomic<bool> handed_over_{false};
  std::atomic<std::uint64_t> open_{0};
  std::atomic<std::uint64_t> load_{0};
  std::atomic<std::uint64_t> answered_{0};
  std::atomic<Clock::rep> last_active_{0};
  // Guarded by the table's mutex.
  bool listed_ = true;
  Entries::iterator place_;
  bool granted_ = false;          // a turn that is not taken yet
  std::uint64_t passed_ = 0;      // calls to gRPC
  std::uint64_t begun_ = 0;       // of these
  std::uint64_t turns_over_ = 0;  // of these
  Clock::time_point turn_since_{};
};

// The causes for which the table closes connections.
inline constexpr const char* kCauseConnections = "connections";
inline constexpr const char* kCauseLoad = "load";

// "ipv4:192.0.2.7" of "ipv4:192.0.2.7:4711". Of IPv6 the first 64 bits, because whoever has one
// such address has all of its network: "ipv6:%5B2001:db8::%5D/64" of "ipv6:%5B2001:db8::7%5D:4711".
std::string host_of_peer(const std::string& peer);

// How many of all connections one host may have: its share, but a few in any case.
std::size_t connections_of_host(std::size_t connections, double share);

}  // namespace weft::server
