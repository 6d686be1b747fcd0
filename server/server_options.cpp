// SPDX-License-Identifier: Apache-2.0
#include "server/server_options.h"

#include <algorithm>

namespace weft::server {

MemoryPlan plan_memory(const ServerOptions& options) {
  const std::uint64_t memory = options.memory;
  const std::uint64_t two_messages = 2 * options.service.limits.max_request_bytes;
  const std::uint64_t receivers = options.console.wanted() ? 2 : 1;
  MemoryPlan plan{.received = std::max(memory / 8, std::min(two_messages, memory / 2)),
                  .kept = memory / 32};
  const std::uint64_t others =
      kBytesOfProcess + plan.kept + receivers * plan.received + options.service.cache_bytes;
  plan.runs = memory - std::min(memory, others);
  return plan;
}

}  // namespace weft::server
