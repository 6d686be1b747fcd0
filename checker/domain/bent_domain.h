// SPDX-License-Identifier: Apache-2.0
// The domain as the mesh has it: unchanged where no features are near, merged and bent where
// features are nearer to each other than the merging distance T (tolerance.h) allows.
//
// A mesher may choose which of two points replaces both, and through which vertices a segment is
// led. So the checker takes the choice from the mesh, checks it against T, and judges everything
// else against the result, exactly and as strictly as against a domain with nothing to merge:
//   - a point that has another one within T may be a vertex within T of it instead of its own;
//   - a segment with near features may be a path of listed edges within kMaxBend * T of it
//     that never turns back, from the vertex that its one end has become to that of the other;
//   - between the input points and the junctions on that path it is straight, to rounding; if
//     the mesh has none of it, it goes through the points that it must be merged with.
// A wrong choice can gain a mesh no more than T: features that must be merged and are not divide
// faces nonetheless (`links`).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "checker/domain.h"
#include "checker/domain/bent_chain.h"
#include "checker/domain/near_features.h"
#include "checker/edges/listed_edges.h"
#include "checker/mesh.h"

namespace weft::check {

struct BentDomain {
  // Points: those of the input, in order, at their new places; then junctions. Segments: pieces of
  // the input's, in their order, with their markers; none for a segment whose ends have become one.
  Domain domain;
  std::vector<std::uint32_t> origin;  // per piece: the input's segment
  // Per piece: the segment that violations name. That of the input, unless the input is itself
  // derived from a domain with arcs (arc_chains.h).
  std::vector<std::uint32_t> given;
  // Per piece: the area between it and its arc, above 0 if that lies right of it; empty: no arcs.
  std::vector<double> beside_arc;
  std::vector<char> is_gap;   // per piece: whether the mesh seems to lack it
  std::vector<char> is_tear;  // per piece: a gap so short that the mesh need not have it
  // Per piece: the uncertainty of its place because of merging; 0 if nothing is near.
  std::vector<double> slack;
  std::vector<std::array<Vec2, 2>> links;  // bound faces, but are not in the mesh
  double link_slack = 0;                   // the slack of the links
  double rounding = 0;                     // of every place: on_segment_tolerance
  // A listed edge beside a bent segment, and a segment of the input that it is beside, or on.
  struct Beside {
    std::uint32_t edge;
    std::uint32_t segment;
    std::int32_t marker;  // of the segment
  };
  // If several chains are beside each other, it is undefined which edge belongs to which segment:
  // each has an entry for all of them.
  std::vector<Beside> beside;

  // The uncertainty of the place of an edge of the arrangement. `covers`: the pieces that it is
  // part of; empty for a link.
  double slack_of(std::span<const std::uint32_t> covers) const;
};

// The domain itself, with links across gaps. REQUIRES: a domain that judge_domain accepts.
BentDomain unbent(const Domain& domain);

// `jumps` says per segment when its path may jump (bent_chain.h). REQUIRES: also that the mesh's
// structure and conformity hold.
BentDomain bend(const Domain& domain, const NearFeatures& near, const Mesh& mesh,
                const ListedEdges& listed, const std::vector<Jumps>& jumps);

}  // namespace weft::check
