// SPDX-License-Identifier: Apache-2.0
// Server reflection, by which grpcurl and similar tools learn of services and messages. It uses the
// Admission, so only identified callers may use it; gRPC's own plugin does not identify callers.
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
  // Lists `services`; types are looked up among all that the program has. The admission must
  // outlive the service.
  ReflectionService(Admission& admission, std::vector<std::string> services);
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
