// SPDX-License-Identifier: Apache-2.0
#include "checker/mesh/coverage.h"

#include <cmath>

#include "checker/domain/tolerance.h"
#include "checker/geometry/sum.h"
#include "checker/text.h"

namespace weft::check {
namespace {

struct Patch {
  std::uint32_t roundest = 0;  // the triangle with the largest incircle
  double inradius = -1;
  Sum twice_area;
  double perimeter = 0;
};

struct Patches {
  std::vector<std::uint32_t> of_triangle;
  std::vector<Patch> patches;
};

Vec2 centroid(const Mesh& mesh, std::uint32_t t) {
  const auto [a, b, c] = mesh.triangles[t];
  const Vec2 p = mesh.vertices[a], q = mesh.vertices[b], r = mesh.vertices[c];
  return {(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3};
}

std::string name_of_edge(const BentDomain& bent, const Arrangement& arrangement, std::uint32_t e) {
  const Arrangement::Edge& edge = arrangement.edges()[e];
  const auto covers = arrangement.covers(e);
  const std::string segment = covers.empty() ? "a gap" : say("segment ", bent.given[covers[0]]);
  return say(segment, " from ", arrangement.vertices().at(edge.u), " to ",
             arrangement.vertices().at(edge.v));
}

Patches find_patches(const Mesh& mesh, const HalfEdges& half_edges, const ListedEdges& listed) {
  constexpr std::uint32_t kUnset = 0xffffffffu;
  Patches result;
  result.of_triangle.assign(mesh.triangles.size(), kUnset);
  std::vector<std::uint32_t> stack;
  for (std::uint32_t first = 0; first < mesh.triangles.size(); ++first) {
    if (result.of_triangle[first] != kUnset) continue;
    const auto number = static_cast<std::uint32_t>(result.patches.size());
    Patch& patch = result.patches.emplace_back();
    result.of_triangle[first] = number;
    stack.push_back(first);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      double perimeter = 0;
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const Vec2 p = mesh.vertices[half_edges.start(h)], q = mesh.vertices[half_edges.end(h)];
        const double length = std::hypot(q.x - p.x, q.y - p.y);
        perimeter += length;
        if (!half_edges.has_twin(h) || listed.listed[h]) {
          patch.perimeter += length;
        } else if (const std::uint32_t beyond = half_edges.twin(h) / 3;
                   result.of_triangle[beyond] == kUnset) {
          result.of_triangle[beyond] = number;
          stack.push_back(beyond);
        }
      }
      const auto [a, b, c] = mesh.triangles[t];
      const long double twice_area =
          cross_from(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
      patch.twice_area.add(twice_area);
      const double inradius = static_cast<double>(twice_area) / perimeter;
      if (inradius > patch.inradius) {
        patch.inradius = inradius;
        patch.roundest = t;
      }
    }
  }
  return result;
}

}  // namespace

std::vector<std::uint32_t> judge_coverage(const BentDomain& bent, const Arrangement& arrangement,
                                          const std::vector<FaceRole>& roles,
                                          const JoinedFaces& joined, const Mesh& mesh,
                                          const HalfEdges& half_edges, const ListedEdges& listed,
                                          Findings& findings) {
  const double tolerance = on_segment_tolerance(bent.domain);
  const auto explained = [&](double area, double perimeter, double slack) {
    return 1e-12 * std::fabs(area) + 4 * tolerance * (perimeter + tolerance) +
           sliver_area(perimeter, slack);
  };
  Patches patches = find_patches(mesh, half_edges, listed);
  std::vector<Sum> covered(roles.size());
  std::vector<std::uint32_t> face_of_patch;
  std::vector<char> is_sliver;  // per patch
  for (const Patch& patch : patches.patches) {
    const Vec2 centre = centroid(mesh, patch.roundest);
    const Arrangement::Place place = arrangement.locate(centre);
    const double area = static_cast<double>(patch.twice_area.total() / 2);
    const double slack = joined.faces[joined.of[place.face]].slack;
    face_of_patch.push_back(place.face);
    covered[joined.of[place.face]].add(patch.twice_area.total() / 2);
    const bool is_small = area <= explained(area, patch.perimeter, slack);
    is_sliver.push_back(is_small && slack > 0);
    if (is_small) continue;
    if (place.edge)
      findings.add(Rule::kCoverage, [&] {
        return say("triangle ", patch.roundest, " lies across ",
                   name_of_edge(bent, arrangement, *place.edge));
      });
    else if (!roles[place.face].kept && !roles[place.face].open)
      findings.add(Rule::kCoverage, [&] {
        return say("triangle ", patch.roundest, " around ", centre, " lies ",
                   place.face == 0 ? "outside the domain" : "in a hole",
                   "; the area covered there is ", area);
      });
  }

  std::vector<char> judged(roles.size(), 0);
  for (std::uint32_t g = 0; g < 2 * arrangement.edges().size(); ++g) {
    // Each face is named by the first half-edge that belongs to it.
    const std::uint32_t f = joined.of[arrangement.face(g)];
    // The parts of an open face that links divide are each open by themselves.
    if (!roles[f].kept || roles[f].open || joined.is_sliver(f) || judged[f]) continue;
    judged[f] = 1;
    const JoinedFaces::Face& face = joined.faces[f];
    const double area = static_cast<double>(covered[f].total());
    if (std::fabs(area - face.area) <= explained(face.area, face.perimeter, face.slack)) continue;
    findings.add(Rule::kCoverage, [&] {
      return say("the face ", g % 2 == 0 ? "left" : "right", " of ",
                 name_of_edge(bent, arrangement, g / 2), " has the area ", face.area,
                 ", but triangles cover ", area);
    });
  }

  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t patch = patches.of_triangle[t];
    const std::uint32_t face = face_of_patch[patch];
    patches.of_triangle[t] = face;
    const std::int32_t region = mesh.regions.empty() ? 0 : mesh.regions[t];
    if (!(roles[face].kept || roles[face].open) || region == roles[face].region ||
        roles[face].is_region_open || is_sliver[patch])
      continue;
    findings.add(Rule::kRegions, [&] {
      return say("triangle ", t, " at ", centroid(mesh, static_cast<std::uint32_t>(t)),
                 " has the region id ", region, ", it lies in region ", roles[face].region);
    });
  }
  return std::move(patches.of_triangle);
}

}  // namespace weft::check
