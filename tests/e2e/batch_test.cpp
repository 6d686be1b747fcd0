// SPDX-License-Identifier: Apache-2.0
// A pipeline's meshes: deploy/ci/mesh.sh with the real weft, and a server that it starts or is told
// of.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/e2e/programs.h"
#include "tests/support/paths.h"

namespace weft::e2e {
namespace {

class Pipeline : public ::testing::Test {
 protected:
  Pipeline() { write_manifest("0.01"); }

  void write_manifest(const std::string& key_size) const {
    std::ofstream(folder_ / "meshes.yaml")
        << "defaults: {require: {min-angle: 20}}\nmeshes:\n"
        << "  - {name: pipe, input: " << model("pipe.poly")
        << ", size: '0.4*hypot(x-200, y-200) + 1', output: out/pipe.vtu, draw: out/pipe.png}\n"
        << "  - {name: key, input: " << model("key.poly") << ", size: " << key_size << "}\n";
  }
  // The script where weft is installed, with more flags; `environment` as for `env`.
  Outcome mesh(const std::string& flags = "", const std::string& environment = "") const {
    const std::string command =
        "cd " + folder_.path().string() +
        " && PATH=" + std::filesystem::path(testing::kWeft).parent_path().string() + ":$PATH " +
        environment + " " + testing::kDeploy + "/ci/mesh.sh meshes.yaml " + flags +
        " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    return {.exit_code = WEXITSTATUS(status),
            .out = files::contents_of(folder_ / "out.txt"),
            .err = files::contents_of(folder_ / "err.txt")};
  }
  std::string report(const char* name) const {
    return files::contents_of(folder_ / (std::string("weft-reports/") + name));
  }

  Folder folder_;
};

TEST_F(Pipeline, LeavesMeshesReportPageAndLockFile) {
  const Outcome outcome = mesh();
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err << outcome.out;
  EXPECT_EQ(run_weft({"check", folder_ / "out/pipe.vtu", "--domain", model("pipe.poly"), "--size",
                      "0.4*hypot(x-200, y-200) + 1"})
                .exit_code,
            0);
  EXPECT_TRUE(files::contents_of(folder_ / "out/pipe.png").starts_with("\x89PNG"));
  EXPECT_NE(report("weft-junit.xml").find("tests=\"2\" failures=\"0\" errors=\"0\""),
            std::string::npos);
  EXPECT_NE(report("weft-summary.md").find("![pipe](<../out/pipe.png>)"), std::string::npos);
  EXPECT_NE(files::contents_of(folder_ / "meshes.lock").find("\"pipe\""), std::string::npos);
}

TEST_F(Pipeline, SaysWhatIsMissingIfWeftIsNotInstalled) {
  const Outcome outcome = mesh("", "PATH=/usr/bin:/bin");
  EXPECT_EQ(outcome.exit_code, 127);
  EXPECT_NE(outcome.err.find("neither WEFT_WHEEL nor WEFT_IMAGE is set"), std::string::npos)
      << outcome.err;
}

TEST_F(Pipeline, HoldsLockedMeshesToTheirDigestsWhateverServerMakesThemAndVariablesSay) {
  ASSERT_EQ(mesh().exit_code, 0);
  const std::string lock = files::contents_of(folder_ / "meshes.lock");
  const Server server;
  const Outcome outcome =
      mesh("--locked", "WEFT_MIN_ANGLE=30 WEFT_SNAP=1 WEFT_SERVER=" + server.address());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err << outcome.out;
  EXPECT_EQ(files::contents_of(folder_ / "meshes.lock"), lock);
}

TEST_F(Pipeline, FailsUnderLockedAndNamesTheMeshThatChanged) {
  ASSERT_EQ(mesh().exit_code, 0);
  const std::string lock = files::contents_of(folder_ / "meshes.lock");
  write_manifest("0.02");
  const Outcome outcome = mesh("--locked");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.out.find("FAILED  key"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("the mesh has changed"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("passed  pipe"), std::string::npos) << outcome.out;
  EXPECT_NE(report("weft-junit.xml").find("failures=\"1\""), std::string::npos);
  EXPECT_EQ(files::contents_of(folder_ / "meshes.lock"), lock);
}

TEST_F(Pipeline, FailsAtAGateAndKeepsTheOldLock) {
  ASSERT_EQ(mesh().exit_code, 0);
  const std::string lock = files::contents_of(folder_ / "meshes.lock");
  write_manifest("0.02");
  const Outcome outcome = mesh("--require max-triangles=5000");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.out.find("more than 5000"), std::string::npos) << outcome.out;
  EXPECT_EQ(files::contents_of(folder_ / "meshes.lock"), lock);
}

TEST_F(Pipeline, EndsAsTheCallThatFailedAndReportsTheRest) {
  write_manifest("'0 - 1'");
  const Outcome outcome = mesh();
  EXPECT_EQ(outcome.exit_code, 67) << outcome.err;  // INVALID_ARGUMENT
  EXPECT_NE(outcome.err.find("key: "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("\n  size: the size"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("passed  pipe"), std::string::npos) << outcome.out;
  EXPECT_NE(report("weft-junit.xml").find("errors=\"1\""), std::string::npos);
}

TEST_F(Pipeline, WarnsOfSizesAsMeshDoes) {
  std::ofstream(folder_ / "meshes.yaml")
      << "meshes: [{name: key, input: " << model("key.poly") << ", edge: 2, field: [d=width]}]\n";
  const std::string warning = "WARNING: the size does not name the field 'd'\n";
  const Outcome outcome = mesh();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("\n        " + warning), std::string::npos) << outcome.out;
  const Outcome one = run_weft(
      {"mesh", model("key.poly"), "--edge", "2", "--field", "d=width", "-o", folder_ / "key.vtu"});
  EXPECT_NE(one.out.find("\n" + warning), std::string::npos) << one.out;
}

TEST_F(Pipeline, FailsUnderLockedWhereAMeshIsGoneFromTheManifest) {
  ASSERT_EQ(mesh().exit_code, 0);
  std::ofstream(folder_ / "meshes.yaml")
      << "meshes: [{name: key, input: " << model("key.poly") << ", size: 0.01}]\n";
  const Outcome outcome = mesh("--locked");
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.out.find("FAILED  pipe"), std::string::npos) << outcome.out;
}

TEST_F(Pipeline, ShowsThePageWhereGitHubLooks) {
  ASSERT_EQ(mesh("", "GITHUB_STEP_SUMMARY=page.md").exit_code, 0);
  EXPECT_EQ(files::contents_of(folder_ / "page.md"), report("weft-summary.md"));
}

}  // namespace
}  // namespace weft::e2e
