// SPDX-License-Identifier: Apache-2.0
// What callbacks a server sends: whose, where, and by which secrets they are signed.
#pragma once

#include <memory>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "server/callbacks/address_rules.h"
#include "server/callbacks/callback_clients.h"
#include "server/observe/log.h"
#include "server/store/job_store.h"

namespace weft::server {

struct CallbackOptions {
  std::string clients{};  // the file, see callback_clients.h; empty: no callbacks are sent
  std::vector<Network> allowed{};
};

// Thread-safe.
class Callbacks {
 public:
  // The error names the file. REQUIRES: there is one.
  static tl::expected<std::unique_ptr<Callbacks>, std::string> open(const CallbackOptions& options,
                                                                    Logger log);

  // The callback of a job of this client, who asked for this URL; that which the server has for the
  // client, if any, for an empty one. The error is a sentence for the client.
  tl::expected<Callback, std::string> accept(const std::string& client,
                                             const std::string& url) const;

  // The values of the header `webhook-signature`, separated by blanks; empty if there is no secret.
  std::string signatures(const std::string& client, std::string_view id, std::string_view timestamp,
                         std::string_view body) const;

  const AddressRules& rules() const { return rules_; }
  void reload() { clients_->reload(); }

 private:
  Callbacks() = default;

  std::unique_ptr<CallbackFile> clients_;
  AddressRules rules_;
};

}  // namespace weft::server
