// SPDX-License-Identifier: Apache-2.0
// A domain and what its mesh must satisfy, as the message that a server takes.
//
//   if (auto ok = check_sendable(domain); !ok) return tl::unexpected(ok.error());
//   const auto request = make_request(domain, {.size = "0.01", .min_angle_deg = 30});
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "client/error.h"
#include "client/formats/domain.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

// What the mesh must satisfy. DEFAULT of all that is optional: the server's.
struct MeshWishes {
  std::string size{};  // a number or an expression in x and y; empty: no bound
  std::optional<double> min_angle_deg{};
  std::optional<double> min_edge{};
  std::optional<std::uint64_t> max_triangles{};
  std::optional<double> max_seconds{};
  std::optional<std::uint32_t> threads{};
  bool quadtree = false;  // of the summary, to draw it
  bool no_cache = false;  // made anew, even if the server has it at hand
};

// An error (kUnreadableInput) where the domain is too large for any message.
Result<void> check_sendable(const Domain& domain);

v1::GenerateMeshRequest make_request(const Domain& domain, const MeshWishes& wishes);

}  // namespace weft::client
