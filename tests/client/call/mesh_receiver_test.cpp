// SPDX-License-Identifier: Apache-2.0
#include "client/call/mesh_receiver.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/client/support/sample_stream.h"
#include "tests/files/support/sample_mesh.h"
#include "tests/files/support/temp_folder.h"

namespace weft::client {
namespace {

using Stream = std::vector<v1::GenerateMeshResponse>;

class Receiver : public ::testing::Test {
 protected:
  // What is said of the stream; empty when it is accepted to the end.
  std::string verdict(const Stream& stream) {
    const auto spool = MeshSpool::create(folder_.path()).value();
    MeshReceiver receiver(*spool, DomainCounts{4, 4});
    Result<void> sound;
    for (const auto& message : stream) {
      sound = receiver.receive(message);
      if (!sound) break;
    }
    if (sound) sound = receiver.finish();
    if (sound) return "";
    EXPECT_EQ(sound.error().exit, ExitCode::kDataLoss);
    return sound.error().message;
  }
  // The verdict of a stream of 3 chunks that was changed, its digests computed anew.
  std::string verdict_after(const std::function<void(Stream&)>& change) {
    Stream stream = stream_of(square_mesh(6), 3);
    change(stream);
    seal(stream);
    return verdict(stream);
  }
  static v1::Chunk& chunk(Stream& stream, std::size_t k) { return *stream[k + 2].mutable_chunk(); }
  TempFolder folder_;
};

TEST_F(Receiver, TakesTheBoxesOfAllLeavesOrOfNone) {
  const auto with_sides = [this](int sides) {
    return verdict_after([sides](Stream& stream) {
      stream.back().mutable_summary()->set_leaves(2);
      stream.back().mutable_summary()->clear_leaf_boxes();
      for (int i = 0; i < sides; ++i) stream.back().mutable_summary()->add_leaf_boxes(i);
    });
  };
  EXPECT_EQ(with_sides(0), "");
  EXPECT_EQ(with_sides(8), "");
  EXPECT_EQ(with_sides(7), "the stream is damaged: 7 sides of boxes came for 2 leaves");
}

TEST_F(Receiver, RefusesABoxThatIsNotFinite) {
  EXPECT_EQ(verdict_after([](Stream& stream) {
              stream.back().mutable_summary()->set_leaf_boxes(
                  3, std::numeric_limits<double>::quiet_NaN());
            }),
            "the stream is damaged: a leaf's box is not finite");
}

TEST_F(Receiver, RefusesASecondAcceptedUnlessItResumes) {
  EXPECT_NE(verdict_after([](Stream& stream) { stream.insert(stream.begin(), stream[0]); }), "");
  const auto spool = MeshSpool::create(folder_.path()).value();
  MeshReceiver receiver(*spool, DomainCounts{4, 4});
  const Stream stream = stream_of(square_mesh(6), 3);
  for (std::size_t i = 0; i < 3; ++i) ASSERT_TRUE(receiver.receive(stream[i]));
  receiver.resume();
  EXPECT_FALSE(receiver.receive(stream[3])) << "no `accepted` came first";
  ASSERT_TRUE(receiver.receive(stream[0]));
  for (std::size_t i = 3; i < stream.size(); ++i) ASSERT_TRUE(receiver.receive(stream[i]));
  EXPECT_TRUE(receiver.finish());
}

TEST_F(Receiver, KeepsTheMeshAsItWasSent) {
  const Mesh mesh = square_mesh(20);
  const auto spool = MeshSpool::create(folder_.path()).value();
  MeshReceiver receiver(*spool, DomainCounts{4, 4});
  for (const auto& message : stream_of(mesh, 7)) ASSERT_TRUE(receiver.receive(message));
  ASSERT_TRUE(receiver.finish());
  const auto view = spool->view();
  ASSERT_TRUE(view);
  const auto copy = [](auto span) { return std::vector(span.begin(), span.end()); };
  EXPECT_EQ(copy(view->coordinates), mesh.coordinates);
  EXPECT_EQ(copy(view->triangles), mesh.triangles);
  EXPECT_EQ(copy(view->regions), mesh.regions);
  EXPECT_EQ(copy(view->edges), mesh.edges);
  EXPECT_EQ(copy(view->edge_markers), mesh.edge_markers);
  EXPECT_EQ(copy(view->input_points), (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(receiver.chunks(), 7u);
  EXPECT_GT(receiver.bytes(), mesh.coordinates.size() * 8 + mesh.triangles.size() * 4);
  EXPECT_TRUE(folder_.names().empty());
}

TEST_F(Receiver, RefusesAChunkWhoseBytesWereChanged) {
  Stream stream = stream_of(square_mesh(6), 3);
  chunk(stream, 1).set_coordinates(3, 0.25);
  EXPECT_EQ(verdict(stream), "the stream is damaged: chunk 1 does not match its SHA-256");
  stream = stream_of(square_mesh(6), 3);
  chunk(stream, 2).set_edge_markers(0, 77);
  EXPECT_EQ(verdict(stream), "the stream is damaged: chunk 2 does not match its SHA-256");
  stream = stream_of(square_mesh(6), 3);
  chunk(stream, 0).clear_regions();
  EXPECT_EQ(verdict(stream), "the stream is damaged: chunk 0 does not match its SHA-256");
}

TEST_F(Receiver, RefusesASummaryOfAnotherMesh) {
  Stream stream = stream_of(square_mesh(6), 3);
  stream.back().mutable_summary()->mutable_sha256()->back() ^= 1;
  EXPECT_EQ(verdict(stream),
            "the stream is damaged: the mesh does not match the SHA-256 of the summary");
}

TEST_F(Receiver, RefusesCountsThatDiffer) {
  EXPECT_EQ(verdict_after([](Stream& s) { s.back().mutable_summary()->set_triangles(73); }),
            "the stream is damaged: 72 triangles came, the summary says 73");
}

TEST_F(Receiver, RefusesAMissingChunk) {
  EXPECT_EQ(verdict_after([](Stream& s) { s.erase(s.begin() + 3); }),
            "the stream is damaged: chunk 2 came where chunk 1 should");
}

TEST_F(Receiver, RefusesAGapInTheNumbers) {
  EXPECT_EQ(verdict_after([](Stream& s) { chunk(s, 1).set_first_vertex(99); }),
            "the stream is damaged: chunk 1 starts at vertex 99, it should start at 21");
  EXPECT_EQ(verdict_after([](Stream& s) { chunk(s, 1).set_first_triangle(99); }),
            "the stream is damaged: chunk 1 starts at triangle 99, it should start at 24");
}

TEST_F(Receiver, RefusesIndicesOutOfRange) {
  EXPECT_EQ(verdict_after([](Stream& s) { chunk(s, 0).set_triangles(4, 21); }),
            "the stream is damaged: chunk 0 names vertex 21 of 21");
  EXPECT_EQ(verdict_after([](Stream& s) { chunk(s, 2).set_edges(4, 4294967295u); }),
            "the stream is damaged: chunk 2 names vertex 4294967295 of 49");
  EXPECT_EQ(verdict_after([](Stream& s) { chunk(s, 2).set_edge_segments(0, 4); }),
            "the stream is damaged: chunk 2 names segment 4 of 4");
  EXPECT_EQ(verdict_after([](Stream& s) { chunk(s, 2).set_input_points(1, 4); }),
            "the stream is damaged: chunk 2 names input point 4 of 4");
}

TEST_F(Receiver, RefusesCoordinatesThatAreNotFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()})
    EXPECT_EQ(verdict_after([bad](Stream& s) { chunk(s, 0).set_coordinates(5, bad); }),
              "the stream is damaged: chunk 0 has a coordinate that is not finite");
}

TEST_F(Receiver, RefusesArraysOfOddLengths) {
  const std::string expected = "the stream is damaged: chunk 2 has arrays whose lengths do not fit";
  EXPECT_EQ(verdict_after([](Stream& s) { chunk(s, 2).add_coordinates(1); }), expected);
  EXPECT_EQ(verdict_after([](Stream& s) { chunk(s, 2).add_triangles(1); }), expected);
  EXPECT_EQ(verdict_after([](Stream& s) { chunk(s, 2).add_regions(1); }), expected);
  EXPECT_EQ(verdict_after([](Stream& s) { chunk(s, 2).add_edges(1); }), expected);
  EXPECT_EQ(verdict_after([](Stream& s) { chunk(s, 2).add_edge_markers(1); }), expected);
  EXPECT_EQ(verdict_after([](Stream& s) { chunk(s, 2).add_edge_segments(1); }), expected);
  EXPECT_EQ(verdict_after([](Stream& s) { chunk(s, 2).add_edge_bulges(1); }), expected);
  EXPECT_EQ(verdict_after([](Stream& s) { chunk(s, 2).add_input_points(1); }), expected);
  EXPECT_EQ(verdict_after([](Stream& s) { chunk(s, 2).add_box(1); }), expected);
}

TEST_F(Receiver, KeepsTheBulgesOfEdgesFromTheFirstChunkThatHasSome) {
  Stream stream = stream_of(square_mesh(6), 3);
  const int edges = chunk(stream, 2).edge_segments_size();
  for (int e = 0; e < edges; ++e) chunk(stream, 2).add_edge_bulges(e == 1 ? -0.25 : 0);
  seal(stream);
  const auto spool = MeshSpool::create(folder_.path()).value();
  MeshReceiver receiver(*spool, DomainCounts{4, 4});
  for (const auto& message : stream) ASSERT_TRUE(receiver.receive(message));
  const std::span<const double> bulges = spool->view().value().edge_bulges;
  ASSERT_EQ(bulges.size(), static_cast<std::size_t>(edges));
  EXPECT_EQ(bulges[0], 0);
  EXPECT_EQ(bulges[1], -0.25);
}

TEST_F(Receiver, RefusesAnEdgeThatIsNoChord) {
  for (const double bulge : {1.5, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(verdict_after([bulge](Stream& s) {
                for (int e = 0; e < chunk(s, 2).edge_segments_size(); ++e)
                  chunk(s, 2).add_edge_bulges(bulge);
              }),
              "the stream is damaged: chunk 2 has an edge that is no chord of an arc");
}

TEST_F(Receiver, RefusesMessagesOutOfOrder) {
  EXPECT_EQ(verdict_after([](Stream& s) { s.erase(s.begin()); }),
            "the stream is damaged: its first message is not `accepted`");
  EXPECT_EQ(verdict_after([](Stream& s) { s.insert(s.begin(), s.front()); }),
            "the stream is damaged: `accepted` came twice");
  EXPECT_EQ(verdict_after([](Stream& s) { s.push_back(s[1]); }),
            "the stream is damaged: a message follows the summary");
  EXPECT_EQ(verdict_after([](Stream& s) { s.pop_back(); }),
            "the stream is damaged: it ended without a summary");
  EXPECT_EQ(verdict_after([](Stream& s) { s.insert(s.begin() + 1, v1::GenerateMeshResponse()); }),
            "the stream is damaged: a message is empty or of an unknown kind");
}

}  // namespace
}  // namespace weft::client
