// SPDX-License-Identifier: Apache-2.0
// The names of a domain's markers and regions, as they come over the wire. The mesh does not depend
// on them; they are in the key of a request, so that a mesh that is found again has the names that
// were asked for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "server/wire/errors.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

inline constexpr std::size_t kLongestName = 255;  // bytes
// Of both tables together; what they hold then fits beside the quadtree into a message that a
// client of gRPC takes by default.
inline constexpr std::uint64_t kMaxNames = 16'384;
inline constexpr std::uint64_t kMaxNameBytes = std::uint64_t{1} << 20;

// Refuses (BAD_OPTION) a name that is empty, too long or has control characters, and an id or a
// name that its table has twice; the field is that of the later one. Takes time O(n log n).
// REQUIRES: the names are UTF-8, which parsing checks.
std::optional<Failure> check_names(const v1::Domain& domain);

// Bytes of text in both tables.
std::uint64_t name_bytes(const v1::Domain& domain);

}  // namespace weft::server
