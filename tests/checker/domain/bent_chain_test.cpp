// SPDX-License-Identifier: Apache-2.0
// The path of a segment from (0, 0) to (100, 0), beside which it may run by 4, if it is bent by 1.
#include "checker/domain/bent_chain.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace weft::check::testing {
namespace {

class Beside {
 public:
  Beside() { mesh_.vertices = {{0, 0}, {100, 0}}; }
  // A vertex of the mesh.
  std::uint32_t add(double x, double y) {
    mesh_.vertices.push_back({x, y});
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }
  void list(std::uint32_t a, std::uint32_t b) {
    if (mesh_.vertices[b].x < mesh_.vertices[a].x) std::swap(a, b);
    steps_.push_back({0, mesh_.vertices[a].x, mesh_.vertices[b].x, a, b,
                      static_cast<std::uint32_t>(steps_.size())});
  }
  std::vector<std::uint32_t> path() const {
    std::vector<std::uint32_t> vertices;
    const Track track(mesh_.vertices[0], mesh_.vertices[1]);
    for (const ChainStop& stop : bent_chain(mesh_, track, steps_, 4, {0u, mesh_.vertices[0]},
                                            {1u, mesh_.vertices[1]}, Jumps::kFree))
      vertices.push_back(*stop.vertex);
    return vertices;
  }

 private:
  Mesh mesh_;
  std::vector<Step> steps_;
};

TEST(BentChain, FollowsTheEdgesNearestToTheSegment) {
  Beside beside;
  const auto near = beside.add(50, 0.5), far = beside.add(50, -2);
  for (const auto v : {near, far}) {
    beside.list(0, v);
    beside.list(v, 1);
  }
  EXPECT_EQ(beside.path(), (std::vector<std::uint32_t>{0, near, 1}));
}

TEST(BentChain, MayTurnBackALittle) {
  Beside beside;
  const auto a = beside.add(50, 0.5), b = beside.add(48, 0.5);
  beside.list(0, a);
  beside.list(a, b);
  beside.list(b, 1);
  EXPECT_EQ(beside.path(), (std::vector<std::uint32_t>{0, a, b, 1}));
}

// The dashes of a line that no edge joins to the ends, all of them so near that a jump is cheap.
// Tries of all pairs of them take minutes.
TEST(BentChain, ManyStopsNearEachOtherTakeLittleTime) {
  Beside beside;
  constexpr int kDashes = 200'000;
  for (int i = 0; i < kDashes; ++i) {
    const double x = 40 + 16.0 * i / kDashes;
    beside.list(beside.add(x, 3), beside.add(x + 8.0 / kDashes, 3));
  }
  EXPECT_EQ(beside.path(), (std::vector<std::uint32_t>{0, 1}));
}

// A tooth that leans back from the middle of the chain. A round of the search for each of its edges
// takes minutes.
TEST(BentChain, ALongWayBackTakesLittleTime) {
  Beside beside;
  const auto foot = beside.add(60, 0);
  beside.list(0, foot);
  beside.list(foot, 1);
  constexpr int kEdges = 200'000;
  auto last = foot;
  for (int i = 1; i <= kEdges; ++i) {
    const auto next = beside.add(60 - 20.0 * i / kEdges, 3.0 * i / kEdges);
    beside.list(last, next);
    last = next;
  }
  EXPECT_EQ(beside.path(), (std::vector<std::uint32_t>{0, foot, 1}));
}

}  // namespace
}  // namespace weft::check::testing
