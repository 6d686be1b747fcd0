// SPDX-License-Identifier: Apache-2.0
// The lines of a graph as chains: maximal runs of lines between the same two regions. A node where
// a chain ends is held: a junction, the end of a line, or where a marker ended in the original.
// Chains without such a node are rings. Markers may also change within a chain, where lines of two
// markers were joined.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/base/geometry.h"
#include "engine/domain/simplify/line_graph.h"
#include "engine/domain/stop_poller.h"

namespace weft {

struct Chains {
  struct Node {
    std::uint32_t point;  // index into LineGraph::points
    std::uint32_t chain;
    std::uint32_t before, after;  // nodes; kNone at the ends of a chain that is no ring
    // Of the line to the next node.
    std::int32_t marker;
    std::uint32_t segment;
    // Of the line to the next node of the original chain.
    double error;
  };

  // Its nodes were those from `first` to `last`, in the order along it; the ends of a chain that is
  // no ring are held.
  struct Chain {
    std::uint32_t first, last;
    std::uint32_t start;        // a node that is left: the first if the chain is no ring
    std::uint32_t length;       // nodes that are left
    std::uint32_t left, right;  // regions beside it; kNone is outside
    bool is_ring;
    bool is_dropped = false;
  };

  std::vector<Node> nodes;
  std::vector<Chain> chains;
  // The ends of chains, as (point, node), sorted.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;

  std::span<const std::pair<std::uint32_t, std::uint32_t>> ends_at(std::uint32_t point) const;
  bool is_held(std::uint32_t node) const {
    return nodes[node].before == kNone || nodes[node].after == kNone;
  }
  // The node after this one before any was removed. REQUIRES: there was one.
  std::uint32_t originally_after(std::uint32_t node) const {
    const Chain& chain = chains[nodes[node].chain];
    return node == chain.last ? chain.first : node + 1;
  }
  // REQUIRES: it is not held.
  void remove(std::uint32_t node);
};

// Throws Stopped.
Chains chains_of(const LineGraph& graph, StopPoller& poller);

// Makes the graph's lines those of the chains that are not dropped, between the nodes that are
// left, with the errors that `error` has for the line after each node.
void set_lines(const Chains& chains, const std::vector<double>& error, LineGraph& graph);

}  // namespace weft
