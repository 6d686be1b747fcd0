// SPDX-License-Identifier: Apache-2.0
#include "server/http/mesh_wish.h"

#include <gtest/gtest.h>

#include <set>

#include "wire/named_options.h"

namespace weft::server {
namespace {

MeshWish wish_of(const Query& query) {
  auto wish = read_wish(query, ~ParameterUses{});
  EXPECT_TRUE(wish) << wish.error().detail;
  return wish.value();
}

Problem problem_with(const Query& query) {
  const auto wish = read_wish(query, ~ParameterUses{});
  EXPECT_FALSE(wish);
  return wish ? Problem{} : wish.error();
}

TEST(MeshWish, HasEveryOptionOfTheProtocolByItsName) {
  std::set<std::string> names;
  for (const Parameter& parameter : mesh_parameters()) {
    EXPECT_TRUE(names.insert(parameter.name).second) << parameter.name;
    EXPECT_FALSE(parameter.about.empty()) << parameter.name;
  }
  std::size_t found = 0;
  for (const wire::NamedOption& option : wire::named_options())
    for (const Parameter& parameter : mesh_parameters()) found += parameter.field == option.path;
  EXPECT_EQ(found, wire::named_options().size() - 1);  // all but want_quadtree
}

TEST(MeshWish, SetsFieldsOfTheRequest) {
  const MeshWish wish = wish_of({{"edge", "0.1+x"},
                                 {"min-angle", "25"},
                                 {"max_triangles", "1000"},
                                 {"placement", "circumcentre"},
                                 {"allow_unrefined", ""},
                                 {"no-cache", "true"},
                                 {"gradation", "0.2"}});
  EXPECT_EQ(wish.request.size().expression(), "0.1+x");
  EXPECT_EQ(wish.request.size().measure(), v1::MEASURE_EDGE);
  EXPECT_EQ(wish.request.size().gradation(), 0.2);
  EXPECT_EQ(wish.request.quality().min_angle_deg(), 25);
  EXPECT_EQ(wish.request.quality().placement(), v1::PLACEMENT_CIRCUMCENTRE);
  EXPECT_EQ(wish.request.budget().max_triangles(), 1000u);
  EXPECT_TRUE(wish.request.allow_unrefined());
  EXPECT_TRUE(wish.request.no_cache());
  EXPECT_EQ(wish_of({{"size", "1e-3"}}).request.size().constant(), 1e-3);
}

TEST(MeshWish, FindsMarkersByTheNamesOfTheDomain) {
  MeshWish wish = wish_of({{"edge_at", "marker=inlet:0.5"},
                           {"edge-at", "marker=3:0.25"},
                           {"keep", "4,inlet"},
                           {"periodic", "inlet:3"},
                           {"layers", "inlet:first=0.5,rows=2"},
                           {"open_boundary", "inlet"}});
  EXPECT_FALSE(complete({{2, "inlet"}}, wish));
  ASSERT_EQ(wish.request.size().at_size(), 2);
  EXPECT_EQ(wish.request.size().at(0).marker(), 2);
  EXPECT_EQ(wish.request.size().at(0).max_edge(), 0.5);
  EXPECT_EQ(wish.request.size().at(1).marker(), 3);
  EXPECT_EQ(wish.request.quality().keep().markers(1), 2);
  EXPECT_EQ(wish.request.quality().periodic(0).from(), 2);
  EXPECT_EQ(wish.request.quality().layers(0).marker(), 2);
  EXPECT_EQ(wish.request.quality().layers(0).rows(), 2u);
  EXPECT_EQ(wish.writing.open_boundaries, std::vector<std::int32_t>{2});
  for (const char* name : {"edge_at", "keep", "periodic", "open_boundary"}) {
    MeshWish unknown = wish_of({{name, name == std::string("edge_at")    ? "marker=outlet:1"
                                       : name == std::string("periodic") ? "outlet:2"
                                                                         : "outlet"}});
    const auto problem = complete({{2, "inlet"}}, unknown);
    ASSERT_TRUE(problem) << name;
    EXPECT_EQ(problem->field, name);
    EXPECT_EQ(problem->status, 400u);
  }
}

TEST(MeshWish, NamesTheParameterAtFault) {
  EXPECT_EQ(problem_with({{"egde", "1"}}).detail,
            "'egde': there is no such parameter; did you mean `edge`?");
  for (const auto& [name, text] : Query{{"min_angle", "much"},
                                        {"optimise", "-1"},
                                        {"lonlat", "perhaps"},
                                        {"crs", "+proj=utm +nadgrids=/etc/passwd"},
                                        {"crs", "EPSG:1/2"},
                                        {"crs", "EPSG:"},
                                        {"fill", "some"},
                                        {"edge_at", "2:5"},
                                        {"keep", ","},
                                        {"periodic", "left"},
                                        {"layers", "wall"},
                                        {"names", "2:inlet"},
                                        {"edge", ""},
                                        {"order", "3"},
                                        {"timeout", "0"},
                                        {"max_triangles", "0"}}) {
    const Problem problem = problem_with({{name, text}});
    EXPECT_EQ(problem.status, 400u) << name;
    EXPECT_EQ(problem.reason, "BAD_OPTION");
    EXPECT_EQ(problem.field, name);
  }
  EXPECT_EQ(problem_with({{"edge", "1"}, {"size", "1"}}).field, "size");
  EXPECT_EQ(problem_with({{"keep", "1"}, {"keep", "2"}}).detail, "keep: is given twice");
  EXPECT_EQ(problem_with({{"from", "gpkg"}}).status, 415u);
  EXPECT_EQ(problem_with({{"format", "doc"}}).status, 406u);
}

TEST(MeshWish, KnowsWhichParameterSetAField) {
  const Query query = {{"edge", "1"}, {"gradation", "2"}, {"min-angle", "50"}, {"lonlat", ""}};
  EXPECT_EQ(parameter_of("size.constant", query), "edge");
  EXPECT_EQ(parameter_of("size.gradation", query), "gradation");
  EXPECT_EQ(parameter_of("quality.min_angle_deg", query), "min-angle");
  EXPECT_EQ(parameter_of("domain.points[3].x", query), "");
}

}  // namespace
}  // namespace weft::server
