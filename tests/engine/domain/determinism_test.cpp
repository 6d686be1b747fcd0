// SPDX-License-Identifier: Apache-2.0
// The same domain gives the same bytes, whatever the heap holds and on whatever thread it is made.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include "engine/domain/domain.h"
#include "tests/engine/domain/shapes.h"
#include "tests/support/poly.h"

namespace weft {
namespace {

template <class T>
void append(std::string& bytes, const std::vector<T>& values) {
  for (const T& value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string bytes(const Pslg& pslg) {
  const ExecutionContext context;
  const Result<Domain> domain = triangulate(pslg, context);
  EXPECT_TRUE(domain);
  std::string all;
  append(all, domain->vertices);
  append(all, domain->input_point);
  append(all, domain->triangles);
  append(all, domain->subsegments);
  for (const Region& region : domain->regions)
    all += std::to_string(region.id) + " " + std::to_string(region.max_area) + "\n";
  return all;
}

// Fills the heap with holes, so that what comes next lies elsewhere.
std::vector<std::unique_ptr<char[]>> litter(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::unique_ptr<char[]>> blocks;
  for (int i = 0; i < 2000; ++i) blocks.push_back(std::make_unique<char[]>(1 + random() % 20000));
  for (std::size_t i = 0; i < blocks.size(); i += 1 + random() % 3) blocks[i].reset();
  return blocks;
}

void expect_same_bytes(const Pslg& pslg) {
  const std::string first = bytes(pslg);
  const auto kept = litter(1);
  EXPECT_EQ(bytes(pslg), first);
  std::string other_thread;  // whose allocations come from another arena
  std::thread([&] {
    const auto more = litter(2);
    other_thread = bytes(pslg);
  }).join();
  EXPECT_EQ(other_thread, first);
}

TEST(Determinism, HoldsForARegularGridWhereEveryCellIsATie) {
  Pslg pslg = square(40);
  for (int x = 1; x < 40; ++x)
    for (int y = 1; y < 40; ++y) pslg.points.push_back({x * 1.0, y * 1.0});
  add_segment(pslg, {0.5, 0.5}, {38.5, 33.5});
  add_segment(pslg, {0.5, 33.5}, {38.5, 7.5});
  expect_same_bytes(pslg);
}

TEST(Determinism, HoldsForManyCrossings) {
  std::mt19937 random(3);
  Pslg pslg = square(4294967296.0);
  for (int i = 0; i < 150; ++i) {
    const double x = random(), y = random(), z = random();
    add_segment(pslg, {x, y}, {z, random() * 1.0});
  }
  expect_same_bytes(pslg);
}

TEST(Determinism, HoldsForTheCoast) {
  expect_same_bytes(read_poly(model("us-east-coast.poly")));
}

}  // namespace
}  // namespace weft
