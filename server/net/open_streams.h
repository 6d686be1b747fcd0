// SPDX-License-Identifier: Apache-2.0
// Keeps the streams of a service alive until their calls have ended, because gRPC holds them by
// plain pointers.
//
//   OpenStreams<MeshCall> open;
//   open.add(call);
//   for (const auto& call : open.all()) call->tick(now);
//   ... when the call has ended for good: open.forget(*call) ...
//
// Thread-safety: every function may be called from any thread.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "server/net/caller.h"
#include "server/net/message_stream.h"

namespace weft::server {

template <class Stream>
class OpenStreams {
 public:
  void add(std::shared_ptr<Stream> stream) {
    std::lock_guard lock(mutex_);
    MessageStream* const key = stream.get();
    streams_.emplace(key, std::move(stream));
  }

  // This may destroy the stream, but not under the lock.
  void forget(MessageStream& stream) {
    std::shared_ptr<Stream> last;
    std::lock_guard lock(mutex_);
    const auto found = streams_.find(&stream);
    last = std::move(found->second);
    streams_.erase(found);
  }

  std::vector<std::shared_ptr<Stream>> all() const {
    std::vector<std::shared_ptr<Stream>> all;
    std::lock_guard lock(mutex_);
    all.reserve(streams_.size());
    for (const auto& [key, stream] : streams_) all.push_back(stream);
    return all;
  }

  // Calls `revoke` of those whose caller the authenticator does not know any more.
  void revoke_unknown(const Authenticator& authenticator) const {
    for (const auto& stream : all())
      if (!authenticator.still_knows(stream->caller())) stream->revoke();
  }

  std::size_t size() const {
    std::lock_guard lock(mutex_);
    return streams_.size();
  }
  bool empty() const { return size() == 0; }

 private:
  mutable std::mutex mutex_;  // guards the one below
  std::map<MessageStream*, std::shared_ptr<Stream>> streams_;
};

}  // namespace weft::server
