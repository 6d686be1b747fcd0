// SPDX-License-Identifier: Apache-2.0
// Makes the request message for a domain and what its mesh must satisfy.
//
//   if (auto ok = check_sendable(domain); !ok) return tl::unexpected(ok.error());
//   const auto request = make_request(domain, {.size = "0.01", .min_angle_deg = 30});
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "client/call/edge_at.h"
#include "client/call/field_option.h"
#include "client/call/marker_list.h"
#include "client/call/marker_pairs.h"
#include "client/call/name_option.h"
#include "files/base/error.h"
#include "files/formats/domain.h"
#include "files/geo/domain_projection.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

// What the mesh must satisfy. DEFAULT of all optionals: the server's.
struct RequestOptions {
  // The area of triangles or the length of edges: a number, an expression in x, y and the names of
  // fields, or the path of a grid (files/formats/raster.h); both empty: no bound.
  std::string size{};
  std::string edge{};
  std::vector<FieldOption> fields{};
  std::optional<double> gradation{};     // that the length of edges has at most
  bool gradation_within = false;         // the domain, not across land
  std::optional<double> cells_across{};  // edges across the domain, at least about
  std::optional<double> points_per_circle{};
  std::vector<EdgeAt> edge_at{};    // lengths of edges on segments, by marker
  std::vector<NameOption> names{};  // of markers and regions, besides those of the domain's file
  // All of the size, with what its files hold: see with_size.
  std::shared_ptr<const v1::SizeField> size_read{};
  std::vector<std::string> warnings{};  // about these files
  std::optional<double> min_angle_deg{};
  std::optional<double> min_edge{};
  // Segments that stay as they are, by marker; none in the list: all segments.
  std::optional<MarkerList> keep{};
  std::vector<std::int32_t> kept{};                      // these markers as numbers: see with_size
  std::vector<MarkerPair> periodic{};                    // sides that repeat each other
  std::vector<std::array<std::int32_t, 2>> repeating{};  // their markers as numbers: see with_size
  std::optional<v1::Placement> placement{};
  std::optional<std::uint32_t> optimise{};  // sweeps of smoothing
  std::optional<std::uint64_t> max_triangles{};
  std::optional<double> max_seconds{};
  std::optional<std::uint32_t> threads{};
  std::optional<double> snap{};      // features nearer together are merged first
  std::optional<double> simplify{};  // the domain is no finer than this share of the size
  PolygonFill fill = PolygonFill::kUnion;
  bool allow_unrefined = false;  // accept a mesh that misses its bounds without exemption
  bool quadtree = false;         // ask for the quadtree, to draw it
  bool no_cache = false;         // make it anew, even if the server has it in memory
  // For errors, which name the option at fault (option_of): the rows that were given, and whether
  // a manifest gave them.
  std::set<std::string> given{};
  bool from_manifest = false;
};

// `given`, and what the files hold that the size and its fields name. With a projection, the domain
// is in its metres, and the files of fields are projected, too. Errors: kUsage for a size and an
// edge at the same time, and those of the files.
Result<RequestOptions> with_size(const RequestOptions& given, const Domain& domain,
                                 const DomainProjection* projection = nullptr);

// Returns an error (kUnreadableInput) if the domain is too large for any message.
Result<void> check_sendable(const Domain& domain);

// The names that a request has, of which a server sends back what it was sent; those that cannot be
// names are left out.
Names names_of(const v1::Domain& domain);

// REQUIRES: the options come from with_size, or have a size alone that is no path.
v1::GenerateMeshRequest make_request(const Domain& domain, const RequestOptions& request_options);

}  // namespace weft::client
