// SPDX-License-Identifier: Apache-2.0
// The domains of tests/domain_files, which Python reads, too: see its README.md.
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "client/call/mesh_request.h"
#include "files/formats/domain_formats.h"
#include "tests/files/support/temp_folder.h"
#include "tests/support/paths.h"

namespace weft::client {
namespace {

TEST(SameDomains, AreReadFromFilesAsPythonReadsThem) {
  const auto folder = std::filesystem::path(weft::testing::kModels).parent_path() / "domain_files";
  const auto expect = nlohmann::json::parse(contents_of(folder / "expect.json"));
  for (const auto& [name, wanted] : expect.items()) {
    SCOPED_TRACE(name);
    const auto domain = read_domain(folder / name);
    EXPECT_EQ(domain.has_value(), !wanted.is_null());
    if (!domain || wanted.is_null()) continue;
    v1::Domain message;
    ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(wanted.dump(), &message).ok());
    const v1::Domain sent = make_request(*domain, {}).domain();
    EXPECT_EQ(sent.SerializeAsString(), message.SerializeAsString()) << sent.DebugString();
  }
  EXPECT_GE(expect.size(), 12u);
}

TEST(SameDomains, AreInDegreesIfPythonAndTheConsoleTakeThemSo) {
  const auto folder = std::filesystem::path(weft::testing::kModels).parent_path() / "domain_files";
  const auto cases = nlohmann::json::parse(contents_of(folder / "degrees.json"));
  const TempFolder files;
  for (const auto& [number, given] : cases.items()) {
    SCOPED_TRACE(given.dump());
    auto ring = given["ring"];
    ring.push_back(ring[0]);
    nlohmann::json text = {{"type", "Polygon"}, {"coordinates", {ring}}};
    if (given.contains("crs"))
      text["crs"] = {{"type", "name"}, {"properties", {{"name", given["crs"]}}}};
    const auto domain = read_domain(files.write("map.geojson", text.dump()));
    ASSERT_TRUE(domain) << domain.error().message;
    EXPECT_EQ(domain->system && domain->system->geographic, given["degrees"].get<bool>());
    EXPECT_EQ(domain->warnings.size(), given.value("is_told", false) ? 1u : 0u);
  }
  EXPECT_GE(cases.size(), 19u);
}

}  // namespace
}  // namespace weft::client
