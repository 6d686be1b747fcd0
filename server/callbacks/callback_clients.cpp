// SPDX-License-Identifier: Apache-2.0
#include "server/callbacks/callback_clients.h"

#include "server/callbacks/callback_url.h"
#include "server/callbacks/webhook_signature.h"
#include "server/net/table_lines.h"

namespace weft::server {

tl::expected<CallbackClients, std::string> CallbackClients::parse(std::string_view text) {
  CallbackClients table;
  for (const TableLine& line : table_lines(text)) {
    const auto bad = [&](const std::string& reason) { return bad_line(line, reason); };
    if (line.words.size() != 2 && line.words.size() != 3)
      return bad("not of the form NAME SECRET or NAME SECRET URL");
    if (const std::string fault = fault_of_name(line.words[0]); !fault.empty()) return bad(fault);
    auto key = webhook_key(line.words[1]);
    if (!key) return bad("the secret " + key.error());
    CallbackClient& client = table.clients_[std::string(line.words[0])];
    client.keys.push_back(std::move(*key));
    if (line.words.size() == 2) continue;
    if (const auto url = CallbackUrl::parse(line.words[2]); !url)
      return bad("the URL " + url.error());
    if (client.url.empty()) client.url = line.words[2];
  }
  if (table.clients_.empty()) return tl::unexpected(std::string("it holds no secret"));
  return table;
}

const CallbackClient* CallbackClients::find(const std::string& name) const {
  auto found = clients_.find(name);
  if (found == clients_.end()) found = clients_.find("*");
  return found == clients_.end() ? nullptr : &found->second;
}

}  // namespace weft::server
