// SPDX-License-Identifier: Apache-2.0
// Server reflection, by which grpcurl and its like learn of services and messages. It comes in
// through the Admission, so whoever has a token may ask, and a stranger may not; gRPC's own plugin
// knows no callers.
//
// Both versions of the protocol, v1 and v1alpha, which differ in their names alone.
//
// Source: https://github.com/grpc/grpc/blob/master/doc/server-reflection.md
// Thread-safety: every function may be called from any thread.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "server/admission/admission.h"

namespace weft::server {

class ReflectionService final : public RawService {
 public:
  enum class Version { kV1, kV1Alpha };

  // `services` are listed; what is asked of their types is looked up among those that the program
  // has. The admission outlives the service.
  ReflectionService(Version version, Admission& admission, std::vector<std::string> services);
  // REQUIRES: no call is open.
  ~ReflectionService() override;

 private:
  class Conversation;

  void converse(AdmittedCall& call);
  void forget(const Conversation& conversation);

  const std::vector<std::string> services_;
  std::mutex mutex_;  // guards the one below
  std::unordered_map<const Conversation*, std::shared_ptr<Conversation>> open_;
};

}  // namespace weft::server
