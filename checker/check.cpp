// SPDX-License-Identifier: Apache-2.0
#include "checker/check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "checker/domain/arc_chains.h"
#include "checker/domain/bent_domain.h"
#include "checker/domain/domain_rules.h"
#include "checker/domain/fill.h"
#include "checker/domain/flattened.h"
#include "checker/domain/joined_faces.h"
#include "checker/domain/near_features.h"
#include "checker/domain/simplified_domain.h"
#include "checker/edges/half_edges.h"
#include "checker/edges/listed_edges.h"
#include "checker/geometry/arrangement.h"
#include "checker/geometry/contacts.h"
#include "checker/mesh/arc_rules.h"
#include "checker/mesh/chain_ends.h"
#include "checker/mesh/chains.h"
#include "checker/mesh/coverage.h"
#include "checker/mesh/delaunay.h"
#include "checker/mesh/kept.h"
#include "checker/mesh/layers.h"
#include "checker/mesh/overlap.h"
#include "checker/mesh/periodic.h"
#include "checker/mesh/simplification.h"
#include "checker/mesh/simplified_parts.h"
#include "checker/mesh/skipped_edges.h"
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

// What a mesh is compared with a domain by.
struct Compared {
  const Domain& given;
  const std::optional<ArcChains>& arcs;  // if the given domain has any
  const Domain& domain;                  // without arcs
  const NearFeatures& near;
  const Mesh& mesh;
  const HalfEdges& half_edges;
  const ListedEdges& listed;
};

// The domain as the mesh may have bent it, and how the mesh matches that.
struct Match {
  BentDomain bent{};
  std::optional<FilledDomain> filled{};
  std::vector<SkippedEdge> skipped{};
  Findings findings;
  std::optional<SmallInputAngles> small_input_angles{};  // nullopt if nothing was compared
  std::vector<std::uint32_t> faces{};                    // per triangle
};

void name_as_given(const StraightDomain& straight, BentDomain& bent) {
  for (std::uint32_t& segment : bent.given) segment = straight.origin[segment];
  for (BentDomain::Beside& beside : bent.beside) beside.segment = straight.origin[beside.segment];
}

void measure_to_arcs(const ArcChains& arcs, BentDomain& bent) {
  const auto length = [](const Domain& domain, std::uint32_t segment) {
    const auto [a, b] = domain.segments[segment];
    const Vec2 p = domain.points[a], q = domain.points[b];
    return std::hypot(q.x - p.x, q.y - p.y);
  };
  for (std::uint32_t piece = 0; piece < bent.origin.size(); ++piece) {
    const std::uint32_t segment = bent.origin[piece];
    bent.beside_arc.push_back(arcs.beside[segment] * length(bent.domain, piece) /
                              length(arcs.straight.domain, segment));
  }
}

Match match_with(const Compared& compared, bool no_overlap, const std::vector<Jumps>& jumps,
                 std::uint64_t listed_violations) {
  const auto& [given, arcs, domain, near, mesh, half_edges, listed] = compared;
  Match match{.findings = Findings(listed_violations)};
  match.bent = bend(domain, near, mesh, listed, jumps);
  if (arcs) {
    name_as_given(arcs->straight, match.bent);
    measure_to_arcs(*arcs, match.bent);
  }
  match.filled = arrange(match.bent, match.findings);
  if (!no_overlap || !match.filled) return match;
  const auto& [arrangement, roles, joined, needs] = *match.filled;
  match.skipped = find_skipped_edges(domain, match.bent, mesh, half_edges, listed);
  judge_skipped_edges(match.skipped, match.bent, mesh, match.findings);
  const InputPoints input_points(match.bent.domain, mesh);
  if (arcs) {
    judge_arc_crossings(*arcs, match.bent, arrangement, needs, mesh, match.findings);
    judge_arc_gaps(*arcs, match.bent, arrangement, needs, mesh, listed, match.findings);
  }
  judge_points(match.bent, given.points.size(), arrangement, needs, input_points, match.findings);
  match.small_input_angles.emplace(
      mesh, listed,
      judge_chains(match.bent, arrangement, needs, mesh, listed, input_points, match.findings));
  match.faces = judge_coverage(match.bent, arrangement, roles, joined, mesh, half_edges, listed,
                               match.findings);
  return match;
}

// What seems to be missing from the mesh may lie beside its segment after all. Lets those segments
// jump less; returns false if there are none that may.
bool try_fewer_jumps(const Match& match, std::vector<Jumps>& jumps) {
  if (!match.filled) return false;
  const BentDomain& bent = match.bent;
  std::vector<char> tries(jumps.size(), 0);
  for (const SkippedEdge& edge : match.skipped) tries[bent.origin[edge.piece]] = 1;
  for (std::uint32_t piece = 0; piece < bent.domain.segments.size(); ++piece) {
    if (!bent.is_gap[piece]) continue;
    for (const std::uint32_t e : match.filled->arrangement.edges_of(piece))
      for (const std::uint32_t h : {2 * e, 2 * e + 1})
        if (match.filled->needs[match.filled->arrangement.face(h)] == Need::kAll)
          tries[bent.origin[piece]] = 1;
  }
  bool any = false;
  for (std::size_t s = 0; s < jumps.size(); ++s) {
    if (!tries[s] || jumps[s] == Jumps::kShortest) continue;
    jumps[s] = jumps[s] == Jumps::kFree ? Jumps::kLast : Jumps::kShortest;
    any = true;
  }
  return any;
}

// A mesh is right if it matches the domain bent in one of the ways that merging may have bent it.
Match best_match(const Compared& compared, bool no_overlap, std::uint64_t listed_violations) {
  std::vector<Jumps> jumps(compared.domain.segments.size(), Jumps::kFree);
  std::optional<Match> match;
  do match.emplace(match_with(compared, no_overlap, jumps, listed_violations));
  while (match->findings.any() && try_fewer_jumps(*match, jumps));
  return std::move(*match);
}

bool is_a_point(const Domain& domain, const SegmentEnds& ends) {
  const std::size_t n = domain.points.size();
  return ends[0] < n && ends[1] < n && domain.points[ends[0]] == domain.points[ends[1]];
}

// But for arcs that end at the point where they begin, which judge_domain refuses.
Domain without_segments_that_are_points(Domain domain) {
  std::vector<char> is_refused(domain.segments.size(), 0);
  for (const Arc& arc : domain.arcs)
    if (arc.segment < is_refused.size() && arc.bulge != 0)
      is_refused[arc.segment] = domain.segments[arc.segment][0] == domain.segments[arc.segment][1];
  constexpr std::uint32_t kGone = 0xffffffffu;
  std::vector<std::uint32_t> number(is_refused.size(), kGone);
  const bool have_markers = domain.markers.size() == domain.segments.size();
  const bool have_areas = domain.segment_areas.size() == domain.segments.size();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < domain.segments.size(); ++i) {
    if (!is_refused[i] && is_a_point(domain, domain.segments[i])) continue;
    number[i] = static_cast<std::uint32_t>(kept);
    domain.segments[kept] = domain.segments[i];
    if (have_markers) domain.markers[kept] = domain.markers[i];
    if (have_areas) domain.segment_areas[kept] = domain.segment_areas[i];
    ++kept;
  }
  std::erase_if(domain.arcs, [&](Arc& arc) {
    if (arc.segment >= number.size()) return false;
    arc.segment = number[arc.segment];
    return arc.segment == kGone;
  });
  domain.segments.resize(kept);
  if (have_markers) domain.markers.resize(kept);
  if (have_areas) domain.segment_areas.resize(kept);
  return domain;
}

// What may be wrong with the domain itself.
void judge_without_mesh(const Domain& domain, Findings& findings) {
  const StraightDomain straight = flattened(domain);
  if (!near_features(straight.domain, findings)) return;
  BentDomain bent = unbent(straight.domain);
  name_as_given(straight, bent);
  arrange(bent, findings);
}

// A mesh with layers, as it is judged.
struct Layered {
  Layered(const Mesh& given, const HalfEdges& half_edges, const ListedEdges& all,
          std::vector<bool> layers)
      : is_layer(std::move(layers)),
        mesh(without_regions_of_layers(given, half_edges, all, is_layer)),
        listed(with_edges_of_layers(half_edges, all, is_layer)) {}

  std::vector<bool> is_layer;
  Mesh mesh;           // its regions are those of the domain
  ListedEdges listed;  // and the edges of layers
};

// The sizes are those of the domain as it was given: they may refer to segments that are points.
Report judge(const Domain& domain, const Domain& given, const Mesh& mesh,
             const Requirements& requirements) {
  Report report;
  Findings findings(requirements.listed_violations);
  const auto skip = [&](std::initializer_list<Rule> rules) {
    report.not_judged.insert(report.not_judged.end(), rules);
  };
  report.facts.vertices = mesh.vertices.size();
  report.facts.triangles = mesh.triangles.size();
  report.facts.edges = mesh.edges.size();

  const bool is_well_formed = judge_domain(domain, findings);
  std::optional<Match> match;
  QualityContext context;

  // First what the mesh is by itself, then how it matches the domain.
  const bool sound = judge_structure(mesh, findings) && judge_orientation(mesh, findings);
  std::optional<HalfEdges> half_edges;
  if (sound) half_edges.emplace(mesh);
  if (sound && half_edges->judge_conformity(findings)) {
    const ListedEdges listed = find_listed_edges(mesh, *half_edges, findings);
    std::optional<Layered> layered;
    if (!requirements.layers.empty())
      layered.emplace(mesh, *half_edges, listed,
                      judge_layers(mesh, *half_edges, listed, requirements.layers, findings));
    judge_delaunay(mesh, *half_edges, layered ? layered->listed : listed, findings);
    const bool no_overlap = judge_overlap(mesh, *half_edges, listed, findings);
    std::optional<ArcChains> arcs;
    if (is_well_formed && !domain.arcs.empty()) {
      arcs = find_arc_chains(domain, mesh, listed);
      judge_arc_chords(*arcs, mesh, listed,
                       std::min(kMaxTurn, 360 / requirements.points_per_circle), findings);
      judge_arc_bulges(*arcs, mesh, listed, findings);
    }
    const Domain& straight = arcs ? arcs->straight.domain : domain;
    std::optional<NearFeatures> near;
    if (is_well_formed) near = near_features(straight, findings);
    if (near) {
      judge_named_points(domain, *near, mesh, findings);
      if (near->any) judge_chain_ends(domain, *near, mesh, listed, findings);
      match.emplace(best_match(
          {domain, arcs, straight, *near, layered ? layered->mesh : mesh, *half_edges, listed},
          no_overlap, requirements.listed_violations));
      findings.merge(match->findings);
      if (match->small_input_angles && requirements.keep)
        judge_kept(mesh, match->small_input_angles->segments(),
                   InputPoints(match->bent.domain, mesh), *requirements.keep, findings);
    }
    if (layered && match && match->small_input_angles) {
      SegmentsOfVertices segments = match->small_input_angles->segments();
      add_lines_of_layers(mesh, *half_edges, layered->is_layer, segments);
      match->small_input_angles.emplace(mesh, layered->listed, std::move(segments));
    }
    if (match && match->small_input_angles)
      context = {&*match->small_input_angles, match->faces, match->filled->roles,
                 layered ? &layered->is_layer : nullptr};
    else
      skip({Rule::kChains, Rule::kPoints, Rule::kMarkers, Rule::kCoverage, Rule::kRegions,
            Rule::kAngle});
    judge_periodic(mesh, *half_edges, requirements.periodic, 16 * merging_distance(domain),
                   findings);
    half_edges.reset();
    judge_quality(given, mesh, requirements, context, report.facts, findings);
    judge_lengths(mesh, requirements, findings);
  } else {
    if (is_well_formed) judge_without_mesh(domain, findings);
    if (findings.total(Rule::kStructure) > 0) skip({Rule::kOrientation});
    if (!sound) skip({Rule::kConformity});
    skip({Rule::kOverlap, Rule::kEdges, Rule::kChains, Rule::kPoints, Rule::kMarkers,
          Rule::kCoverage, Rule::kRegions, Rule::kDelaunay, Rule::kAngle, Rule::kArea,
          Rule::kLengths, Rule::kPeriodic, Rule::kLayers, Rule::kSize});
  }
  findings.write_to(report);
  return report;
}

// A mesh of a simplified domain: judged against the segments that it has itself, and these against
// the domain. If the mesh is not sound, that is all that is said of it.
Report judge_simplified(const Domain& domain, const Domain& given, const Mesh& mesh,
                        const Requirements& requirements) {
  Findings findings(requirements.listed_violations);
  const bool sound = judge_domain(domain, findings) && judge_structure(mesh, findings) &&
                     judge_orientation(mesh, findings);
  std::optional<HalfEdges> half_edges;
  if (sound) half_edges.emplace(mesh);
  if (!sound || !half_edges->judge_conformity(findings)) {
    Report report = judge(domain, given, mesh, requirements);
    report.not_judged.push_back(Rule::kSimplified);
    return report;
  }
  if (!domain.arcs.empty())
    return judge_simplified(flattened(domain).domain, given, mesh, requirements);
  const SimplifiedDomain simple = simplified_domain(domain, mesh, *half_edges);
  Report report = judge(simple.domain, given, simple.mesh, requirements);
  const BentDomain original = unbent(domain), own = unbent(simple.domain);
  const auto filled = arrange(original, findings);
  const auto own_filled = arrange(own, findings);
  if (!filled || !own_filled || !report.ok()) {
    report.not_judged.push_back(Rule::kSimplified);
  } else {
    const FacedDomain faced{domain, filled->arrangement, filled->roles};
    judge_parts(faced, mesh, *half_edges, findings);
    judge_simplification(faced, {simple.domain, own_filled->arrangement, own_filled->roles}, mesh,
                         requirements, report.facts, findings);
  }
  findings.add_to(report);
  return report;
}

}  // namespace

Report check(const Domain& domain, const Mesh& mesh, const Requirements& requirements) {
  const bool has_points =
      std::any_of(domain.segments.begin(), domain.segments.end(),
                  [&](const SegmentEnds& ends) { return is_a_point(domain, ends); });
  const auto judge_as = requirements.simplify > 0 ? judge_simplified : judge;
  return has_points ? judge_as(without_segments_that_are_points(domain), domain, mesh, requirements)
                    : judge_as(domain, domain, mesh, requirements);
}

}  // namespace weft::check
