// SPDX-License-Identifier: Apache-2.0
// Sends a POST to a URL that a stranger chose.
//
// The host is looked up once; of its addresses only those that AddressRules lets be reached are
// connected to, as they were found, so that no later answer of a name server matters. Redirections
// are not followed. What comes is bounded in time and size, and ignored but for its status. TLS
// verifies the certificate for the host, by the system's authorities.
//
//   Poster poster(rules, {});
//   const Posted posted = poster.post({.url = *url, .headers = {{"webhook-id", id}}, .body =
//   text}); if (posted.status / 100 == 2) ...
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ssl/context.hpp>
#include <chrono>
#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "server/callbacks/address_rules.h"
#include "server/callbacks/callback_url.h"
#include "server/run/mutex.h"

namespace weft::server {

struct PostRequest {
  CallbackUrl url{};
  std::vector<std::pair<std::string, std::string>> headers{};
  std::string body{};  // JSON
};

struct PostLimits {
  std::chrono::milliseconds connect{5'000};  // to each address
  std::chrono::milliseconds total{20'000};   // after which nothing is sent any more
};

struct Posted {
  unsigned status = 0;   // of the answer; 0: there is none
  bool refused = false;  // no address of the host may be reached
  std::string error{};   // why there is no answer
};

// Thread-safe.
class Poster {
 public:
  Poster(AddressRules rules, const PostLimits& limits);

  // Returns when there is an answer, or will be none. Looking up the host takes as long as the
  // system lets it.
  Posted post(const PostRequest& request);

  // Ends what is being sent; what is sent later is not.
  void stop();

 private:
  class Sending;

  const AddressRules rules_;
  const PostLimits limits_;
  boost::asio::ssl::context authorities_;
  Mutex mutex_;
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  std::set<boost::asio::io_context*> sending_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace weft::server
