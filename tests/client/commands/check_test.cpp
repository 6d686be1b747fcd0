// SPDX-License-Identifier: Apache-2.0
// `weft check` as a user runs it.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/client/support/weft_process.h"
#include "tests/files/support/temp_folder.h"

namespace weft::client {
namespace {

using WeftCheck = WeftProcess;

TEST_F(WeftCheck, FindsRegionsAndAnglesThatAreWrong) {
  ASSERT_EQ(run(mesh_to("m.vtu")), 0);
  const Words check = {"check", folder_ / "out" / "m.vtu", "--domain", folder_ / "in.poly"};
  // The right half claims a region that the domain does not have.
  EXPECT_EQ(run(check), 3);
  EXPECT_NE(out().find("regions"), std::string::npos) << out();
  Words strict = check;
  strict.insert(strict.end(), {"--min-angle", "50"});
  EXPECT_EQ(run(strict), 3);
  EXPECT_NE(out().find("angle"), std::string::npos) << out();
}

TEST_F(WeftCheck, JudgesForAModelWithoutADomain) {
  ASSERT_EQ(run(mesh_to("m.vtu")), 0);
  const Words check = {"check", folder_ / "out" / "m.vtu", "--for", "adcirc"};
  EXPECT_EQ(run(check, {"WEFT_MIN_ANGLE=30"}), 0) << err();
  EXPECT_TRUE(out().ends_with("the mesh holds for ADCIRC\n")) << out();
  for (const char* flag : {"--size=1", "--min-angle=20", "--snap=0"}) {
    Words words = check;
    words.push_back(flag);
    EXPECT_EQ(run(words), 2) << flag;
    EXPECT_NE(err().find("requires --domain"), std::string::npos) << err();
  }
  EXPECT_EQ(run({"check", folder_ / "out" / "m.vtu", "--for", "mike"}), 2);
  EXPECT_NE(err().find("is not adcirc, schism, telemac or delft3d"), std::string::npos) << err();
  EXPECT_EQ(run({"check", folder_ / "out" / "m.vtu"}), 2);
  EXPECT_NE(err().find("--domain is required"), std::string::npos) << err();
}

TEST_F(WeftCheck, FailsAMeshThatItsModelRefuses) {
  std::ofstream(folder_ / "pinched.off")
      << "OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n2 1 0\n2 2 0\n3 0 1 2\n3 2 3 4\n";
  const Words check = {"check", folder_ / "pinched.off", "--for", "adcirc"};
  EXPECT_EQ(run(check), 3);
  EXPECT_NE(out().find("the boundary passes each vertex once: fails, 1 time\n  at (1, 1)\n"),
            std::string::npos)
      << out();
  EXPECT_EQ(run({"check", folder_ / "pinched.off", "--for", "delft3d"}), 0) << out();
}

TEST_F(WeftCheck, JudgesBoundariesThatAreOpenByTheirDepth) {
  // Two squares, the right one deep but for its upper left corner.
  std::ofstream file(folder_ / "hgrid.gr3");
  file << "strip\n4 6\n1 0 0 5\n2 1 0 60\n3 2 0 60\n4 0 1 5\n5 1 1 5\n6 2 1 60\n"
       << "1 3 1 2 5\n2 3 1 5 4\n3 3 2 3 6\n4 3 2 6 5\n";
  file.close();
  Words check = {"check", folder_ / "hgrid.gr3", "--for", "schism", "--open-boundary", "deeper:50"};
  EXPECT_EQ(run(check), 0) << out();
  EXPECT_EQ(err().find("opens nothing"), std::string::npos) << err();
  EXPECT_NE(out().find("open boundaries have two edges at least: holds\n"), std::string::npos);
  check.back() = "deeper:4";
  EXPECT_EQ(run(check), 3) << out();
  EXPECT_NE(out().find("no open boundary is a whole ring: fails, 1 time\n"), std::string::npos)
      << out();
  check.back() = "deeper:60";
  EXPECT_EQ(run(check), 0) << out();
  EXPECT_NE(err().find("deeper:60 opens nothing"), std::string::npos) << err();
  ASSERT_EQ(run(mesh_to("m.vtu")), 0);
  check[1] = out_file("m.vtu");
  EXPECT_EQ(run(check), 2);
  EXPECT_NE(err().find("m.vtu has none"), std::string::npos) << err();
}

// Off Cape Hatteras, a hundredth of a degree wide: 910 m.
TEST_F(WeftCheck, MeasuresDegreesInMetresIfItIsTold) {
  std::ofstream(folder_ / "fort.14")
      << "grid\n1 3\n1 -75 35 40\n2 -74.99 35 40\n3 -75 35.01 40\n1 3 1 2 3\n0\n0\n0\n0\n";
  Words check = {"check", folder_ / "fort.14", "--for", "schism"};
  EXPECT_EQ(run(check), 0) << err();
  EXPECT_NE(err().find("if they are degrees, add --lonlat"), std::string::npos) << err();
  check.push_back("--lonlat");
  EXPECT_EQ(run(check), 0) << err();
  EXPECT_EQ(err().find("degrees"), std::string::npos) << err();
  EXPECT_NE(out().find("the shortest edge has 910.9 m\ntime step at most 45.98 s"),
            std::string::npos)
      << out();
}

TEST_F(WeftCheck, TakesPeriodicSidesByTheNamesOfTheDomain) {
  ASSERT_EQ(run(mesh_to("m.vtu")), 0);
  Words check = {"check",      out_file("m.vtu"), "--domain", folder_ / "in.poly",
                 "--periodic", "1:inlet"};
  EXPECT_EQ(run(check), 2);
  EXPECT_NE(err().find("no marker of the domain is named 'inlet'"), std::string::npos) << err();
  check.back() = "1:";
  EXPECT_EQ(run(check), 2);
  EXPECT_NE(err().find("--periodic: '1:' is not pairs of markers"), std::string::npos) << err();
}

TEST_F(WeftCheck, JudgesLayersByTheNamesOfTheDomain) {
  ASSERT_EQ(run(mesh_to("m.vtu")), 0);
  Words check = {"check",    out_file("m.vtu"),        "--domain", folder_ / "in.poly",
                 "--layers", "wall:first=0.125,rows=2"};
  EXPECT_EQ(run(check), 2);
  EXPECT_NE(err().find("no marker of the domain is named 'wall'"), std::string::npos) << err();
  check.back() = "1:first=0.125,rows=2";
  EXPECT_EQ(run(check), 3);
  EXPECT_NE(out().find("has an edge with marker 1, but is not of the region"), std::string::npos)
      << out();
}

TEST_F(WeftCheck, TakesNoSizeThatNothingExceeds) {
  ASSERT_EQ(run(mesh_to("m.vtu")), 0);
  for (const char* size : {"nan", "-nan", "inf", "-1", "0", "1e999"}) {
    EXPECT_EQ(run({"check", folder_ / "out" / "m.vtu", "--domain", folder_ / "in.poly",
                   std::string("--size=") + size}),
              2)
        << size;
    EXPECT_NE(err().find("must be positive and finite"), std::string::npos) << err();
  }
}

TEST_F(WeftCheck, SpeaksInSentencesAndInJson) {
  ASSERT_EQ(run(mesh_to("m.vtu")), 0);
  const Words check = {"check", out_file("m.vtu"), "--domain", folder_ / "in.poly", "--size",
                       "0.4"};
  EXPECT_EQ(run(check), 3);
  EXPECT_NE(out().find("area at most 1.25 of its bound: fails, 32 times; the worst is triangle 0"),
            std::string::npos)
      << out();
  Words json = check;
  json.push_back("--json");
  EXPECT_EQ(run(json), 3);
  EXPECT_EQ(nlohmann::json::parse(out())["rules"]["area"]["violations"], 32);
}

}  // namespace
}  // namespace weft::client
