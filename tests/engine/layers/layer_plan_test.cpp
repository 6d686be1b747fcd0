// SPDX-License-Identifier: Apache-2.0
#include "engine/layers/layer_plan.h"

#include <gtest/gtest.h>

#include "tests/engine/refine/sound.h"

namespace weft {
namespace {

TEST(LayerHeights, AreASeriesThatEndsAtTheThickness) {
  const Layers layers{.first = 1, .ratio = 2, .rows = 3};
  EXPECT_EQ(thickness_of(layers), 7);
  EXPECT_EQ(heights_of(layers), (std::vector<double>{1.0 / 7, 3.0 / 7, 1}));
}

TEST(LayerPlan, RefusesWhatCannotHaveLayersByName) {
  const auto refusal = [](MeshRequest request) {
    CollectedMesh mesh;
    const auto summary = mesh_on(nullptr, request, mesh);
    return summary ? "" : summary.error().field + " | " + summary.error().message;
  };
  Pslg pslg = square();
  for (std::uint32_t i = 0; i < 4; ++i) pslg.segments[i].marker = static_cast<std::int32_t>(i + 1);
  MeshRequest request{.pslg = pslg, .layers = {{9, 0.01, 1.2, 3}}};
  EXPECT_EQ(refusal(request),
            "quality.layers[0] | quality.layers[0]: no segment of the domain has the marker 9");
  request.layers = {{1, 0, 1.2, 3}};
  EXPECT_EQ(
      refusal(request),
      "quality.layers[0].first | quality.layers[0].first is 0; it must be above 0, and finite");
  request.layers = {{1, 0.01, 0.5, 3}};
  EXPECT_EQ(refusal(request),
            "quality.layers[0].ratio | quality.layers[0].ratio is 0.5; it must be from 1 to 10");
  request.layers = {{1, 1e40, 10, 200}};
  EXPECT_EQ(refusal(request),
            "quality.layers[0] | quality.layers[0] is 1.1111111111111112e+239 thick; it "
            "must be at most 1e+50");
  request.layers = {{1, 1e30, 2, 20}};
  EXPECT_EQ(refusal(request), "");
  request.layers = {{1, 0.01, 10, 40}};
  EXPECT_EQ(refusal(request).substr(0, 59),
            "quality.layers[0] | quality.layers[0]: there is no room for");
  request.layers = {{1, 0.01, 1, 0}};
  EXPECT_EQ(refusal(request),
            "quality.layers[0].rows | quality.layers[0].rows is 0; it must be from 1 to 200");
  request.layers = {{1, 0.01, 1, 2}, {1, 0.01, 1, 2}};
  EXPECT_EQ(refusal(request),
            "quality.layers[1].marker | quality.layers[1].marker is 1, which other layers have");
  request.layers = {{1, 0.01, 1, 2}, {2, 0.02, 1, 2}};
  EXPECT_EQ(refusal(request),
            "quality.layers[0] | quality.layers[0]: walls with other layers meet at (1, 0)");
  request.layers = {{1, 0.01, 1, 2}};
  request.keep.emplace();
  EXPECT_EQ(refusal(request),
            "quality.layers[0] | quality.layers[0] splits segments with marker 1, which "
            "quality.keep keeps as they "
            "are");
  request.keep.reset();
  request.pslg.points.push_back({0.5, 0.5});
  request.pslg.segments.push_back({4, 1, 8});
  EXPECT_EQ(
      refusal(request),
      "quality.layers[0] | quality.layers[0]: segment 4 ends on the wall, inside of it, at (1, 0)");
  request.layers = {{8, 0.01, 1, 2}};
  EXPECT_EQ(refusal(request).substr(0, 111),
            "quality.layers[0] | quality.layers[0]: segment 4 lies inside of the domain, and "
            "layers are on its "
            "boundary, at ");
  request.pslg.segments.pop_back();
  request.layers = {{1, 1e-30, 1, 2}};
  EXPECT_EQ(refusal(request).substr(0, 59),
            "quality.layers[0] | quality.layers[0]: there is no room for");
}

TEST(LayerPlan, StaysWithinTheBytesOfARun) {
  Pslg pslg = square();
  for (Segment& segment : pslg.segments) segment.marker = 1;
  const MeshRequest request{.pslg = pslg, .size = 1.0, .layers = {{1, 0.01, 1.2, 3}}};
  ForgetfulSink sink;
  ExecutionContext context({.max_bytes = 4000});
  const auto summary = generate_mesh(request, sink, context);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().code, ErrorCode::kBudgetExceeded);
  EXPECT_EQ(summary.error().message.substr(0, 18), "the plan of layers") << summary.error().message;
}

}  // namespace
}  // namespace weft
