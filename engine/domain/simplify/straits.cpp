// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/simplify/straits.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>

namespace weft {
namespace {

// Sets that are united, with a node of each that stands for it.
class UnitedSets {
 public:
  explicit UnitedSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  std::uint32_t find(std::uint32_t node) {
    while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
    return node;
  }
  // Returns whether they were apart.
  bool unite(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

class StraitFinder {
 public:
  StraitFinder(const Waters& waters, StopPoller& poller)
      : waters_(waters), poller_(poller), count_(waters.region.size()) {}

  std::vector<bool> run() {
    span_forest();
    hang_up();
    std::vector<bool> in_strait(count_, false);
    for (std::uint32_t t = 0; t < count_; ++t)
      in_strait[t] = is_narrow(t) && (must_stay_[t] || weight_[t] >= kLarge);
    return in_strait;
  }

 private:
  struct Branch {
    std::uint32_t from, to;  // nodes
    friend bool operator<(const Branch& a, const Branch& b) {
      return a.from != b.from ? a.from < b.from : a.to < b.to;
    }
  };

  bool is_water(std::uint32_t t) const { return t != kNone && waters_.region[t] != kNone; }
  bool is_narrow(std::uint32_t t) const { return is_water(t) && std::isfinite(waters_.width[t]); }

  // Nodes are narrow triangles, and one triangle of each water.
  void span_forest() {
    UnitedSets sets(count_);
    std::vector<std::uint32_t> narrow;
    std::vector<bool> is_joined(count_, false);
    for (std::uint32_t t = 0; t < count_; ++t) {
      poller_.step();
      if (is_narrow(t)) narrow.push_back(t);
      if (!is_water(t) || is_narrow(t)) continue;
      is_joined[t] = true;
      for (const std::uint32_t n : waters_.arrangement.triangles[t].neighbor)
        if (is_water(n) && !is_narrow(n)) sets.unite(t, n);
    }
    node_.resize(count_);
    weight_.assign(count_, 0);
    must_stay_.assign(count_, false);
    for (std::uint32_t t = 0; t < count_; ++t) {
      node_[t] = sets.find(t);
      if (!is_water(t)) continue;
      weight_[node_[t]] += waters_.weight[t];
      if (waters_.must_stay[t]) must_stay_[node_[t]] = true;
    }
    std::stable_sort(narrow.begin(), narrow.end(), [&](std::uint32_t s, std::uint32_t t) {
      return waters_.width[s] > waters_.width[t];
    });
    for (const std::uint32_t t : narrow) {
      poller_.step();
      is_joined[t] = true;
      for (const std::uint32_t n : waters_.arrangement.triangles[t].neighbor) {
        if (!is_water(n) || !is_joined[n] || !sets.unite(t, n)) continue;
        branches_.push_back({t, node_[n]});
        branches_.push_back({node_[n], t});
      }
    }
    std::sort(branches_.begin(), branches_.end());
  }

  std::span<const Branch> branches_of(std::uint32_t node) const {
    const auto [from, to] =
        std::equal_range(branches_.begin(), branches_.end(), Branch{node, 0},
                         [](const Branch& a, const Branch& b) { return a.from < b.from; });
    return {from, to};
  }

  // The nodes of a tree from one on, each after that from which it hangs, with that.
  std::vector<Branch> hung_from(std::uint32_t root) {
    std::vector<Branch> order{{root, kNone}};
    for (std::size_t i = 0; i < order.size(); ++i) {
      poller_.step();
      const Branch at = order[i];
      for (const Branch& branch : branches_of(at.from))
        if (branch.to != at.to) order.push_back({branch.to, at.from});
    }
    return order;
  }

  // Gives each node what hangs from it, too.
  void hang_up() {
    std::vector<bool> seen(count_, false);
    for (const Branch& branch : branches_) {
      if (seen[branch.from]) continue;
      std::uint32_t heaviest = branch.from;
      for (const Branch& at : hung_from(branch.from)) {
        seen[at.from] = true;
        if (weight_[at.from] > weight_[heaviest]) heaviest = at.from;
      }
      const std::vector<Branch> order = hung_from(heaviest);
      for (std::size_t i = order.size(); i-- > 1;) {
        const auto [from, to] = order[i];
        weight_[to] += weight_[from];
        if (must_stay_[from]) must_stay_[to] = true;
      }
    }
  }

  const Waters& waters_;
  StopPoller& poller_;
  const std::size_t count_;
  std::vector<std::uint32_t> node_;  // per triangle
  std::vector<double> weight_;       // per node
  std::vector<bool> must_stay_;      // per node
  std::vector<Branch> branches_;     // both ways, sorted
};

}  // namespace

std::vector<bool> find_straits(const Waters& waters, StopPoller& poller) {
  return StraitFinder(waters, poller).run();
}

std::uint32_t number_sets(const Arrangement& arrangement, const std::vector<bool>& holds,
                          std::vector<std::uint32_t>& set, StopPoller& poller) {
  set.assign(holds.size(), kNone);
  std::uint32_t count = 0;
  std::vector<std::uint32_t> stack;
  for (std::uint32_t first = 0; first < holds.size(); ++first) {
    if (!holds[first] || set[first] != kNone) continue;
    set[first] = count;
    stack.push_back(first);
    while (!stack.empty()) {
      poller.step();
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (const std::uint32_t n : arrangement.triangles[t].neighbor) {
        if (n == kNone || !holds[n] || set[n] != kNone) continue;
        set[n] = count;
        stack.push_back(n);
      }
    }
    ++count;
  }
  return count;
}

}  // namespace weft
