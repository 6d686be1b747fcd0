// SPDX-License-Identifier: Apache-2.0
// Sends a POST to a URL that a stranger chose.
//
// The host is looked up once, and connections go to the addresses that were found then, if
// AddressRules lets them be reached: what a name server answers later does not matter. Redirections
// are not followed. The answer is bounded in time and size; only its status is used. TLS verifies
// the certificate for the host, by the system's authorities.
//
//   Poster poster(rules, {});
//   const Posted posted = poster.post({.url = *url, .headers = {{"webhook-id", id}}, .body =
//   text}); if (posted.status / 100 == 2) ...
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
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

// Returns the addresses of a host, and may take as long as it wants. Thread-safe, and outlives all.
using LookUp = std::vector<boost::asio::ip::tcp::endpoint> (*)(const std::string& host,
                                                               const std::string& port,
                                                               boost::system::error_code& error);

// As the system does.
std::vector<boost::asio::ip::tcp::endpoint> look_up(const std::string& host,
                                                    const std::string& port,
                                                    boost::system::error_code& error);

// Thread-safe.
class Poster {
 public:
  Poster(AddressRules rules, const PostLimits& limits, LookUp look_up = server::look_up);

  // Returns when there is an answer, or will be none.
  Posted post(const PostRequest& request);

  // Ends what is being sent; what is sent later is not.
  void stop();

 private:
  class Sending;

  const AddressRules rules_;
  const PostLimits limits_;
  const LookUp look_up_;
  boost::asio::ssl::context authorities_;
  Mutex mutex_;
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  std::set<boost::asio::io_context*> sending_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace weft::server
