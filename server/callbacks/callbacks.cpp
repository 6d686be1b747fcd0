// SPDX-License-Identifier: Apache-2.0
#include "server/callbacks/callbacks.h"

#include <fmt/format.h>

#include "server/callbacks/callback_url.h"
#include "server/callbacks/webhook_signature.h"

namespace weft::server {

tl::expected<std::unique_ptr<Callbacks>, std::string> Callbacks::open(
    const CallbackOptions& options, Logger log) {
  auto clients = CallbackFile::open(options.clients, std::move(log));
  if (!clients) return tl::unexpected(clients.error());
  std::unique_ptr<Callbacks> callbacks(new Callbacks());
  callbacks->clients_ = std::move(*clients);
  for (const Network& network : options.allowed) callbacks->rules_.allow(network);
  return callbacks;
}

tl::expected<Callback, std::string> Callbacks::accept(const std::string& client,
                                                      const std::string& url) const {
  const auto table = clients_->table();
  const CallbackClient* const known = table->find(client);
  if (known == nullptr && url.empty()) return Callback{};
  if (known == nullptr)
    return tl::unexpected(std::string("the server has no secret for callbacks of this client"));
  const std::string& chosen = url.empty() ? known->url : url;
  if (chosen.empty()) return Callback{};
  const auto parsed = CallbackUrl::parse(chosen);
  if (!parsed) return tl::unexpected("notify " + parsed.error());
  // A name is judged when it is looked up, to be called.
  boost::system::error_code is_a_name;
  const auto address = boost::asio::ip::make_address(parsed->host, is_a_name);
  if (!is_a_name && !rules_.may_reach(address))
    return tl::unexpected(
        fmt::format("notify names {}, which callbacks may not go to", parsed->host));
  return Callback{.url = chosen, .place = parsed->place()};
}

std::string Callbacks::signatures(const std::string& client, std::string_view id,
                                  std::string_view timestamp, std::string_view body) const {
  const auto table = clients_->table();
  const CallbackClient* const known = table->find(client);
  std::string all;
  if (known == nullptr) return all;
  for (const std::string& key : known->keys)
    all += (all.empty() ? "" : " ") + webhook_signature(key, id, timestamp, body);
  return all;
}

}  // namespace weft::server
