// SPDX-License-Identifier: Apache-2.0
// Makes the request message for a domain and what its mesh must satisfy.
//
//   if (auto ok = check_sendable(domain); !ok) return tl::unexpected(ok.error());
//   const auto request = make_request(domain, {.size = "0.01", .min_angle_deg = 30});
#pragma once

#include <set>
#include <string>
#include <vector>

#include "client/base/files.h"
#include "client/call/field_option.h"
#include "files/base/error.h"
#include "files/formats/domain.h"
#include "files/formats/name_option.h"
#include "files/geo/domain_projection.h"
#include "weft/v1/mesh_service.pb.h"
#include "wire/marker_options.h"

namespace weft::client {

// What the mesh must satisfy. What is not given has the server's default.
struct RequestOptions {
  // The area of triangles or the length of edges: a number, an expression in x, y and the names of
  // fields, or the path of a grid (files/formats/raster.h); both empty: no bound.
  std::string size{};
  std::string edge{};
  std::vector<FieldOption> fields{};
  wire::MarkerOptions markers{};    // of segments
  std::vector<NameOption> names{};  // of markers and regions, besides those of the domain's file
  PolygonFill fill = PolygonFill::kUnion;
  // All other options (wire/named_options.h); of the above what with_size has read.
  v1::GenerateMeshRequest asked{};
  std::vector<std::string> warnings{};  // about files
  // For errors, which name the option at fault (option_of): the rows that were given, and whether
  // a manifest gave them.
  std::set<std::string> given{};
  bool from_manifest = false;
};

// `given`, with all that is asked, but the domain, in `asked`: what the files hold that the size
// and its fields name, and markers as numbers. With a projection, the domain is in its metres, and
// the files of fields are projected, too. Errors: kUsage for a size and an edge at the same time,
// and those of the files.
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
