// SPDX-License-Identifier: Apache-2.0
#include "checker/check.h"

#include <optional>
#include <utility>
#include <vector>

#include "checker/arrangement.h"
#include "checker/chains.h"
#include "checker/contacts.h"
#include "checker/coverage.h"
#include "checker/delaunay.h"
#include "checker/domain_rules.h"
#include "checker/fill.h"
#include "checker/gaps.h"
#include "checker/half_edges.h"
#include "checker/listed_edges.h"
#include "checker/overlap.h"
#include "checker/structure.h"
#include "checker/text.h"

namespace weft::check {
namespace {

struct FilledDomain {
  Arrangement arrangement;
  std::vector<FaceRole> roles;  // per face
};

std::optional<FilledDomain> arrange(const Domain& domain, Findings& findings) {
  if (!judge_domain(domain, findings)) return std::nullopt;
  std::vector<Vec2> points = domain.points;
  std::vector<SegmentEnds> segments = domain.segments;
  for (const std::array<Vec2, 2>& link : links_across_gaps(domain)) {
    const auto first = static_cast<std::uint32_t>(points.size());
    points.insert(points.end(), link.begin(), link.end());
    segments.push_back({first, first + 1});
  }
  const Contacts contacts = find_contacts(points, segments, kMaxContacts);
  if (!contacts.complete) {
    findings.add(Rule::kDomain, [] {
      return say("segments meet in more than ", kMaxContacts, " points other than their ends");
    });
    return std::nullopt;
  }
  Arrangement arrangement(points, segments, contacts, domain.segments.size());
  std::vector<FaceRole> roles = fill_faces(domain, arrangement, findings);
  if (findings.total(Rule::kDomain) > 0) return std::nullopt;
  return FilledDomain{std::move(arrangement), std::move(roles)};
}

}  // namespace

Report check(const Domain& domain, const Mesh& mesh, const Requirements& requirements) {
  Report report;
  Findings findings(requirements.listed_violations);
  const auto skip = [&](std::initializer_list<Rule> rules) {
    report.not_judged.insert(report.not_judged.end(), rules);
  };
  report.facts.vertices = mesh.vertices.size();
  report.facts.triangles = mesh.triangles.size();
  report.facts.edges = mesh.edges.size();

  const std::optional<FilledDomain> filled = arrange(domain, findings);
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
    if (judge_overlap(mesh, *half_edges, listed, findings) && filled) {
      const auto& [arrangement, roles] = *filled;
      const InputPoints input_points(domain, mesh);
      judge_points(domain, arrangement, roles, input_points, findings);
      small_input_angles.emplace(
          mesh, listed,
          judge_chains(domain, arrangement, roles, mesh, listed, input_points, findings));
      faces = judge_coverage(domain, arrangement, roles, mesh, *half_edges, listed, findings);
      context = {&*small_input_angles, faces, roles};
    } else {
      skip({Rule::kChains, Rule::kPoints, Rule::kMarkers, Rule::kCoverage, Rule::kRegions,
            Rule::kAngle});
    }
    half_edges.reset();
    judge_quality(mesh, requirements, context, report.facts, findings);
  } else {
    if (findings.total(Rule::kStructure) > 0) skip({Rule::kOrientation});
    if (!sound) skip({Rule::kConformity});
    skip({Rule::kOverlap, Rule::kEdges, Rule::kChains, Rule::kPoints, Rule::kMarkers,
          Rule::kCoverage, Rule::kRegions, Rule::kDelaunay, Rule::kAngle, Rule::kArea});
  }
  findings.write_to(report);
  return report;
}

}  // namespace weft::check
