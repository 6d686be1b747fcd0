// SPDX-License-Identifier: Apache-2.0
// The clients that get no light slots for a while, because a run of theirs that was estimated to be
// light turned out heavy. The first such span is `length`. If another run turns out heavy after a
// span has ended, but before its length has passed once more, the next span is twice as long, at
// most kMaxLength; otherwise it is `length` again. So a client whose runs always turn out heavy
// delays others less and less often, and one wrong estimate is soon forgotten.
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
  static constexpr Clock::duration kMaxLength = std::chrono::minutes(10);

  explicit Distrust(Clock::duration length) : length_(length) {}

  void turned_out_heavy(const std::string& client, Clock::time_point now) {
    std::erase_if(
        spans_, [now](const auto& each) { return each.second.until + each.second.length <= now; });
    const auto [entry, is_first] = spans_.try_emplace(client, Span{now, length_});
    Span& span = entry->second;
    if (now < span.until) return;  // the run began before that span
    if (!is_first) span.length = std::min(2 * span.length, std::max(kMaxLength, length_));
    span.until = now + span.length;
  }

  bool holds_for(const std::string& client, Clock::time_point now) const {
    const auto found = spans_.find(client);
    return found != spans_.end() && now < found->second.until;
  }

  // The clients for which it holds.
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
