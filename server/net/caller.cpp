// SPDX-License-Identifier: Apache-2.0
#include "server/net/caller.h"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <strings.h>

#include <algorithm>
#include <optional>

#include "server/observe/log.h"

namespace weft::server {
namespace {

std::string_view view(const grpc::string_ref& text) {
  return {text.data(), text.size()};
}

// nullopt if the caller sent none, or more than one.
std::optional<std::string_view> header(const grpc::ServerContextBase& context,
                                       std::string_view name) {
  const auto [first, end] =
      context.client_metadata().equal_range(grpc::string_ref(name.data(), name.size()));
  if (first == end || std::next(first) != end) return std::nullopt;
  return view(first->second);
}

std::optional<std::string_view> bearer_token(std::optional<std::string_view> value) {
  constexpr std::string_view kScheme = "Bearer ";
  if (!value || value->size() <= kScheme.size() ||
      ::strncasecmp(value->data(), kScheme.data(), kScheme.size()) != 0)
    return std::nullopt;
  return value->substr(kScheme.size());
}

bool all_lower_hex(std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

bool all_zero(std::string_view text) {
  return text.find_first_not_of('0') == std::string_view::npos;
}

}  // namespace

std::string log_fields(const Caller& caller) {
  std::string fields;
  const auto add = [&fields](const char* key, const std::string& value) {
    if (value.empty()) return;
    if (!fields.empty()) fields += ' ';
    fields += fmt::format("{}={}", key, log_value(value));
  };
  add("client", caller.name);
  add("peer", caller.peer);
  add("trace", caller.trace);
  return fields;
}

std::string trace_id(std::string_view traceparent) {
  // VERSION-TRACE-PARENT-FLAGS; versions after the first may append to it.
  constexpr std::size_t kLength = 2 + 1 + 32 + 1 + 16 + 1 + 2;
  if (traceparent.size() < kLength) return "";
  const std::string_view version = traceparent.substr(0, 2);
  const std::string_view trace = traceparent.substr(3, 32);
  const std::string_view parent = traceparent.substr(36, 16);
  const bool form =
      traceparent[2] == '-' && traceparent[35] == '-' && traceparent[52] == '-' &&
      (traceparent.size() == kLength || (version != "00" && traceparent[kLength] == '-'));
  const bool digits = all_lower_hex(version) && all_lower_hex(trace) && all_lower_hex(parent) &&
                      all_lower_hex(traceparent.substr(53, 2));
  if (!form || !digits || version == "ff" || all_zero(trace) || all_zero(parent)) return "";
  return std::string(trace);
}

bool Authenticator::is_console(const grpc::ServerContextBase& context) const {
  const auto secret = header(context, kConsoleSecret);
  return !console_secret_.empty() && secret && secret->size() == console_secret_.size() &&
         CRYPTO_memcmp(secret->data(), console_secret_.data(), secret->size()) == 0;
}

Authenticator::Connection Authenticator::connection_of(const std::string& peer) const {
  return connections_ == nullptr ? nullptr : connections_->find(peer);
}

Caller Authenticator::caller_of(const grpc::ServerContextBase& context,
                                const Connection& connection) const {
  const auto peer = is_console(context) ? header(context, kConsolePeer) : std::nullopt;
  return {.name = {},
          .peer = peer         ? std::string(*peer)
                  : connection ? connection->peer()
                               : context.peer(),
          .trace = trace_id(header(context, "traceparent").value_or(""))};
}

Caller Authenticator::unverified(const grpc::ServerContextBase& context) const {
  return caller_of(context, connection_of(context.peer()));
}

tl::expected<Caller, Failure> Authenticator::identify(
    const grpc::ServerContextBase& context) const {
  const std::string peer = context.peer();
  const Connection connection = connection_of(peer);
  if (connection == nullptr && connections_ != nullptr && connections_->has_named(peer))
    return tl::unexpected(
        Failure{Reason::kUnauthenticated, "", "the connection has ended before the call began"});
  Caller caller = caller_of(context, connection);
  if (tokens_ == nullptr) {
    if (is_console(context))
      caller.name = header(context, kConsoleName).value_or("");
    else if (connection != nullptr)
      caller.name = connection->certificate_name();
    return caller;
  }
  const auto authorization = header(context, "authorization");
  auto name = token_name(authorization);
  if (!name) return tl::unexpected(name.error());
  caller.name = std::move(*name);
  if (connection != nullptr) connection->set_identified();
  caller.token = TokenTable::digest_of(*bearer_token(authorization));
  return caller;
}

bool Authenticator::still_knows(const Caller& caller) const {
  return caller.token.empty() || tokens_->table()->name_of_digest(caller.token) == caller.name;
}

Failure token_revoked() {
  return {Reason::kUnauthenticated, "", "this server knows the token no longer"};
}

tl::expected<std::string, Failure> Authenticator::token_name(
    std::optional<std::string_view> header) const {
  if (tokens_ == nullptr) return "";
  const auto token = bearer_token(header);
  if (!token)
    return tl::unexpected(Failure{Reason::kUnauthenticated, "",
                                  "this server requires a token: `authorization: Bearer TOKEN`"});
  auto name = tokens_->table()->name_of(*token);
  if (!name)
    return tl::unexpected(
        Failure{Reason::kUnauthenticated, "", "this server does not know the token"});
  return std::move(*name);
}

}  // namespace weft::server
