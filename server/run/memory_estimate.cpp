// SPDX-License-Identifier: Apache-2.0
#include "server/run/memory_estimate.h"

#include "server/wire/translate.h"
#include "weft/weft.h"

namespace weft::server {

std::uint64_t bytes_besides(const Limits& limits) {
  constexpr std::uint64_t kBuffers = std::uint64_t{8} << 20;
  return kBuffers + limits.stream_buffer;
}

std::uint64_t expected_bytes(const v1::GenerateMeshRequest& request, const Limits& limits) {
  return estimate(to_engine(request), to_budget(request.budget(), limits)).bytes;
}

}  // namespace weft::server
