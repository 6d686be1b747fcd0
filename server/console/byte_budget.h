// SPDX-License-Identifier: Apache-2.0
// Bytes that requests hold while they are on their way, of all clients together and of each.
//
//   ByteBudget budget(std::uint64_t{1} << 30, 0.75);
//   ByteBudget::Held held(budget, "ann");
//   if (!held.hold(bytes)) return refuse();   // before they are taken; they go back with `held`
//
// Not thread-safe.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

namespace weft::server {

class ByteBudget {
 public:
  // `share`: what one client may hold of it in several holdings together, above 0 to 1. What is the
  // only one of its client has no such bound.
  explicit ByteBudget(std::uint64_t capacity, double share = 1)
      : free_(capacity),
        most_of_client_(share < 1
                            ? static_cast<std::uint64_t>(share * static_cast<double>(capacity))
                            : capacity) {}

  // What one request holds. The budget outlives it.
  class Held {
   public:
    Held(ByteBudget& budget, std::string client) : budget_(budget), client_(std::move(client)) {}
    ~Held() { hold(0); }
    Held(const Held&) = delete;
    Held& operator=(const Held&) = delete;

    // Holds so many from now on; false, and as many as before, if they are not free.
    bool hold(std::uint64_t bytes);
    std::uint64_t bytes() const { return bytes_; }

   private:
    ByteBudget& budget_;
    const std::string client_;
    std::uint64_t bytes_ = 0;
  };

 private:
  std::uint64_t free_;
  const std::uint64_t most_of_client_;
  std::map<std::string, std::uint64_t> of_clients_;  // without those that hold nothing
};

inline bool ByteBudget::Held::hold(std::uint64_t bytes) {
  if (bytes == bytes_) return true;
  const auto found = budget_.of_clients_.find(client_);
  const std::uint64_t others = (found == budget_.of_clients_.end() ? 0 : found->second) - bytes_;
  if (bytes > bytes_) {
    if (bytes - bytes_ > budget_.free_) return false;
    if (others > 0 && bytes > budget_.most_of_client_ - std::min(others, budget_.most_of_client_))
      return false;
  }
  budget_.free_ += bytes_;
  budget_.free_ -= bytes;
  bytes_ = bytes;
  if (others + bytes > 0)
    budget_.of_clients_[client_] = others + bytes;
  else
    budget_.of_clients_.erase(client_);
  return true;
}

}  // namespace weft::server
