// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/mesh_parts.h"

#include <metis.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "files/formats/derived/mesh_edges.h"

namespace weft::files {
namespace {

// The pairs of triangles that have a side in common.
std::vector<std::pair<idx_t, idx_t>> neighbours_of(const MeshView& mesh) {
  const MeshEdges edges(mesh);
  constexpr idx_t kNone = -1;
  std::vector<idx_t> first(edges.size(), kNone);
  std::vector<std::pair<idx_t, idx_t>> pairs;
  pairs.reserve(mesh.triangles.size() / 2);
  for (const std::size_t side : mesh.up_to(mesh.triangles.size())) {
    const auto triangle = static_cast<idx_t>(side / 3);
    idx_t& other = first[edges.of_side(side)];
    if (other != kNone) pairs.emplace_back(other, triangle);
    other = triangle;
  }
  return pairs;
}

}  // namespace

Result<void> check_can_divide() {
  return {};
}

Result<MeshParts> divide(const MeshView& mesh, std::uint32_t parts) {
  const std::size_t triangles = mesh.triangle_count();
  if (parts > triangles)
    return fail(ExitCode::kUsage, "--parts is " + std::to_string(parts) + ", but the mesh has " +
                                      std::to_string(triangles) + " triangles");
  MeshParts made;
  made.of.resize(triangles);
  if (mesh.triangles.size() > static_cast<std::size_t>(std::numeric_limits<idx_t>::max()))
    return fail(ExitCode::kUsage, "--parts: the mesh has too many triangles for METIS");
  const auto pairs = neighbours_of(mesh);
  if (parts > 1) {
    std::vector<idx_t> starts(triangles + 1);
    for (const auto& [a, b] : pairs) ++starts[a], ++starts[b];
    idx_t end = 0;
    for (idx_t& start : starts) start = end += start;
    std::vector<idx_t> beside(2 * pairs.size());
    for (const auto& [a, b] : pairs) {
      beside[--starts[a]] = b;
      beside[--starts[b]] = a;
    }
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 1;
    auto count = static_cast<idx_t>(triangles);
    auto wanted = static_cast<idx_t>(parts);
    idx_t constraints = 1;
    idx_t cut = 0;
    if (METIS_PartGraphKway(&count, &constraints, starts.data(), beside.data(), nullptr, nullptr,
                            nullptr, &wanted, nullptr, nullptr, options, &cut,
                            made.of.data()) != METIS_OK)
      return fail(ExitCode::kUsage, "--parts: METIS cannot divide the mesh");
  }
  std::vector<std::size_t> sizes(parts);
  for (const std::int32_t part : made.of) ++sizes[static_cast<std::size_t>(part)];
  made.least = *std::min_element(sizes.begin(), sizes.end());
  made.most = *std::max_element(sizes.begin(), sizes.end());
  made.cut =
      static_cast<std::size_t>(std::count_if(pairs.begin(), pairs.end(), [&made](const auto& pair) {
        return made.of[static_cast<std::size_t>(pair.first)] !=
               made.of[static_cast<std::size_t>(pair.second)];
      }));
  return made;
}

}  // namespace weft::files
