// SPDX-License-Identifier: Apache-2.0
// grpc.health.v1.Health for anyone: says whether this server, or one of its services, accepts
// calls.
//
// gRPC has such a service, but it receives messages of any size from unidentified callers, without
// a time limit: eight calls that never end their message held 2 GiB. This one uses the Admission
// like the other services. On a server with tokens, it does not read an unidentified caller's
// message: it replies for the whole server, whatever service the message names. All services share
// one state. One client, by its name or host, has at most 64 of the 1,024 watches, so that no
// stranger takes them all.
//
// Source: https://github.com/grpc/grpc/blob/master/doc/health-checking.md
// Thread-safety: every function may be called from any thread.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "server/admission/admission.h"
#include "server/net/open_streams.h"

namespace weft::server {

class HealthService final : public RawService {
 public:
  // The admission must outlive the service.
  explicit HealthService(Admission& admission);
  // REQUIRES: no call is open.
  ~HealthService() override;

  // Sets a state and notifies watching clients. "" is the whole server; a service that was never
  // set is unknown.
  void set(const std::string& service, bool serving);
  // Sets the state of all known services.
  void set_all(bool serving);
  // Ends the watches of callers whose token is no longer known.
  void revoke_unknown(const Authenticator& authenticator);

 private:
  class Watch;

  void check(const AdmittedCall& call, const std::string& service);
  void watch(const AdmittedCall& call, const std::string& service);

  OpenStreams<Watch> watches_;
  std::mutex mutex_;  // guards the one below
  std::map<std::string, bool> serving_;
};

}  // namespace weft::server
