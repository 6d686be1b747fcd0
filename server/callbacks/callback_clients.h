// SPDX-License-Identifier: Apache-2.0
// Whose jobs may have callbacks, from a file of lines `NAME SECRET [URL]`: the secret signs them,
// the URL is told of jobs that name none. NAME is that of the client's token or certificate, or *
// for all others. A name may have several lines: callbacks are signed with each secret, so that one
// can replace another, and go to the first URL.
//
//   # /etc/weft/callbacks
//   ann whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw
//   ci  whsec_GKYqrTwjUPD8ILPZIo2LaLaSwMfKQ9r8 https://ci.example.org/weft
//
// See watched_file.h for how it is read, and webhook_signature.h for the form of secrets.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "server/net/watched_file.h"

namespace weft::server {

struct CallbackClient {
  std::vector<std::string> keys{};  // at least one
  std::string url{};                // empty: none
};

class CallbackClients {
 public:
  static constexpr const char* kHolds = "secrets";

  // The error names the line, and never repeats a secret. A table without lines is an error.
  static tl::expected<CallbackClients, std::string> parse(std::string_view text);

  // Null if the client may have no callbacks.
  const CallbackClient* find(const std::string& name) const;
  std::size_t size() const { return clients_.size(); }

 private:
  std::map<std::string, CallbackClient> clients_;
};

using CallbackFile = WatchedFile<CallbackClients>;

}  // namespace weft::server
