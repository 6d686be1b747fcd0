// SPDX-License-Identifier: Apache-2.0
// Looks at a request without parsing it.
//
// Arrays of numbers take at most four times their wire bytes in memory, so the limit on request
// bytes bounds them. Regions are messages: two bytes of wire become about 80 in memory, and a
// hostile request of 256 MiB would take 10 GiB before any limit could be checked.
#pragma once

#include <grpcpp/support/byte_buffer.h>

#include <cstdint>

namespace weft::server {

// The number of domain.regions in the bytes of a GenerateMeshRequest, and of mesh.domain.regions in
// those of a SubmitJobRequest. Of malformed bytes, the number before the fault: parsing then
// refuses them.
std::uint64_t count_regions(const grpc::ByteBuffer& bytes);
std::uint64_t count_submitted_regions(const grpc::ByteBuffer& bytes);

}  // namespace weft::server
