// SPDX-License-Identifier: Apache-2.0
#include "client/commands/area_bound.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "checker/size/gradation.h"
#include "checker/size/gradation_within.h"
#include "checker/size/size.h"
#include "client/commands/checker_input.h"
#include "files/formats/derived/mesh_domain.h"
#include "files/formats/domains/to_checker.h"

namespace weft::client {
namespace {

// A size, and what its function refers to.
struct BoundedSize {
  check::Domain domain;
  check::SizeSpec spec;
  check::Mesh mesh;  // which the limit within the domain refers to
  std::function<double(check::Vec2, double)> limit;
};

// Limits the sizes as the checker does: by those at all vertices and centroids.
void limit_gradation(const std::function<double(check::Vec2)>& size, const Mesh& mesh,
                     BoundedSize& bounded) {
  std::vector<check::Vec2> points;
  points.reserve(mesh.coordinates.size() / 2 + mesh.triangles.size() / 3);
  for (std::size_t i = 0; i < mesh.coordinates.size(); i += 2)
    points.push_back({mesh.coordinates[i], mesh.coordinates[i + 1]});
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const check::Vec2 a = points[mesh.triangles[i]];
    const check::Vec2 b = points[mesh.triangles[i + 1]];
    const check::Vec2 c = points[mesh.triangles[i + 2]];
    points.push_back({(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3});
  }
  std::vector<double> areas(points.size());
  std::transform(points.begin(), points.end(), areas.begin(), size);
  if (!bounded.spec.gradation_within) {
    bounded.limit = check::GradationLimit(points, areas, bounded.spec.gradation);
    return;
  }
  points.resize(mesh.coordinates.size() / 2);
  bounded.mesh.vertices = std::move(points);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3)
    bounded.mesh.triangles.push_back(
        {mesh.triangles[i], mesh.triangles[i + 1], mesh.triangles[i + 2]});
  bounded.limit = check::GradationWithin(bounded.mesh, areas, bounded.spec.gradation);
}

}  // namespace

Result<MakeAreaBound> area_bound(const RequestOptions& size, const std::string& name,
                                 const Mesh& mesh) {
  if (size.size.empty() && size.edge.empty() && size.markers.edge_at.empty())
    return MakeAreaBound();
  const Domain domain = domain_of_mesh(name, mesh.view());
  auto spec = checker_size(size, domain, nullptr);
  if (!spec) return tl::unexpected(spec.error());
  const auto bounded = std::make_shared<BoundedSize>();
  bounded->domain = checker_domain(domain, 0);
  bounded->spec = std::move(*spec);
  const auto function = check::size_function(bounded->spec, bounded->domain);
  if (!function) return fail(ExitCode::kUsage, "the size: " + function.error());
  if (!*function) return MakeAreaBound();  // lengths at markers alone
  if (bounded->spec.gradation > 0) limit_gradation(*function, mesh, *bounded);
  return [bounded]() -> AreaBound {
    return [bounded, value = *check::size_function(bounded->spec, bounded->domain)](Point p) {
      const double area = value({p.x, p.y});
      return bounded->limit ? bounded->limit({p.x, p.y}, area) : area;
    };
  };
}

}  // namespace weft::client
