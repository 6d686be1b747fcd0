// SPDX-License-Identifier: Apache-2.0
#include "checker/check.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "checker/domain/bent_domain.h"
#include "checker/domain/domain_rules.h"
#include "checker/domain/joined_faces.h"
#include "checker/domain/near_features.h"
#include "checker/geometry/arrangement.h"
#include "checker/geometry/contacts.h"
#include "checker/geometry/fill.h"
#include "checker/mesh/chains.h"
#include "checker/mesh/coverage.h"
#include "checker/mesh/delaunay.h"
#include "checker/mesh/half_edges.h"
#include "checker/mesh/listed_edges.h"
#include "checker/mesh/overlap.h"
#include "checker/mesh/structure.h"
#include "checker/text.h"

namespace weft::check {
namespace {

struct FilledDomain {
  Arrangement arrangement;
  std::vector<FaceRole> roles;  // per face
  JoinedFaces joined;
  std::vector<Need> needs;  // per face
};

bool complete(const Contacts& contacts, Findings& findings) {
  if (contacts.complete) return true;
  findings.add(Rule::kDomain, [] {
    return say("segments meet in more than ", kMaxContacts, " points other than their ends");
  });
  return false;
}

std::optional<NearFeatures> near_features(const Domain& domain, Findings& findings) {
  if (!judge_domain(domain, findings)) return std::nullopt;
  const Contacts contacts = find_contacts(domain.points, domain.segments, kMaxContacts);
  if (!complete(contacts, findings)) return std::nullopt;
  return find_near_features(domain, contacts);
}

std::optional<FilledDomain> arrange(const BentDomain& bent, Findings& findings) {
  std::vector<Vec2> points = bent.domain.points;
  std::vector<SegmentEnds> segments = bent.domain.segments;
  for (const std::array<Vec2, 2>& link : bent.links) {
    const auto first = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), link.begin(), link.end());
    segments.push_back({first, first + 1});
  }
  const Contacts contacts = find_contacts(points, segments, kMaxContacts);
  if (!complete(contacts, findings)) return std::nullopt;
  Arrangement arrangement(points, segments, contacts, bent.domain.segments.size());
  std::vector<FaceRole> roles = fill_faces(bent, arrangement, findings);
  if (findings.total(Rule::kDomain) > 0) return std::nullopt;
  JoinedFaces joined = join_faces(bent, arrangement, roles);
  std::vector<Need> needs(roles.size());
  for (std::uint32_t f = 0; f < roles.size(); ++f)
    needs[f] = joined.is_sliver(f) || roles[f].open ? Need::kEitherWay
               : roles[f].kept                      ? Need::kAll
                                                    : Need::kNothing;
  return FilledDomain{std::move(arrangement), std::move(roles), std::move(joined),
                      std::move(needs)};
}

// What seems not to be in the mesh, but has to be, may be beside its segment after all. Notes those
// segments; false if there are no new ones.
bool try_without_jumps(const BentDomain& bent, const FilledDomain& filled,
                       std::vector<char>& jumps_last) {
  bool any = false;
  for (std::uint32_t piece = 0; piece < bent.domain.segments.size(); ++piece) {
    char& last = jumps_last[bent.origin[piece]];
    if (!bent.is_gap[piece] || last) continue;
    for (const std::uint32_t e : filled.arrangement.edges_of(piece))
      for (const std::uint32_t h : {2 * e, 2 * e + 1})
        if (filled.needs[filled.arrangement.face(h)] == Need::kAll) last = any = true;
  }
  return any;
}

bool is_a_point(const Domain& domain, const SegmentEnds& ends) {
  const std::size_t n = domain.points.size();
  return ends[0] < n && ends[1] < n && domain.points[ends[0]] == domain.points[ends[1]];
}

Domain without_segments_that_are_points(Domain domain) {
  const bool have_markers = domain.markers.size() == domain.segments.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < domain.segments.size(); ++i) {
    if (is_a_point(domain, domain.segments[i])) continue;
    domain.segments[kept] = domain.segments[i];
    if (have_markers) domain.markers[kept] = domain.markers[i];
    ++kept;
  }
  domain.segments.resize(kept);
  if (have_markers) domain.markers.resize(kept);
  return domain;
}

}  // namespace

Report check(const Domain& domain, const Mesh& mesh, const Requirements& requirements) {
  if (std::any_of(domain.segments.begin(), domain.segments.end(),
                  [&](const SegmentEnds& ends) { return is_a_point(domain, ends); }))
    return check(without_segments_that_are_points(domain), mesh, requirements);
  Report report;
  Findings findings(requirements.listed_violations);
  const auto skip = [&](std::initializer_list<Rule> rules) {
    report.not_judged.insert(report.not_judged.end(), rules);
  };
  report.facts.vertices = mesh.vertices.size();
  report.facts.triangles = mesh.triangles.size();
  report.facts.edges = mesh.edges.size();

  const std::optional<NearFeatures> near = near_features(domain, findings);
  std::optional<FilledDomain> filled;
  QualityContext context;
  std::optional<SmallInputAngles> small_input_angles;
  std::vector<std::uint32_t> faces;

  // What the mesh is by itself, then what it is of the domain.
  const bool sound = judge_structure(mesh, findings) && judge_orientation(mesh, findings);
  std::optional<HalfEdges> half_edges;
  if (sound) half_edges.emplace(mesh);
  if (sound && half_edges->judge_conformity(findings)) {
    const ListedEdges listed = find_listed_edges(mesh, *half_edges, findings);
    judge_delaunay(mesh, *half_edges, listed, findings);
    const bool no_overlap = judge_overlap(mesh, *half_edges, listed, findings);
    BentDomain bent;
    if (near) {
      judge_named_points(domain, *near, mesh, findings);
      std::vector<char> jumps_last(domain.segments.size(), 0);
      for (bool again = true; again;) {
        bent = bend(domain, *near, mesh, listed, jumps_last);
        filled = arrange(bent, findings);
        again = filled && try_without_jumps(bent, *filled, jumps_last);
      }
    }
    if (no_overlap && filled) {
      const auto& [arrangement, roles, joined, needs] = *filled;
      const InputPoints input_points(bent.domain, mesh);
      judge_points(bent, domain.points.size(), arrangement, needs, input_points, findings);
      small_input_angles.emplace(
          mesh, listed,
          judge_chains(bent, arrangement, needs, mesh, listed, input_points, findings));
      faces = judge_coverage(bent, arrangement, roles, joined, mesh, *half_edges, listed, findings);
      context = {&*small_input_angles, faces, roles};
    } else {
      skip({Rule::kChains, Rule::kPoints, Rule::kMarkers, Rule::kCoverage, Rule::kRegions,
            Rule::kAngle});
    }
    half_edges.reset();
    judge_quality(domain, mesh, requirements, context, report.facts, findings);
    judge_lengths(mesh, requirements, findings);
  } else {
    if (near) arrange(unbent(domain), findings);  // for what may be wrong with the domain itself
    if (findings.total(Rule::kStructure) > 0) skip({Rule::kOrientation});
    if (!sound) skip({Rule::kConformity});
    skip({Rule::kOverlap, Rule::kEdges, Rule::kChains, Rule::kPoints, Rule::kMarkers,
          Rule::kCoverage, Rule::kRegions, Rule::kDelaunay, Rule::kAngle, Rule::kArea,
          Rule::kLengths});
  }
  findings.write_to(report);
  return report;
}

}  // namespace weft::check
