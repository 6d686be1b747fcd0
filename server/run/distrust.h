// SPDX-License-Identifier: Apache-2.0
// The clients that get no places for light work for a while, because work of theirs that was judged
// light turned out heavy. The first such span is `length`. If it happens again after a span has
// ended, but before its length has passed once more, the next span is twice as long; otherwise it
// is `length` again. So a client that does so all the time delays others less and less often, and
// one mistake is soon forgotten.
//
// Thread-safety: none.
#pragma once

#include <algorithm>
#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace weft::server {

class Distrust {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr Clock::duration kMost = std::chrono::minutes(10);

  explicit Distrust(Clock::duration length) : length_(length) {}

  void turned_out_heavy(const std::string& client, Clock::time_point now) {
    std::erase_if(
        spans_, [now](const auto& each) { return each.second.until + each.second.length <= now; });
    const auto [entry, is_first] = spans_.try_emplace(client, Span{now, length_});
    Span& span = entry->second;
    if (now < span.until) return;  // work that was begun before
    if (!is_first) span.length = std::min(2 * span.length, std::max(kMost, length_));
    span.until = now + span.length;
  }

  bool holds_for(const std::string& client, Clock::time_point now) const {
    const auto found = spans_.find(client);
    return found != spans_.end() && now < found->second.until;
  }

  // All of whom it holds.
  std::vector<std::string> clients(Clock::time_point now) const {
    std::vector<std::string> clients;
    for (const auto& [client, span] : spans_)
      if (now < span.until) clients.push_back(client);
    return clients;
  }

 private:
  struct Span {
    Clock::time_point until;
    Clock::duration length;
  };

  const Clock::duration length_;
  std::map<std::string, Span> spans_;  // per client, until they are forgotten
};

}  // namespace weft::server
