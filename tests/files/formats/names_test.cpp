// SPDX-License-Identifier: Apache-2.0
#include "files/formats/names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "files/formats/derived/mesh_domain.h"
#include "files/formats/domain_formats.h"
#include "files/formats/format_names.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/triangle/triangle_poly.h"
#include "tests/files/support/mesh_files.h"
#include "tests/files/support/sample_mesh.h"
#include "tests/files/support/shapefile_writer.h"

namespace weft::files {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Region 0 has no name; marker 9 is on no edge.
Mesh named_mesh() {
  Mesh mesh = square_mesh(4);
  mesh.names.markers = {{1, "inlet"}, {2, "outlet"}, {4, "w\u00e4nd_4"}, {9, "unused"}};
  mesh.names.regions = {{7, "fluid"}};
  return mesh;
}

// Every character that some format gives a meaning to, names that read as numbers, and names that
// become equal once they are spelled.
Mesh hostile_mesh() {
  Mesh mesh = square_mesh(4);
  mesh.names.markers = {{1, "a \"b\" <&> 'c', = % ( ) # \\ ;"},
                        {2, "marker 7"},
                        {3, "-12"},
                        {4, "region_3"},
                        {0, "\u6d41\u5165 \U0001f30a"}};
  mesh.names.regions = {{0, "a b"}, {7, "a_b"}, {8, std::string(255, 'x')}, {9, "default"}};
  return mesh;
}

Result<void> write_22(const Mesh& mesh, const std::filesystem::path& path) {
  std::vector<OutputFile> files;
  files.push_back(OutputFile::create(path, {}).value());
  write_mesh(*mesh_format(path), mesh.view(), files, {.msh_version = MshVersion::k22});
  return commit(files);
}

TEST(NameReader, LeavesOutWhatCannotBeANameAndSaysSo) {
  NameReader reader("m.msh");
  reader.add(NameKind::kMarker, 1, "inlet");
  reader.add(NameKind::kMarker, 1, "inlet");
  reader.add(NameKind::kRegion, 1, "inlet");
  reader.add(NameKind::kMarker, 1, "other");
  reader.add(NameKind::kMarker, 2, "inlet");
  reader.add(NameKind::kMarker, 3, "");
  reader.add(NameKind::kMarker, 4, "\xff");
  reader.add(NameKind::kMarker, 5, "a\tb");
  reader.add(NameKind::kMarker, 6, std::string(256, 'x'));
  reader.add(NameKind::kRegion, 7, "\xc2\x85");
  EXPECT_THAT(sentences(reader.warnings()),
              ElementsAre("m.msh: a name of marker 1 is left out: the first is 'inlet'",
                          "m.msh: a name of marker 2 is left out: it is 'inlet', as that of 1",
                          "m.msh: a name of marker 3 is left out: it is empty",
                          "m.msh: a name of marker 4 is left out: it is not UTF-8",
                          "m.msh: a name of marker 5 is left out: it has a control character",
                          "m.msh: 2 more names are left out"));
  const Names names = reader.take();
  EXPECT_EQ(names.markers, (NameTable{{1, "inlet"}}));
  EXPECT_EQ(names.regions, (NameTable{{1, "inlet"}}));
}

TEST(NameReader, KnowsUtf8) {
  for (const char* text : {"\u00e9", "\u20ac", "\U0001f30a", "\u00a0", "\ued7f\u82bf"})
    EXPECT_EQ(name_fault(text), "") << text;
  for (const char* text :
       {"\x80", "\xc0\xaf", "\xc3", "\xe0\x80\x80", "\xed\xa0\x80", "\xf5\x80\x80\x80",
        "\xf0\x80\x80\x80", "\xf4\x90\x80\x80", "a\xe2\x82", "\xe2\x28\xa1"})
    EXPECT_EQ(name_fault(text), "is not UTF-8") << text;
}

TEST(NameReader, TakesAsManyAsAServer) {
  NameReader reader("m.msh");
  for (int i = 0; i < 16'385; ++i) reader.add(NameKind::kMarker, i, std::to_string(i));
  EXPECT_THAT(sentences(reader.warnings()),
              ElementsAre("m.msh: a name of marker 16384 is left out: there are more than a "
                          "server takes"));
  EXPECT_EQ(reader.take().markers.size(), 16'384u);
  NameReader long_names("m.msh");
  for (int i = 0; i < 5000; ++i)
    long_names.add(NameKind::kRegion, i, std::to_string(100'000 + i) + std::string(246, 'x'));
  EXPECT_EQ(long_names.take().regions.size(), 4161u);  // of 252 bytes
}

TEST(FindMarker, TellsWhatIsMeantOrWhatThereIs) {
  const NameTable markers = {{2, "inlet"}, {5, "outlet"}};
  EXPECT_EQ(find_marker("outlet", markers).value(), 5);
  EXPECT_EQ(find_marker("inlett", markers).error().message,
            "no marker of the domain is named 'inlett': did you mean `inlet`?");
  EXPECT_EQ(find_marker("wall", markers).error().message,
            "no marker of the domain is named 'wall': there are inlet, outlet");
  EXPECT_EQ(find_marker("wall", {}).error().message,
            "no marker of the domain is named 'wall': it names none");
}

TEST(Labels, GiveNamesTheNumbersThatNobodyUses) {
  Labels labels;
  const auto wall = labels.of("wall");
  const auto two = labels.of(2);
  const auto inlet = labels.of("inlet");
  EXPECT_EQ(labels.of("wall"), wall);
  EXPECT_EQ(labels.of(2), two);
  const auto numbers = labels.numbers();
  EXPECT_EQ(numbers[wall], 1);
  EXPECT_EQ(numbers[two], 2);
  EXPECT_EQ(numbers[inlet], 3);
}

TEST(SpelledNames, AreDifferentFromEachOther) {
  EXPECT_EQ(spelled({{1, "a b"}, {2, "a_b"}, {3, "a,b"}, {4, "a_b_2"}}, su2_tag),
            (NameTable{{1, "a_b_3"}, {2, "a_b"}, {3, "a_b_4"}, {4, "a_b_2"}}));
}

TEST(SpelledNames, OfOpenFoamAreWordsThatStandForNothingElse) {
  for (const auto& [name, word] :
       std::map<std::string, std::string>{{"inlet", "inlet"},
                                          {"a.b-c_d", "a.b-c_d"},
                                          {"outer wall", "outer_wall"},
                                          {"w\u00e4nd", "w_nd"},
                                          {"$x;{}()\"'/#", "_x_________"},
                                          {"2nd", "_2nd"},
                                          {"-5", "_-5"},
                                          {"marker 7", "_marker_7"},
                                          {"region_-7", "_region_-7"},
                                          {"frontAndBack", "_frontAndBack"}})
    EXPECT_EQ(foam_word(name), word) << name;
}

TEST(SpelledNames, OfExodusAreThoseOfNoNumber) {
  EXPECT_EQ(exodus_name("marker 7"), "_marker 7");
  EXPECT_EQ(exodus_name("marker_7 \"\u00e4\""), "marker_7 \"\u00e4\"");
}

TEST(NamesInFiles, ComeBack) {
  const Mesh mesh = named_mesh();
  for (const char* name : {"m.vtu", "m.npz", "m.msh"}) {
    const auto back = round_trip(mesh, name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->names, mesh.names) << name;
    EXPECT_EQ(back->regions.size(), mesh.regions.size()) << name;
    EXPECT_THAT(back->warnings, IsEmpty()) << name;
  }
  const auto obj = round_trip(mesh, "m.obj");
  ASSERT_TRUE(obj) << obj.error().message;
  EXPECT_EQ(obj->names.markers.size(), 3u);
  for (std::size_t e = 0; e < mesh.edge_markers.size(); ++e) {
    const std::string* const was = name_of(mesh.names.markers, mesh.edge_markers[e]);
    const std::string* const is = name_of(obj->names.markers, obj->edge_markers[e]);
    ASSERT_EQ(was == nullptr, is == nullptr);
    if (was != nullptr) {
      EXPECT_EQ(*was, *is);
    }
  }
  const auto su2 = round_trip(mesh, "m.su2");
  ASSERT_TRUE(su2) << su2.error().message;
  std::set<std::string> found;
  for (const auto& [id, name] : su2->names.markers) found.insert(name);
  EXPECT_EQ(found, (std::set<std::string>{"inlet", "outlet", "w\u00e4nd_4"}));
}

TEST(NamesInFiles, OfUgridAndSmsComeBackWithTheMesh) {
  Mesh mesh = named_mesh();
  mesh.names.markers[4] = "wall";
  const auto ugrid = round_trip(mesh, "m.nc");
  ASSERT_TRUE(ugrid) << ugrid.error().message;
  EXPECT_EQ(ugrid->names, mesh.names);
  const auto sms = round_trip(mesh, "m.2dm");
  ASSERT_TRUE(sms) << sms.error().message;
  mesh.names.markers.erase(9);  // no node string has it
  EXPECT_EQ(sms->names, mesh.names);
  for (const auto& back : {ugrid, sms}) {
    EXPECT_EQ(back->coordinates, mesh.coordinates);
    EXPECT_EQ(back->triangles, mesh.triangles);
    EXPECT_EQ(back->regions, mesh.regions);
    std::multiset<std::int32_t> was(mesh.edge_markers.begin(), mesh.edge_markers.end());
    EXPECT_EQ(std::multiset<std::int32_t>(back->edge_markers.begin(), back->edge_markers.end()),
              was);
  }
}

TEST(NamesInFiles, OfSmsByOthersAreRead) {
  TempFolder folder;
  const auto mesh = read_mesh(folder.write(
      "m.2dm",
      "MESH2D\nMESHNAME \"a # b\"\nND 10 0 0 5\nND 20 1 0 5\nND 30 0 1 5\nE3T 1 10 20 30 2\n"
      "NS 10\nNS 20 -30\nNS 30 -10 7 \"open # sea\"\nBEGPARAMDEF\nGM \"Mesh\"\nENDPARAMDEF\n"
      "BEG2DMBC\nMAT 2 \"sand\"\nEND2DMBC\n"));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(mesh->edges, (std::vector<std::uint32_t>{0, 1, 1, 2, 2, 0}));
  EXPECT_EQ(mesh->edge_markers, (std::vector<std::int32_t>{1, 1, 7}));
  EXPECT_EQ(mesh->names.markers, (NameTable{{7, "open # sea"}}));
  EXPECT_EQ(mesh->names.regions, (NameTable{{2, "sand"}}));
  const auto refusal = [&folder](const std::string& text) {
    const auto read = read_mesh(folder.write("x.2dm", text));
    return read ? "it was read" : read.error().message.substr(folder.path().string().size() + 1);
  };
  EXPECT_EQ(refusal(""), "x.2dm: is empty");
  EXPECT_EQ(refusal("ND 1 0 0 0\n"), "x.2dm:1:1: the first line is not MESH2D");
  EXPECT_EQ(refusal("MESH2D\nE6T 1 1 2 3 4 5 6 1\n"),
            "x.2dm:2:1: the element is of the kind 'E6T', only E3T and E4Q are read");
  EXPECT_EQ(refusal("MESH2D\nND 1 0 0 0\nND 1 0 0 0\n"), "x.2dm:3:4: the node 1 comes twice");
  EXPECT_EQ(refusal("MESH2D\nE3T 1 1 2 3 1\n"), "x.2dm: has no node 1");
  EXPECT_EQ(refusal("MESH2D\nNS 1 -9223372036854775808\n"),
            "x.2dm:2:6: the node is -9223372036854775808, numbers begin at 1");
}

TEST(Ugrid, TellsWhatItDoesNotRead) {
  TempFolder folder;
  const auto refusal = [&folder](const std::string& text) {
    const auto read = read_mesh(folder.write("x.nc", text));
    return read ? "it was read" : read.error().message.substr(folder.path().string().size() + 1);
  };
  EXPECT_EQ(
      refusal("\x89HDF\r\n"),
      "x.nc: is NetCDF-4, which is HDF5; the classic format is read: nccopy -k cdf2 makes it");
  EXPECT_EQ(refusal("CDF\3"), "x.nc: is not a NetCDF file in the classic format");
  EXPECT_EQ(refusal("CDF\2"), "x.nc: is cut short");
  EXPECT_EQ(refusal(std::string("CDF\2") + std::string(28, '\0')),
            "x.nc: has no two-dimensional mesh of UGRID");
}

TEST(NamesInFiles, OfGmsh22ComeBack) {
  TempFolder folder;
  const Mesh mesh = named_mesh();
  ASSERT_TRUE(write_22(mesh, folder / "m.msh"));
  const auto back = read_mesh(folder / "m.msh");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->names, mesh.names);
  EXPECT_EQ(back->edge_markers, mesh.edge_markers);
}

TEST(NamesInFiles, OfGmshByOthersAreReadInText) {
  TempFolder folder;
  const std::string names =
      "$PhysicalNames\n4\n0 1 \"corner\"\n1 5 \"inlet\"\n2 6 \"my fluid\"\n1 6 \"marker 7\"\n"
      "$EndPhysicalNames\n";
  const auto v22 = read_mesh(
      folder.write("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names +
                                "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n3\n"
                                "1 1 2 5 1 1 2\n2 1 2 6 2 2 3\n3 2 2 6 1 1 2 3\n$EndElements\n"));
  const auto v41 = read_mesh(folder.write(
      "b.msh",
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + names +
          "$Entities\n0 2 1 0\n1 0 0 0 1 0 0 1 5 0\n2 0 0 0 1 1 0 1 6 0\n"
          "1 0 0 0 1 1 0 1 6 0\n$EndEntities\n"
          "$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n"
          "$Elements\n3 3 1 3\n1 1 1 1\n1 1 2\n1 2 1 1\n2 2 3\n2 1 2 1\n3 1 2 3\n$EndElements\n"));
  for (const auto& mesh : {v22, v41}) {
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_EQ(mesh->names.markers, (NameTable{{5, "inlet"}}));
    EXPECT_EQ(mesh->names.regions, (NameTable{{6, "my fluid"}}));
    EXPECT_EQ(mesh->edge_markers, (std::vector<std::int32_t>{5, 7}));
    EXPECT_EQ(mesh->regions, (std::vector<std::int32_t>{6}));
    const Domain domain = domain_of_mesh("a.msh", mesh->view());
    EXPECT_EQ(domain.names, mesh->names);
  }
}

TEST(NamesInFiles, StandInFormatsThatAreOnlyWritten) {
  TempFolder folder;
  Mesh mesh = named_mesh();
  mesh.names.markers[3] = "the \\ \"quay\"";
  for (const char* name : {"m.nc", "m.2dm", "m.geojson"})
    ASSERT_TRUE(write_files(mesh.view(), folder / name)) << name;
  EXPECT_THAT(contents_of(folder / "m.nc"), HasSubstr("inlet outlet the____quay_ w_nd_4 unused"));
  EXPECT_THAT(contents_of(folder / "m.nc"), HasSubstr("fluid"));
  const std::string sms = contents_of(folder / "m.2dm");
  EXPECT_THAT(sms, HasSubstr(" -5 1 \"inlet\"\n"));
  EXPECT_THAT(sms, HasSubstr(" 3 \"the \\ 'quay'\"\n"));
  EXPECT_THAT(sms, HasSubstr("BEG2DMBC\nMAT 7 \"fluid\"\nEND2DMBC\n"));
  std::set<std::string> names;
  const auto geojson = nlohmann::json::parse(contents_of(folder / "m.geojson"));
  for (const auto& feature : geojson["features"])
    for (const char* member : {"marker_name", "region_name"})
      if (feature["properties"].contains(member)) names.insert(feature["properties"][member]);
  EXPECT_EQ(names,
            (std::set<std::string>{"inlet", "outlet", "the \\ \"quay\"", "w\u00e4nd_4", "fluid"}));
  // And back, as a domain.
  const auto domain = read_domain(folder / "m.geojson");
  ASSERT_TRUE(domain) << domain.error().message;
  mesh.names.markers.erase(9);
  EXPECT_EQ(domain->names, mesh.names);
}

TEST(NamesInFiles, StandInFormatsOfSimulations) {
  TempFolder folder;
  Mesh mesh = named_mesh();
  mesh.names.markers[3] = "the <&> \"quay\"";
  for (const char* name : {"m.exo", "m.xdmf"})
    ASSERT_TRUE(write_files(mesh.view(), folder / name)) << name;
  std::filesystem::create_directories(folder / "constant/polyMesh");
  ASSERT_TRUE(write_files(mesh.view(), folder / "m.foam"));

  const std::string xml = contents_of(folder / "m.xdmf");
  EXPECT_THAT(xml, HasSubstr(R"(<Information Name="marker 3" Value="the &lt;&amp;&gt; )"
                             R"(&quot;quay&quot;"/>)"));
  EXPECT_THAT(xml, HasSubstr(R"(<Information Name="region 7" Value="fluid"/>)"));
  const auto row = [](std::string name) { return name + std::string(33 - name.size(), '\0'); };
  const std::string exodus = contents_of(folder / "m.exo");
  EXPECT_THAT(exodus, HasSubstr(row("region 0") + row("fluid")));
  EXPECT_THAT(exodus, HasSubstr(row("inlet") + row("outlet") + row("the <&> \"quay\"") +
                                row("w\u00e4nd_4")));
  const std::string patches = contents_of(folder / "constant/polyMesh/boundary");
  for (const char* word : {"\n  inlet\n  {", "\n  the______quay_\n  {", "\n  w_nd_4\n  {"})
    EXPECT_THAT(patches, HasSubstr(word));
  const std::string zones = contents_of(folder / "constant/polyMesh/cellZones");
  for (const char* word : {"\n  region_0\n  {", "\n  fluid\n  {"})
    EXPECT_THAT(zones, HasSubstr(word));
}

TEST(NamesInFiles, OfExodusMakeItsRowsAsLongAsTheyNeed) {
  TempFolder folder;
  Mesh mesh = named_mesh();
  mesh.names.markers[1] = std::string(200, 'x');
  ASSERT_TRUE(write_files(mesh.view(), folder / "m.exo"));
  const std::string exodus = contents_of(folder / "m.exo");
  EXPECT_THAT(exodus, HasSubstr(std::string(200, 'x') + '\0' + "outlet"));
  EXPECT_THAT(exodus, HasSubstr("fluid" + std::string(196, '\0')));
}

// Whatever names hold, a file is read back with all its triangles, and its names are those that its
// format spells.
TEST(NamesInFiles, NeverBreakAFile) {
  const Mesh mesh = hostile_mesh();
  for (const char* name : {"m.vtu", "m.npz", "m.msh", "m.su2", "m.obj", "m.nc", "m.2dm"}) {
    const auto back = round_trip(mesh, name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->triangles.size(), mesh.triangles.size()) << name;
    EXPECT_THAT(back->warnings, IsEmpty()) << name;
    const Names written = names_in(*mesh_format(name), mesh.names);
    std::set<std::string> expected;
    for (const auto& [id, text] : written.markers)
      if (std::find(mesh.edge_markers.begin(), mesh.edge_markers.end(), id) !=
          mesh.edge_markers.end())
        expected.insert(text);
    std::set<std::string> found;
    for (const auto& [id, text] : back->names.markers)
      if (std::find(back->edge_markers.begin(), back->edge_markers.end(), id) !=
          back->edge_markers.end())
        found.insert(text);
    EXPECT_EQ(found, expected) << name;
  }
  for (const char* name : {"m.vtu", "m.npz", "m.node"}) {
    const auto back = round_trip(mesh, name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->names, mesh.names) << name;
  }
  TempFolder folder;
  for (const char* name : {"m.nc", "m.2dm", "m.geojson"})
    ASSERT_TRUE(write_files(mesh.view(), folder / name)) << name;
  EXPECT_TRUE(nlohmann::json::accept(contents_of(folder / "m.geojson")));
}

TEST(NamesInFiles, ThatAreLostOrSpelledInAnotherWayAreReported) {
  Mesh mesh = named_mesh();
  EXPECT_THAT(not_carried("m.vtu", mesh.view()), IsEmpty());
  EXPECT_THAT(
      not_carried("m.stl", mesh.view()),
      ElementsAre("m.stl: the format does not carry these names: marker 1 'inlet', marker 2 "
                  "'outlet', marker 4 'w\u00e4nd_4', marker 9 'unused', region 7 'fluid'"));
  EXPECT_THAT(
      not_carried("m.su2", mesh.view()),
      ElementsAre("m.su2: the format does not carry these names: marker 9 'unused', region 7 "
                  "'fluid'"));
  mesh.names.regions = {{7, "the fluid"}, {8, "the_fluid"}};
  EXPECT_THAT(not_carried("m.nc", mesh.view()),
              ElementsAre("m.nc: the format cannot spell all names, it has 'w_nd_4' for "
                          "'w\u00e4nd_4', 'the_fluid_2' for 'the fluid'"));
  mesh.names.markers.clear();
  for (int i = 0; i < 8; ++i) mesh.names.markers[i] = "m" + std::to_string(i);
  EXPECT_THAT(not_carried("m.off", mesh.view()).front(), HasSubstr("marker 4 'm4' and 5 more"));
}

TEST(NamesInFiles, OfEdgesInsideTheDomainAreReportedWhereTheFormatHasNone) {
  Mesh mesh = square_mesh(4);
  // The first edge becomes a diagonal, the only edge with marker 1.
  mesh.edges[0] = mesh.triangles[0];
  mesh.edges[1] = mesh.triangles[2];
  std::replace(mesh.edge_markers.begin() + 1, mesh.edge_markers.end(), 1, 2);
  mesh.names.markers = {{1, "baffle"}, {2, "wall"}};
  const std::string lost = ": the format does not carry these names: marker 1 'baffle'";
  for (const char* name : {"m.2dm", "m.su2", "m.foam"})
    EXPECT_THAT(not_carried(name, mesh.view()), ElementsAre(name + lost));
  EXPECT_THAT(not_carried("m.vtu", mesh.view()), IsEmpty());
}

TEST(NamesInDomains, OfGeojsonAreTextsOrBesideNumbers) {
  TempFolder folder;
  const auto domain =
      read_domain(folder.write("d.geojson", R"({"type":"FeatureCollection","features":[
    {"type":"Feature","properties":{"marker":"wall","region":"fluid"},
     "geometry":{"type":"Polygon","coordinates":[[[0,0],[4,0],[4,4],[0,4],[0,0]]]}},
    {"type":"Feature","properties":{"marker":1,"marker_name":"gauge"},
     "geometry":{"type":"LineString","coordinates":[[1,1],[2,2]]}},
    {"type":"Feature","properties":{"marker":"wall"},
     "geometry":{"type":"LineString","coordinates":[[1,2],[2,3]]}},
    {"type":"Feature","properties":{"region":4,"region_name":"solid","marker":""},
     "geometry":{"type":"Polygon","coordinates":[[[5,0],[9,0],[9,4],[5,0]]]}}]})"));
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->names.markers, (NameTable{{1, "gauge"}, {2, "wall"}}));
  EXPECT_EQ(domain->names.regions, (NameTable{{1, "fluid"}, {4, "solid"}}));
  std::multiset<std::int32_t> markers;
  for (const auto& segment : domain->segments) markers.insert(segment.marker);
  EXPECT_EQ(markers, (std::multiset<std::int32_t>{2, 2, 2, 2, 1, 2, 0, 0, 0}));
  ASSERT_EQ(domain->areas.size(), 2u);
  EXPECT_EQ(domain->areas[0].region, 1);
  EXPECT_EQ(domain->areas[1].region, 4);
  EXPECT_THAT(domain->warnings, IsEmpty());
}

TEST(NamesInDomains, OfGeojsonThatDifferAreLeftOut) {
  TempFolder folder;
  const auto domain =
      read_domain(folder.write("d.geojson", R"({"type":"FeatureCollection","features":[
    {"type":"Feature","properties":{"marker":1,"marker_name":"a"},
     "geometry":{"type":"LineString","coordinates":[[1,1],[2,2]]}},
    {"type":"Feature","properties":{"marker":1,"marker_name":"b"},
     "geometry":{"type":"LineString","coordinates":[[1,1],[3,2]]}}]})"));
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->names.markers, (NameTable{{1, "a"}}));
  ASSERT_EQ(domain->warnings.size(), 1u);
  EXPECT_THAT(domain->warnings[0].sentence(), HasSubstr("marker 1"));
}

TEST(NamesInDomains, OfCsvRingsAreMarkers) {
  TempFolder folder;
  const auto domain =
      read_domain(folder.write("d.csv", "x,y,marker\n0,0,quay\n1,0,2\n1,1,open-sea\n0,1,quay\n"));
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->names.markers, (NameTable{{1, "quay"}, {3, "open-sea"}}));
  std::vector<std::int32_t> markers;
  for (const auto& segment : domain->segments) markers.push_back(segment.marker);
  EXPECT_EQ(markers, (std::vector<std::int32_t>{1, 2, 3, 1}));
}

TEST(NamesInDomains, OfShapefilesAreTexts) {
  TempFolder folder;
  write_named_shapefile(folder / "d");
  const auto domain = read_domain(folder / "d.shp");
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->names.markers, (NameTable{{1, "coast"}, {2, "island"}}));
  EXPECT_EQ(domain->names.regions, (NameTable{{5, "bay"}}));
}

TEST(NamesInDomains, OfRegionsInPolyFilesAreTheirValues) {
  TempFolder folder;
  const auto domain = read_domain(
      folder.write("d.poly",
                   "4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n"
                   "2\n1 0.2 0.2 2.5 -1\n2 0.3 0.3 1 -1\n"));
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->names.regions, (NameTable{{2, "2.5"}}));
}

TEST(NamesInDomains, OfPolyFilesAreComments) {
  TempFolder folder;
  const auto domain = read_domain(folder.write(
      "d.poly",
      "# marker=2:inlet \r\n3 2 0 0\n1 0 0\n2 1 0\n3 1 1 # marker=5:no\n3 1\n1 1 2 2\n2 2 3 3\n"
      "3 3 1 3\n0\n1\n1 0.7 0.2 0.5 -1\n"
      "# marker=3:in # out: all\n # marker=7:no\n# marker=x:no\n#marker=8:no\n# marker=9\n"
      "# region=4:fluid\n# region=99999999999:no\n# marker=3:other\n# marker=-1:last"));
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->names.markers, (NameTable{{-1, "last"}, {2, "inlet "}, {3, "in # out: all"}}));
  EXPECT_EQ(domain->names.regions, (NameTable{{1, "0.5"}, {4, "fluid"}}));
  ASSERT_EQ(domain->warnings.size(), 1u);
  EXPECT_THAT(domain->warnings[0].sentence(),
              HasSubstr("marker 3 is left out: the first is 'in # out: all'"));
}

TEST(NamesInDomains, ArePutIntoPolyFiles) {
  TempFolder folder;
  const auto domain =
      read_domain(folder.write("d.csv", "x,y,marker\n0,0,quay\n1,0,2\n1,1,open-sea\n0,1,quay\n"));
  ASSERT_TRUE(domain) << domain.error().message;
  std::vector<OutputFile> files;
  files.push_back(OutputFile::create(folder / "d.poly", {}).value());
  write_triangle_poly(*domain, files[0]);
  ASSERT_TRUE(commit(files));
  const auto back = read_domain(folder / "d.poly");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->names, domain->names);
}

}  // namespace
}  // namespace weft::files
