// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/seeded.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "checker/domain/bent_domain.h"
#include "checker/domain/domain_rules.h"
#include "checker/domain/fill.h"
#include "checker/geometry/arrangement.h"
#include "checker/geometry/contacts.h"
#include "checker/report.h"
#include "files/base/text.h"
#include "files/formats/domains/interior_point.h"
#include "files/formats/domains/to_checker.h"

namespace weft::files {
namespace {

constexpr std::size_t kMaxContacts = 2'000'000;

// The first marker that is not 0 of the segments on an edge; lines come before borders of areas.
std::int32_t marker_on(const Domain& domain, const check::BentDomain& bent,
                       std::span<const std::uint32_t> covers) {
  for (const bool of_area : {false, true})
    for (const std::uint32_t piece : covers) {
      const Domain::Segment& segment = domain.segments[bent.origin[piece]];
      if (segment.marker != 0 && (segment.area != 0) == of_area) return segment.marker;
    }
  return 0;
}

// The edges, and then, for the search for seeds, those around each face, which `ranges` gets.
Domain edges_of(const Domain& domain, const check::BentDomain& bent,
                const check::Arrangement& arrangement, std::vector<PolygonRange>& ranges) {
  Domain out;
  for (std::uint32_t v = 0; v < arrangement.vertices().size(); ++v) {
    const check::Vec2 at = arrangement.vertices().at(v);
    out.points.push_back({at.x, at.y});
  }
  std::vector<std::vector<std::uint32_t>> around(arrangement.faces().size());
  for (std::uint32_t e = 0; e < arrangement.edges().size(); ++e) {
    const check::Arrangement::Edge& edge = arrangement.edges()[e];
    out.segments.push_back({edge.u, edge.v, marker_on(domain, bent, arrangement.covers(e))});
    const std::uint32_t left = arrangement.face(2 * e), right = arrangement.face(2 * e + 1);
    if (left == right) continue;
    around[left].push_back(e);
    around[right].push_back(e);
  }
  for (const std::vector<std::uint32_t>& edges : around) {
    ranges.push_back({out.segments.size(), out.segments.size() + edges.size()});
    for (const std::uint32_t e : edges) out.segments.push_back(Domain::Segment(out.segments[e]));
  }
  return out;
}

// Those that no segment ends at.
void add_lone_points(const Domain& domain, Domain& out) {
  std::vector<bool> is_end(domain.points.size(), false);
  for (const Domain::Segment& segment : domain.segments)
    is_end[segment.a] = is_end[segment.b] = true;
  for (std::size_t i = 0; i < is_end.size(); ++i)
    if (!is_end[i]) out.points.push_back(domain.points[i]);
}

}  // namespace

Result<Domain> seeded(Domain domain) {
  if (domain.fill == Domain::Fill::kSeeds && domain.areas.empty()) return domain;
  if (const std::size_t arcs = domain.arcs.size(); arcs > 0) {
    if (auto flat = flatten_arcs(domain); !flat)
      return fail(flat.error().exit, flat.error().message + "; a .pb file keeps arcs");
    domain.warnings.push_back(
        {.kind = WarningKind::kNotWritten,
         .count = arcs,
         .text = with_separators(arcs) + (arcs == 1 ? " arc is" : " arcs are") +
                 " written as chords of 2 degrees, because the format has no areas; a .pb file "
                 "keeps both"});
  }
  std::erase_if(domain.segments, [&](const Domain::Segment& segment) {
    return domain.points[segment.a] == domain.points[segment.b];
  });
  check::Domain given = checker_domain(domain, 0);
  check::Findings findings(0);
  if (!check::judge_domain(given, findings))
    return fail(ExitCode::kUnreadableInput, "the domain has numbers that are no coordinates");
  const check::BentDomain bent = check::unbent(given);
  const check::Contacts contacts =
      check::find_contacts(bent.domain.points, bent.domain.segments, kMaxContacts);
  if (!contacts.complete)
    return fail(ExitCode::kUnreadableInput,
                "the segments meet more than 2,000,000 times, too often to be written with seeds");
  const check::Arrangement arrangement(bent.domain.points, bent.domain.segments, contacts);
  const std::vector<check::FaceRole> roles = check::fill_faces(bent, arrangement, findings);

  std::vector<PolygonRange> ranges;
  Domain out = edges_of(domain, bent, arrangement, ranges);
  std::vector<PolygonRange> wanted;
  std::vector<std::size_t> faces;
  for (std::size_t f = 1; f < roles.size(); ++f) {
    if (roles[f].kept && roles[f].region == 0 && std::isinf(roles[f].max_area)) continue;
    wanted.push_back(ranges[f]);
    faces.push_back(f);
  }
  const auto seeds = interior_points(out, wanted);
  if (!seeds) return tl::unexpected(seeds.error());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const check::FaceRole& role = roles[faces[i]];
    const auto& seed = (*seeds)[i];
    if (!seed) continue;  // no number lies inside
    if (!role.kept)
      out.holes.push_back(*seed);
    else
      out.regions.push_back(
          {*seed, role.region,
           std::isinf(role.max_area) ? std::nullopt : std::optional(role.max_area)});
  }
  out.segments.resize(arrangement.edges().size());
  add_lone_points(domain, out);
  out.region_values = std::move(domain.region_values);
  out.system = std::move(domain.system);
  out.names = std::move(domain.names);
  out.warnings = std::move(domain.warnings);
  return out;
}

}  // namespace weft::files
