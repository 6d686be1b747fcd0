// SPDX-License-Identifier: Apache-2.0
// Identifies the caller. The Admission does so first, before a byte of the message is read:
//
//   const auto caller = authenticator.identify(*context);
//   if (!caller) return refuse(caller.error());      // UNAUTHENTICATED, reason UNAUTHENTICATED
//   ... caller->name ...                             // the owner of jobs
//
// The Admission is the only place in gRPC 1.51 where the check applies to every call: an
// AuthMetadataProcessor is not called on unencrypted connections and cannot send an ErrorInfo, an
// interceptor cannot end a call with a status. A test calls every method of every service without a
// token. grpc.health.v1 needs no token.
//
// Before that an unidentified caller can send at most HTTP/2's first window, 64 KiB per stream:
// gRPC receives no more until the message is read. If that is too much, require client
// certificates, too: without one no stream can be opened.
//
// This folder has more than 25 files because all services share it: each listens, lets callers in
// and streams by the same code.
#pragma once

#include <grpcpp/server_context.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

#include "server/net/connection_table.h"
#include "server/net/tokens.h"
#include "server/wire/errors.h"

namespace weft::server {

struct Caller {
  // The name of the token; without a token, the subject's common name, or first alternative name,
  // of the client's certificate; otherwise empty: callers are not told apart.
  std::string name{};
  std::string peer{};   // the address, as gRPC writes it
  std::string trace{};  // W3C trace id, 32 hexadecimal digits; empty if the caller sent none
  std::string token{};  // the digest of its token; empty without one
  std::chrono::steady_clock::time_point since = std::chrono::steady_clock::now();  // of the call

  // Who has a share: the name or, without one, the host.
  std::string client() const {
    if (!name.empty()) return name;
    return host_of_peer(peer);
  }

  double seconds_since() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
  }
};

// With what the streams of a caller end whose token is no longer known.
Failure token_revoked();

// `client=`, `peer=` and `trace=` for a line of the log, without those that are empty.
std::string log_fields(const Caller& caller);

// The trace id in a `traceparent` header; empty if that is malformed.
// Source: https://www.w3.org/TR/trace-context/
std::string trace_id(std::string_view traceparent);

// Metadata by which the console says for which browser it makes a call within the process. It is
// believed only beside the secret, which nobody else has; the console passes none of these on.
inline constexpr std::string_view kConsoleSecret = "weft-console-secret";
inline constexpr std::string_view kConsolePeer = "weft-console-peer";  // the browser's address
inline constexpr std::string_view kConsoleName = "weft-console-name";  // in its certificate

// Thread-safe.
class Authenticator {
 public:
  // `tokens` must outlive the authenticator; null: anyone who can connect may call. Nobody is
  // believed to be the console if `console_secret` is empty. `connections` knows the peers that
  // came over TCP, and outlives the authenticator; null: there are none.
  explicit Authenticator(const TokenFile* tokens, std::string console_secret = "",
                         const ConnectionTable* connections = nullptr)
      : tokens_(tokens), console_secret_(std::move(console_secret)), connections_(connections) {}

  tl::expected<Caller, Failure> identify(const grpc::ServerContextBase& context) const;

  // Whether the token by which the caller was identified still stands for its name.
  bool still_knows(const Caller& caller) const;

  // Returns the caller, without checking the token.
  Caller unverified(const grpc::ServerContextBase& context) const;

  // Returns the name of the token in an `authorization` header; without tokens, an empty one.
  tl::expected<std::string, Failure> token_name(std::optional<std::string_view> header) const;

 private:
  using Connection = std::shared_ptr<ConnectionTable::Connection>;

  bool is_console(const grpc::ServerContextBase& context) const;
  Caller caller_of(const grpc::ServerContextBase& context, const Connection& connection) const;
  // By which the call came; null if that was not TCP, or if it has ended.
  Connection connection_of(const std::string& peer) const;

  const TokenFile* const tokens_;
  const std::string console_secret_;
  const ConnectionTable* const connections_;
};

}  // namespace weft::server
