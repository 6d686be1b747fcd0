// SPDX-License-Identifier: Apache-2.0
// What the parameters of a request ask of a mesh: the table of parameters, and what they set. The
// names are those of the flags of `weft mesh`, with - or _.
//
//   auto wish = read_wish(target.query);           // or the problem, with the parameter at fault
//   if (auto problem = complete(domain, *wish)) ...   // sets what the domain's names stand for
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "files/formats/mesh_formats.h"
#include "files/formats/name_option.h"
#include "files/geo/projection_options.h"
#include "server/console/problem.h"
#include "weft/v1/mesh_service.pb.h"
#include "wire/domain_field.h"
#include "wire/marker_options.h"

namespace weft::server {

// A field of the size, of the domain itself.
struct NamedDomainField {
  std::string name;
  wire::DomainField field;
};

struct MeshWish {
  v1::GenerateMeshRequest request{};  // all but the domain, once it is complete
  std::string from{};                 // ".geojson"; empty: what the file looks like
  std::string to{};                   // ".vtu"; empty: what Accept wants
  bool stream = false;                // send the file while the mesh arrives
  std::optional<double> timeout{};    // seconds
  std::string request_id{};           // of a job
  std::string notify{};               // URL that is told of its end
  files::PolygonFill fill = files::PolygonFill::kUnion;
  files::ProjectionOptions projection{};
  files::MeshWriteOptions writing{};
  wire::MarkerOptions markers{};
  std::vector<NamedDomainField> fields{};
  std::vector<files::NameOption> names{};
};

// What a parameter is for, in bits of ParameterUses.
enum class ParameterUse : unsigned {
  kDomain = 1,    // and what its mesh must satisfy
  kFile = 2,      // of the mesh
  kWaiting = 4,   // for it
  kJob = 8,       // that is kept
  kArrival = 16,  // of the mesh, while its file is sent
};
using ParameterUses = unsigned;

struct Parameter {
  enum class Type { kSwitch, kNumber, kCount, kText };

  std::string name;  // with _
  Type type = Type::kText;
  std::string about;  // a sentence without a full stop
  std::vector<std::string> choices{};
  bool repeats = false;
  ParameterUse use = ParameterUse::kDomain;
  std::string field{};  // of the request, that it sets; empty: none that an error names
  // Sets it, and returns what is wrong with the text, or "".
  std::function<std::string(const std::string& text, MeshWish& wish)> read{};
};

const std::vector<Parameter>& mesh_parameters();
// Those of some uses.
std::vector<const Parameter*> parameters_for(ParameterUses uses);

using Query = std::vector<std::pair<std::string, std::string>>;

// Error: 400 for a parameter that there is not for these uses, is given twice, or has another form;
// 406 and 415 for a format that is not written, or not read, here.
tl::expected<MeshWish, Problem> read_wish(const Query& query, ParameterUses uses);

// Finds the markers by the names that the domain has; returns what is wrong.
std::optional<Problem> complete(const files::NameTable& markers, MeshWish& wish);

// The parameter that sets a field of the request, among those that were given; empty: none.
std::string parameter_of(std::string_view field, const Query& query);

}  // namespace weft::server
