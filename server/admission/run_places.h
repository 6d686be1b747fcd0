// SPDX-License-Identifier: Apache-2.0
// The places in which runs go on, those of calls and those of stored jobs alike: as many at once as
// --jobs says, and some more for light runs only. A client has at most its share of each.
//
// The queue of calls and the runner of jobs guard what they know by `mutex`, so that a place which
// one gives back is the other's at once. If both wait for a place of a lane, they have it in turns:
// a kind says that it waits (set_waits) when it finds none, and the other leaves it the next one,
// but for kTurn at most, because a job is only had from a store that may not answer.
//
//   std::lock_guard lock(places.mutex);
//   if (places.has_share(lane, client) && places.is_free(lane, kind)) places.begin(lane, kind,
//   client);
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace weft::server {

class RunPlaces {
 public:
  enum class Lane : std::uint8_t { kMain, kLight };
  enum class Kind : std::uint8_t { kCall, kJob };

  struct Options {
    std::size_t places = 1;
    std::size_t light = 0;  // on top of the others
    // The fraction of the places in each lane that one client may have; at least one place.
    double client_share = 1;
  };

  explicit RunPlaces(const Options& options);
  RunPlaces(const RunPlaces&) = delete;
  RunPlaces& operator=(const RunPlaces&) = delete;

  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kTurn{1'000};

  std::mutex mutex;  // held by the caller of everything below

  std::size_t places(Lane lane) const { return at(lane).places; }
  std::size_t of_client(Lane lane) const { return at(lane).of_client; }
  // More than the places if runs that paused have gone on.
  std::size_t running(Lane lane) const { return at(lane).running; }

  bool has_place(Lane lane) const { return at(lane).running < at(lane).places; }
  // Whether there is a place, and it is this kind's turn.
  bool is_free(Lane lane, Kind kind) const;
  // Whether the client has less than its share of the places. A job without an owner, "", is
  // nobody's.
  bool has_share(Lane lane, const std::string& client) const;
  // Those without a share of the places left; "" is never one of them.
  std::vector<std::string> full_clients(Lane lane) const;

  void begin(Lane lane, Kind kind, const std::string& client);
  void end(Lane lane, Kind kind, const std::string& client);

  // Whether runs of this kind wait for nothing but a place of this lane.
  void set_waits(Lane lane, Kind kind, bool waits);
  // `told` is called, with the mutex held, when the other kind has left its turn, the last place of
  // a lane, or the last one of a client's share; it must not call back. Empty: nobody is told any
  // more.
  void on_free(Kind kind, std::function<void()> told);

 private:
  static constexpr std::size_t kKinds = 2;

  struct Places {
    std::size_t places;
    std::size_t of_client;
    std::size_t running = 0;
    std::map<std::string, std::size_t> running_of{};  // per client, none is 0
    Kind last = Kind::kJob;                           // that began
    Clock::time_point offered{};                      // when a place was given back
    std::array<bool, kKinds> waits{};
  };

  static std::size_t index(Kind kind) { return static_cast<std::size_t>(kind); }
  static Kind other(Kind kind) { return kind == Kind::kCall ? Kind::kJob : Kind::kCall; }
  Places& at(Lane lane) { return lane == Lane::kMain ? main_ : light_; }
  const Places& at(Lane lane) const { return lane == Lane::kMain ? main_ : light_; }
  void tell(Kind kind) const;

  Places main_;
  Places light_;
  std::array<std::function<void()>, kKinds> told_;
};

}  // namespace weft::server
