// SPDX-License-Identifier: Apache-2.0
// Any single change to a valid mesh is found.
#include <gtest/gtest.h>

#include <random>

#include "tests/checker/lattice.h"

namespace weft::check::testing {
namespace {

// Applies one random change. Returns false if that changes nothing.
class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  std::string mutate(Problem& problem) {
    Mesh& mesh = problem.mesh;
    const std::size_t t = below(mesh.triangles.size());
    const std::size_t e = below(mesh.edges.size());
    const std::size_t v = below(mesh.vertices.size());
    switch (below(12)) {
      case 0:
        remove_triangle(mesh, t);
        return "a triangle removed";
      case 1:
        mesh.triangles.push_back(mesh.triangles[t]);
        if (!mesh.regions.empty()) mesh.regions.push_back(mesh.regions[t]);
        return "a triangle doubled";
      case 2:
        std::swap(mesh.triangles[t][0], mesh.triangles[t][2]);
        return "a triangle turned over";
      case 3: {
        std::uint32_t& corner = mesh.triangles[t][below(3)];
        const std::uint32_t before = corner;
        while (corner == before) corner = static_cast<std::uint32_t>(below(mesh.vertices.size()));
        return "a corner replaced";
      }
      case 4:
        mesh.edges.erase(mesh.edges.begin() + static_cast<std::ptrdiff_t>(e));
        return "a listed edge dropped";
      case 5:
        mesh.edges[e].marker += 1;
        return "a marker changed";
      case 6:
        mesh.vertices[v].x += below(2) == 0 ? 0.3 : -0.3;
        return "a vertex moved";
      case 7:
        mesh.vertices[v].y += 0x1p-24;
        return "a vertex nudged";
      case 8: {
        const std::size_t i = below(3);
        const std::uint32_t a = mesh.triangles[t][i], b = mesh.triangles[t][(i + 1) % 3];
        mesh.edges.push_back({a, b, 0});
        return "an edge listed that is on no segment, or twice";
      }
      case 9:
        mesh.regions.resize(mesh.triangles.size(), 0);
        mesh.regions[t] += 5;
        return "a region id changed";
      case 10: {
        const auto fresh = static_cast<std::uint32_t>(mesh.vertices.size());
        const auto [a, b, c] = mesh.triangles[t];
        const Vec2 p = mesh.vertices[a], q = mesh.vertices[b], r = mesh.vertices[c];
        mesh.vertices.push_back({(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3});
        mesh.triangles[t] = {a, b, fresh};
        mesh.triangles.push_back({b, c, fresh});
        mesh.triangles.push_back({c, a, fresh});
        if (!mesh.regions.empty()) mesh.regions.resize(mesh.triangles.size(), mesh.regions[t]);
        return "a triangle split in three";
      }
      default: {
        Domain& domain = problem.domain;
        domain.points.push_back({mesh.vertices[v].x + 0.03, mesh.vertices[v].y + 0.01});
        domain.segments.push_back({0, static_cast<std::uint32_t>(domain.points.size() - 1)});
        domain.markers.push_back(0);
        return "a segment added to the domain";
      }
    }
  }

 private:
  std::size_t below(std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_);
  }
  std::mt19937_64 random_;
};

class Mutation : public ::testing::TestWithParam<int> {};

TEST_P(Mutation, IsFoundWhateverItIs) {
  const std::vector<Problem> valid = {block(5), block_with_hole(), block_with_regions()};
  for (int k = 0; k < 300; ++k) {
    const auto seed = static_cast<std::uint64_t>(1000 * GetParam() + k);
    Problem problem = valid[static_cast<std::size_t>(k) % valid.size()];
    ASSERT_TRUE(problem.check().ok());
    const std::string change = Mutator(seed).mutate(problem);
    EXPECT_FALSE(problem.check().ok()) << change << ", seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Mutation, ::testing::Range(0, 8));

}  // namespace
}  // namespace weft::check::testing
