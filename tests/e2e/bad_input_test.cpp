// SPDX-License-Identifier: Apache-2.0
// Bad input: each gives its error, which names the offender; nothing is written, and the server
// goes on.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <thread>

#include "tests/e2e/programs.h"

namespace weft::e2e {
namespace {

constexpr int kInvalidArgument = 64 + 3;
constexpr int kResourceExhausted = 64 + 8;
constexpr int kUnavailable = 64 + 14;
constexpr int kUsage = 2;
constexpr int kUnreadable = 4;
constexpr int kUnwritable = 5;

const std::string kSquare =
    "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n"
    "4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

// The soft limit of this process and of those that it starts. Returns what it was.
rlimit limit_file_size(rlim_t bytes) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit limited{bytes, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &limited);
  return before;
}

std::string ring(const std::string& coordinates) {
  return R"({"type":"Polygon","coordinates":[[)" + coordinates + "]]}";
}

struct Case {
  std::string name;
  std::string file = "domain.poly";
  std::string contents = kSquare;
  std::vector<std::string> arguments = {};
  int exit_code = kInvalidArgument;
  std::vector<std::string> says = {};  // each must stand in the message
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

std::vector<Case> cases() {
  const std::string far_hole = replaced(kSquare, "\n0\n", "\n1\n1 5 5\n");
  return {
      {.name = "SegmentIndexOutOfRange",
       .contents = replaced(kSquare, "3 3 4", "3 3 17"),
       .exit_code = kUnreadable,
       .says = {"17"}},
      {.name = "NanCoordinate",
       .contents = replaced(kSquare, "3 1 1", "3 nan 1"),
       .exit_code = kUnreadable,
       .says = {"nan", ":4"}},
      {.name = "InfiniteCoordinate",
       .contents = replaced(kSquare, "3 1 1", "3 1e999 1"),
       .exit_code = kUnreadable,
       .says = {"1e999", ":4"}},
      {.name = "FewerThanThreeDistinctPoints",
       .contents = "3 2 0 0\n1 0 0\n2 1 0\n3 1 0\n1 0\n1 1 2\n0\n",
       .says = {"2 of them distinct"}},
      {.name = "AllPointsCollinear",
       .contents = "3 2 0 0\n1 0 0\n2 1 1\n3 2 2\n2 0\n1 1 2\n2 2 3\n0\n",
       .says = {"line"}},
      {.name = "HoleSeedOutsideTheDomain", .contents = far_hole, .says = {"domain.holes[0]", "5"}},
      {.name = "EverythingCarvedAway",
       .contents = replaced(kSquare, "\n0\n", "\n1\n1 0.5 0.5\n"),
       .says = {"domain"}},
      {.name = "SeedOnASegment",
       .contents = replaced(kSquare, "\n0\n", "\n1\n1 0.5 0\n"),
       .says = {"domain.holes[0]", "segment"}},
      {.name = "SegmentThatIsAPointLeavesTheDomainOpen",
       .contents = replaced(kSquare, "3 3 4", "3 3 3"),
       .says = {"domain.segments"}},
      {.name = "TruncatedFile",
       .contents = kSquare.substr(0, kSquare.size() / 2),
       .exit_code = kUnreadable,
       .says = {"domain.poly"}},
      {.name = "BinaryGarbage",
       .contents = std::string("\x7f\x45\x4c\x46\0\1\2\xff\xfe\0\0", 11),
       .exit_code = kUnreadable,
       .says = {"domain.poly"}},
      {.name = "BinaryGarbageGeoJson",
       .file = "domain.geojson",
       .contents = std::string("\x7f\x45\x4c\x46\0\1\2\xff\xfe\0\0", 11),
       .exit_code = kUnreadable,
       .says = {"domain.geojson"}},
      {.name = "UnknownInputExtension", .file = "domain.dwg", .exit_code = kUsage, .says = {"dwg"}},
      {.name = "UnclosedRing",
       .file = "domain.geojson",
       .contents = ring("[0,0],[1,0],[1,1],[0,1]"),
       .arguments = {"--strict"},
       .exit_code = kUnreadable,
       .says = {"--strict", "is a ring that is not closed"}},
      {.name = "ExpressionSyntax",
       .arguments = {"--size", "0.1*(x+"},
       .says = {"--size: line 1, column 8", "^"}},
      {.name = "ExpressionDividesByZero",
       .arguments = {"--edge", "1/(x-x)"},
       .says = {"--edge: the length of edges at ("}},
      {.name = "FieldToAMarkerOfNoSegment",
       .arguments = {"--edge", "0.1+d", "--field", "w=width", "--field", "d=distance:marker=9"},
       .says = {"--field d: size.fields[1].distance.markers holds 9"}},
      {.name = "EdgeLengthAtAMarkerOfNoSegment",
       .arguments = {"--edge", "1", "--edge-at", "marker=9:0.1"},
       .says = {"--edge-at marker=9: size.at[0].marker is 9"}},
      {.name = "ExpressionOf100Kilobytes",
       .arguments = {"--size", "1" + std::string(100'000, '0')},
       .exit_code = kResourceExhausted,
       .says = {"--size: ", "65536"}},
      {.name = "ExpressionNested10000Deep",
       .arguments = {"--size", std::string(10'000, '(') + "1" + std::string(10'000, ')')},
       .says = {"--size: ", "256"}},
      {.name = "MinimumAngleOf61",
       .arguments = {"--min-angle", "61"},
       .says = {"--min-angle: ", "61", "36"}},
      {.name = "SizeZero", .arguments = {"--size", "0"}, .says = {"positive"}},
      {.name = "SizeNegative", .arguments = {"--size", "-1"}, .says = {"positive"}},
      {.name = "SizeThatNeedsMoreTrianglesThanADoubleCounts",
       .arguments = {"--size", "1e-320"},
       .exit_code = kResourceExhausted,
       .says = {"--size: the size asks for at least 1e+300 triangles"}},
      {.name = "SizeThatNeeds10ToThe12Triangles",
       .arguments = {"--size", "1e-12"},
       .exit_code = kResourceExhausted,
       .says = {"4294967295"}},
      {.name = "SizeExpressionThatNeeds10ToThe12Triangles",
       .arguments = {"--size", "1e-12*(1+x)"},
       .exit_code = kResourceExhausted,
       .says = {"4294967295"}},
  };
}

class BadInput : public ::testing::TestWithParam<Case> {
 protected:
  static void SetUpTestSuite() { server_ = new Server; }
  static void TearDownTestSuite() {
    delete server_;
    server_ = nullptr;
  }
  static Server* server_;
};

Server* BadInput::server_ = nullptr;

TEST_P(BadInput, GivesItsErrorAndWritesNothing) {
  const Case& c = GetParam();
  const Folder folder;
  const std::string input = folder.write(c.file, c.contents);
  std::vector<std::string> arguments{
      "mesh", input, "-o", folder / "mesh.vtu", "--server", server_->address()};
  arguments.insert(arguments.end(), c.arguments.begin(), c.arguments.end());
  const auto start = std::chrono::steady_clock::now();
  const Outcome outcome = run_weft(arguments);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  EXPECT_EQ(outcome.exit_code, c.exit_code) << outcome.err;
  for (const auto& text : c.says)
    EXPECT_NE(outcome.err.find(text), std::string::npos) << text << "\n" << outcome.err;
  EXPECT_EQ(folder.names(), std::vector<std::string>{c.file});

  const std::string good = folder.write("good.poly", kSquare);
  const Outcome after = run_weft(
      {"mesh", good, "-o", folder / "good.vtu", "--quiet", "--server", server_->address()});
  EXPECT_EQ(after.exit_code, 0) << after.err;
}

INSTANTIATE_TEST_SUITE_P(Of, BadInput, ::testing::ValuesIn(cases()),
                         [](const auto& info) { return info.param.name; });

TEST(Server, ThatIsAbsentIsNamed) {
  const Folder folder;
  const Outcome outcome =
      run_weft({"mesh", folder.write("square.poly", kSquare), "-o", folder / "mesh.vtu", "--server",
                "unix:/nonexistent/sock", "--retries", "1"});
  EXPECT_EQ(outcome.exit_code, kUnavailable) << outcome.err;
  EXPECT_NE(outcome.err.find("/nonexistent/sock"), std::string::npos) << outcome.err;
  EXPECT_EQ(folder.names(), std::vector<std::string>{"square.poly"});
}

TEST(Server, ThatIsKilledAtWorkLeavesNoFile) {
  const Folder folder;
  Server server;
  const std::uint64_t before = server.resident_bytes();
  Outcome outcome;
  std::atomic<bool> ended{false};
  std::thread client([&] {
    outcome = run_weft({"mesh", folder.write("square.poly", kSquare), "-o", folder / "mesh.vtu",
                        "--size", "2e-7", "--server", server.address(), "--retries", "1"});
    ended = true;
  });
  // Refinement has begun once the mesh takes memory.
  while (!ended && server.resident_bytes() < before + (std::uint64_t{16} << 20))
    std::this_thread::yield();
  server.kill();
  client.join();
  EXPECT_EQ(outcome.exit_code, kUnavailable) << outcome.err;
  EXPECT_EQ(folder.names(), std::vector<std::string>{"square.poly"});
}

TEST(Output, InAMissingFolderIsRefusedBeforeWork) {
  const Folder folder;
  const Outcome outcome = run_weft({"mesh", folder.write("square.poly", kSquare), "-o",
                                    folder / "missing/mesh.vtu", "--size", "1e-7"});
  EXPECT_EQ(outcome.exit_code, kUnwritable) << outcome.err;
  EXPECT_NE(outcome.err.find("missing"), std::string::npos) << outcome.err;
}

TEST(Output, OfAnUnknownExtensionIsRefusedBeforeWork) {
  const Folder folder;
  const Outcome outcome = run_weft(
      {"mesh", folder.write("square.poly", kSquare), "-o", folder / "mesh.xyz", "--size", "1e-7"});
  EXPECT_EQ(outcome.exit_code, kUsage) << outcome.err;
  EXPECT_NE(outcome.err.find("xyz"), std::string::npos) << outcome.err;
}

TEST(Output, ThatDoesNotFitSaysSoAndLeavesNothing) {
  const Folder folder;
  const std::string input = folder.write("square.poly", kSquare);
  // A file may grow to 64 KiB here, as on a disk that fills up.
  const rlimit before = limit_file_size(64 << 10);
  const Outcome outcome =
      run_weft({"mesh", input, "-o", folder / "mesh.vtu", "--size", "1e-4", "--quiet"});
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(outcome.exit_code, kUnwritable) << outcome.err;
  EXPECT_EQ(folder.names(), std::vector<std::string>{"square.poly"});
}

}  // namespace
}  // namespace weft::e2e
