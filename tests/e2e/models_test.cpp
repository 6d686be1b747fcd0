// SPDX-License-Identifier: Apache-2.0
// The whole path on the models: weft mesh, through weftd, to a file; then weft check on that file.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/e2e/programs.h"

namespace weft::e2e {
namespace {

using Arguments = std::vector<std::string>;

Arguments operator+(Arguments a, const Arguments& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// Meshes and checks; returns the --json object.
nlohmann::json mesh_and_check(const Server& server, const std::string& input,
                              const std::string& output, const Arguments& bounds) {
  const Folder folder;
  const std::string path = folder / output;
  const Outcome mesh = run_weft(
      Arguments{"mesh", input, "-o", path, "--json", "--quiet", "--server", server.address()} +
      bounds);
  EXPECT_EQ(mesh.exit_code, 0) << mesh.err;
  if (mesh.exit_code != 0) return {};
  const Outcome check = run_weft(Arguments{"check", path, "--domain", input} + bounds);
  EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
  return nlohmann::json::parse(mesh.out);
}

const std::string kCylinderSize = "(x>=0 && abs(y)<5) || (x<0 && x^2+y^2<25) ? 1.2e-3 : 1e-2";

TEST(ModelsByCommand, ThroughTheServerHoldTheirBoundsAndCounts) {
  const Server server;
  const auto triangles = [&](const std::string& name, const std::string& output,
                             const Arguments& bounds) {
    return mesh_and_check(server, model(name), output, bounds).at("triangles").get<int>();
  };
  EXPECT_LE(triangles("pipe.poly", "pipe.vtu", {"--size", "0.4*sqrt((x-200)^2+(y-200)^2)+1"}),
            3'000);
  EXPECT_LE(triangles("key.poly", "key.msh", {"--size", "0.02*abs(y-46)+0.1"}), 5'700);
  EXPECT_LE(triangles("cylinder.poly", "cylinder.vtu", {"--size", kCylinderSize}), 635'000);
  EXPECT_LE(triangles("us-east-coast.poly", "coast.node", {"--min-angle", "20"}), 20'000);
  EXPECT_LE(triangles("us-east-coast.geojson", "coast.vtu", {"--min-angle", "30"}), 40'000);
  EXPECT_LE(triangles("us-east-coast.poly", "coast.vtu", {"--size", "1e-3"}), 333'000);
}

TEST(ModelsByCommand, HoldTheBoundsOfARaster) {
  const Server server;
  Folder folder;
  // From 0.02 in the west to 0.5 in the east of the cylinder's channel.
  const std::string grid = folder.write("size.asc",
                                        "ncols 3\nnrows 2\nxllcorner -20\nyllcorner -20\n"
                                        "cellsize 20\n0.02 0.1 0.5\n0.02 0.1 0.5\n");
  const auto json =
      mesh_and_check(server, model("cylinder.poly"), "cylinder.vtu", {"--size", grid});
  EXPECT_GT(json.at("triangles").get<int>(), 1000);
  const Outcome coarse = run_weft({"mesh", model("cylinder.poly"), "-o", folder / "coarse.vtu",
                                   "--quiet", "--server", server.address()});
  EXPECT_EQ(coarse.exit_code, 0) << coarse.err;
  EXPECT_EQ(
      run_weft({"check", folder / "coarse.vtu", "--domain", model("cylinder.poly"), "--size", grid})
          .exit_code,
      3);
}

TEST(ModelsByCommand, GiveTheSameDigestThroughAPrivateServerAndASharedOne) {
  const Server server;
  const auto digest = [](const Arguments& where) {
    const Folder folder;
    const Outcome mesh = run_weft(Arguments{"mesh", model("key.poly"), "-o", folder / "key.vtu",
                                            "--size", "0.1", "--json", "--quiet"} +
                                  where);
    EXPECT_EQ(mesh.exit_code, 0) << mesh.err;
    return nlohmann::json::parse(mesh.out)["digest"].get<std::string>();
  };
  EXPECT_EQ(digest({}), digest({"--server", server.address()}));
}

TEST(Drawing, OfAMeshIsWrittenBesideIt) {
  const Folder folder;
  const Outcome mesh =
      run_weft({"mesh", model("key.poly"), "-o", folder / "key.vtu", "--draw", folder / "key.png",
                "--draw", folder / "key.svg", "--draw", folder / "key.pdf", "--quiet"});
  EXPECT_EQ(mesh.exit_code, 0) << mesh.err;
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"key.pdf", "key.png", "key.svg", "key.vtu"}));
}

TEST(Drawing, OfTheQuadtreeIsOfItsLeavesAndTheJsonTellsTheStages) {
  const Folder folder;
  const auto mesh = [&](const std::string& drawing, const Arguments& more) {
    const Outcome outcome =
        run_weft(Arguments{"mesh", model("us-east-coast.poly"), "--size", "1e-3", "--draw",
                           folder / drawing, "--json", "--quiet", "--threads", "1"} +
                 more);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  };
  const auto plain = mesh("plain.svg", {});
  const auto drawn = mesh("drawn.svg", {"--draw-quadtree"});
  EXPECT_EQ(plain["digest"], drawn["digest"]);
  EXPECT_GT(std::filesystem::file_size(folder / "drawn.svg"),
            std::filesystem::file_size(folder / "plain.svg"));
  EXPECT_GT(drawn["leaves"], 20);
  EXPECT_GE(drawn["rounds"], 1);
  EXPECT_GE(drawn["deferred"], 0);
  EXPECT_EQ(drawn["threads"], 1);
  for (const char* stage : {"triangulate", "size", "prelude", "refine", "emit", "engine"})
    EXPECT_GE(drawn["seconds"][stage], 0) << stage;
  EXPECT_GT(drawn["seconds"]["refine"], 0);
}

TEST(Formats, EveryMeshThatIsReadHoldsTheSameBounds) {
  const Server server;
  const std::string domain = model("us-east-coast.geojson");
  const Folder folder;
  Arguments mesh{"mesh", domain, "--size", "0.01", "--quiet", "--server", server.address()};
  const std::vector<std::string> names = {"m.vtu",   "m.msh", "m.node", "m.npz",
                                          "fort.14", "m.su2", "m.obj",  "m.mesh"};
  for (const std::string& name : names) mesh = mesh + Arguments{"-o", folder / name};
  const Outcome meshed = run_weft(mesh);
  ASSERT_EQ(meshed.exit_code, 0) << meshed.err;
  for (const std::string& name : names) {
    const Outcome check = run_weft({"check", folder / name, "--domain", domain, "--size", "0.01"});
    EXPECT_EQ(check.exit_code, 0) << name << check.out << check.err;
  }
}

TEST(CheckCommand, SaysThatItJudgesNoWidths) {
  const Server server;
  const Folder folder;
  const Outcome meshed = run_weft({"mesh", model("key.poly"), "-o", folder / "key.vtu", "--quiet",
                                   "--cells-across", "2", "--server", server.address()});
  ASSERT_EQ(meshed.exit_code, 0) << meshed.err;
  Arguments check{"check", folder / "key.vtu", "--domain", model("key.poly")};
  EXPECT_EQ(run_weft(check).err, "");
  const Outcome checked = run_weft(check + Arguments{"--cells-across", "2"});
  EXPECT_EQ(checked.exit_code, 0) << checked.out;
  EXPECT_NE(checked.err.find("--cells-across is not judged"), std::string::npos) << checked.err;
}

TEST(Formats, AMeshIsMeshedAnewAndCoversTheSame) {
  const Server server;
  const Folder folder;
  const auto area = [&](const std::string& input, const std::string& output) {
    const Outcome mesh = run_weft(
        {"mesh", input, "-o", folder / output, "--json", "--quiet", "--server", server.address()});
    EXPECT_EQ(mesh.exit_code, 0) << mesh.err;
    return nlohmann::json::parse(mesh.out)["area"].get<double>();
  };
  const double coast = area(model("us-east-coast.geojson"), "fort.14");
  EXPECT_NEAR(area(folder / "fort.14", "again.msh"), coast, 1e-9 * coast);
  EXPECT_EQ(run_weft({"convert", model("us-east-coast.geojson"), folder / "coast.poly"}).exit_code,
            0);
  EXPECT_NEAR(area(folder / "coast.poly", "poly.vtu"), coast, 1e-9 * coast);
}

TEST(CheckCommand, FindsAMeshThatMissesItsBounds) {
  const Folder folder;
  const std::string path = folder / "key.vtu";
  ASSERT_EQ(run_weft({"mesh", model("key.poly"), "-o", path, "--quiet"}).exit_code, 0);
  const Outcome check = run_weft({"check", path, "--domain", model("key.poly"), "--size", "0.01"});
  EXPECT_EQ(check.exit_code, 3);
  EXPECT_NE((check.out + check.err).find("area"), std::string::npos) << check.out << check.err;
}

}  // namespace
}  // namespace weft::e2e
