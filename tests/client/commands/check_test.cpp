// SPDX-License-Identifier: Apache-2.0
// `weft check` as a user runs it.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/client/support/temp_folder.h"
#include "tests/client/support/weft_process.h"

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
