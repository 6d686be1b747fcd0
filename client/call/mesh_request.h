// SPDX-License-Identifier: Apache-2.0
// Makes the request message for a domain and what its mesh must satisfy.
//
//   if (auto ok = check_sendable(domain); !ok) return tl::unexpected(ok.error());
//   const auto request = make_request(domain, {.size = "0.01", .min_angle_deg = 30});
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "client/base/error.h"
#include "client/formats/domain.h"
#include "client/formats/raster.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

// What the mesh must satisfy. DEFAULT of all optionals: the server's.
struct RequestOptions {
  // A number, an expression in x and y, or the path of a grid (formats/raster.h); empty: no
  // bound.
  std::string size{};
  // The values of that grid: see with_raster.
  std::shared_ptr<const Raster> raster{};
  std::optional<double> min_angle_deg{};
  std::optional<double> min_edge{};
  std::optional<v1::Placement> placement{};
  std::optional<std::uint32_t> optimise{};  // sweeps of smoothing
  std::optional<std::uint64_t> max_triangles{};
  std::optional<double> max_seconds{};
  std::optional<std::uint32_t> threads{};
  std::optional<double> snap{};  // features nearer together are merged first
  bool allow_unrefined = false;  // accept a mesh that misses its bounds without excuse
  bool quadtree = false;         // ask for the quadtree, to draw it
  bool no_cache = false;         // make it anew, even if the server has it in memory
};

// Reads the grid if the size is the path of one.
Result<RequestOptions> with_raster(RequestOptions request_options);

// Returns an error (kUnreadableInput) if the domain is too large for any message.
Result<void> check_sendable(const Domain& domain);

// REQUIRES: the size is not a path, or its grid was read.
v1::GenerateMeshRequest make_request(const Domain& domain, const RequestOptions& request_options);

}  // namespace weft::client
