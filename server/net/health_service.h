// SPDX-License-Identifier: Apache-2.0
// grpc.health.v1.Health, for whoever asks: whether this server, or one of its services, takes
// calls.
//
// gRPC brings such a service, but takes messages of any size from strangers for it, without a
// limit on time: eight calls that never end their message held 2 GiB. This one comes in through the
// Admission as the others do. Of a stranger, on a server that wants tokens, no message is taken in:
// he is told of the whole server, whatever service he names. All services go together here.
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
  // The admission outlives the service.
  explicit HealthService(Admission& admission);
  // REQUIRES: no call is open.
  ~HealthService() override;

  // Those who watch are told. "" is the whole server; a service of which nothing was said is
  // unknown.
  void set(const std::string& service, bool serving);
  // Of every service that is known.
  void set_all(bool serving);

 private:
  class Watch;

  void check(const AdmittedCall& call, const std::string& service);
  void watch(const AdmittedCall& call, const std::string& service);

  OpenStreams<Watch> watches_;
  std::mutex mutex_;  // guards the one below
  std::map<std::string, bool> serving_;
};

}  // namespace weft::server
