// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/simplify/chains.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace weft {
namespace {

// A line as it leaves one of its ends.
struct Spoke {
  std::uint32_t line;
  bool forward;  // leaves from its end a
};

class ChainBuilder {
 public:
  ChainBuilder(const LineGraph& graph, StopPoller& poller)
      : graph_(graph),
        poller_(poller),
        first_(graph.points.size() + 1, 0),
        done_(graph.lines.size(), false) {
    for (const GraphLine& line : graph.lines) ++first_[line.a + 1], ++first_[line.b + 1];
    for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
    spokes_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::uint32_t l = 0; l < graph.lines.size(); ++l) {
      spokes_[next[graph.lines[l].a]++] = {l, true};
      spokes_[next[graph.lines[l].b]++] = {l, false};
    }
  }

  Chains build() {
    for (const bool rings : {false, true})
      for (std::uint32_t v = 0; v < graph_.points.size(); ++v)
        if (rings || is_held(v))
          for (const Spoke& spoke : at(v))
            if (!done_[spoke.line]) walk(v, spoke, rings);
    std::sort(chains_.ends.begin(), chains_.ends.end());
    return std::move(chains_);
  }

 private:
  std::span<const Spoke> at(std::uint32_t v) const {
    return std::span(spokes_).subspan(first_[v], first_[v + 1] - first_[v]);
  }
  std::uint32_t left(Spoke s) const {
    return s.forward ? graph_.lines[s.line].left : graph_.lines[s.line].right;
  }
  std::uint32_t right(Spoke s) const { return left({s.line, !s.forward}); }

  bool is_held(std::uint32_t v) const {
    const auto spokes = at(v);
    if (spokes.size() != 2) return !spokes.empty();
    return graph_.is_end[v] || left(spokes[0]) != right(spokes[1]) ||
           right(spokes[0]) != left(spokes[1]);
  }

  void walk(std::uint32_t v, Spoke spoke, bool is_ring) {
    const std::uint32_t start = v;
    const auto chain = static_cast<std::uint32_t>(chains_.chains.size());
    const auto first = static_cast<std::uint32_t>(chains_.nodes.size());
    chains_.chains.push_back({.first = first,
                              .last = first,
                              .start = first,
                              .length = 0,
                              .left = left(spoke),
                              .right = right(spoke),
                              .is_ring = is_ring});
    const auto add = [&](std::uint32_t point, const GraphLine& line) {
      const auto n = static_cast<std::uint32_t>(chains_.nodes.size());
      chains_.nodes.push_back({.point = point,
                               .chain = chain,
                               .before = n - 1,
                               .after = n + 1,
                               .marker = line.marker,
                               .segment = line.segment,
                               .error = line.error});
    };
    while (true) {
      poller_.step();
      const GraphLine& line = graph_.lines[spoke.line];
      add(v, line);
      done_[spoke.line] = true;
      v = spoke.forward ? line.b : line.a;
      if (is_ring ? v == start : is_held(v)) break;
      const auto spokes = at(v);
      spoke = spokes[spokes[0].line == spoke.line ? 1 : 0];
    }
    if (!is_ring) add(v, {});
    const auto last = static_cast<std::uint32_t>(chains_.nodes.size() - 1);
    chains_.chains.back().last = last;
    chains_.chains.back().length = last - first + 1;
    chains_.nodes[first].before = is_ring ? last : kNone;
    chains_.nodes[last].after = is_ring ? first : kNone;
    if (is_ring) return;
    for (const std::uint32_t end : {first, last})
      chains_.ends.emplace_back(chains_.nodes[end].point, end);
  }

  const LineGraph& graph_;
  StopPoller& poller_;
  std::vector<std::size_t> first_;  // per point: of its spokes
  std::vector<Spoke> spokes_;
  std::vector<bool> done_;  // per line
  Chains chains_;
};

}  // namespace

std::span<const std::pair<std::uint32_t, std::uint32_t>> Chains::ends_at(
    std::uint32_t point) const {
  const auto before = [](const auto& p, const auto& q) { return p.first < q.first; };
  const auto [from, to] = std::equal_range(ends.begin(), ends.end(), std::pair{point, 0u}, before);
  return {from, to};
}

void Chains::remove(std::uint32_t node) {
  const Node& n = nodes[node];
  Chain& chain = chains[n.chain];
  nodes[n.before].after = n.after;
  nodes[n.after].before = n.before;
  if (chain.start == node) chain.start = n.after;
  --chain.length;
}

Chains chains_of(const LineGraph& graph, StopPoller& poller) {
  return ChainBuilder(graph, poller).build();
}

void set_lines(const Chains& chains, const std::vector<double>& error, LineGraph& graph) {
  graph.lines.clear();
  for (const Chains::Chain& chain : chains.chains) {
    if (chain.is_dropped) continue;
    std::uint32_t n = chain.start;
    while (chains.nodes[n].after != kNone) {
      const Chains::Node& from = chains.nodes[n];
      graph.lines.push_back({.a = from.point,
                             .b = chains.nodes[from.after].point,
                             .left = chain.left,
                             .right = chain.right,
                             .marker = from.marker,
                             .segment = from.segment,
                             .error = error[n]});
      n = from.after;
      if (n == chain.start) break;
    }
  }
}

}  // namespace weft
