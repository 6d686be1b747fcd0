// SPDX-License-Identifier: Apache-2.0
#include "server/wire/request_key.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <functional>
#include <set>

#include "tests/server/harness.h"

namespace weft::server::testing {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

// Gives a field of no message a value that is no default and that valid_request() has nowhere.
void change(Message& message, const FieldDescriptor& field) {
  const Reflection& reflection = *message.GetReflection();
  const bool many = field.is_repeated();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_INT32:
      return many ? reflection.AddInt32(&message, &field, 7)
                  : reflection.SetInt32(&message, &field, 7);
    case FieldDescriptor::CPPTYPE_UINT32:
      return many ? reflection.AddUInt32(&message, &field, 7)
                  : reflection.SetUInt32(&message, &field, 7);
    case FieldDescriptor::CPPTYPE_UINT64:
      return reflection.SetUInt64(&message, &field, 7);
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return many ? reflection.AddDouble(&message, &field, 7)
                  : reflection.SetDouble(&message, &field, 7);
    case FieldDescriptor::CPPTYPE_FLOAT:
      return reflection.AddFloat(&message, &field, 7);
    case FieldDescriptor::CPPTYPE_BOOL:
      return reflection.SetBool(&message, &field, true);
    case FieldDescriptor::CPPTYPE_ENUM:
      return reflection.SetEnumValue(&message, &field, 2);
    case FieldDescriptor::CPPTYPE_STRING:
      return reflection.SetString(&message, &field, "7");
    default:
      ADD_FAILURE() << "no value for " << field.full_name();
  }
}

// Calls visit(path, mutate) for every field below `type` that is no message; `mutate` changes the
// field in a request.
template <class Visit>
void walk(const Descriptor& type, const std::string& path,
          const std::function<Message&(v1::GenerateMeshRequest&)>& reach, Visit&& visit) {
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      walk(
          *field.message_type(), path + field.name() + ".",
          [&](v1::GenerateMeshRequest& request) -> Message& {
            Message& outer = reach(request);
            const Reflection& reflection = *outer.GetReflection();
            return field.is_repeated() ? *reflection.AddMessage(&outer, &field)
                                       : *reflection.MutableMessage(&outer, &field);
          },
          visit);
    } else {
      visit(path + field.name(),
            [&](v1::GenerateMeshRequest& request) { change(reach(request), field); });
    }
  }
}

TEST(MeshKey, DependsOnEveryFieldButTheNamedFew) {
  const v1::GenerateMeshRequest request = valid_request();
  const std::string key = mesh_key(request);
  EXPECT_EQ(key.size(), 32);
  std::set<std::string_view> left_out(kNotInMeshKey.begin(), kNotInMeshKey.end());
  walk(
      *v1::GenerateMeshRequest::descriptor(), "",
      [](v1::GenerateMeshRequest& r) -> Message& { return r; },
      [&](const std::string& path, const auto& mutate) {
        v1::GenerateMeshRequest changed = request;
        mutate(changed);
        EXPECT_EQ(mesh_key(changed) == key, left_out.erase(path) == 1) << path;
      });
  EXPECT_TRUE(left_out.empty()) << "no such field: " << *left_out.begin();
}

// A region's field alone, below an array: `walk` adds a region for it, which changes the key
// anyway.
TEST(MeshKey, DependsOnEveryFieldOfARegion) {
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_domain()->add_regions();
  const std::string key = mesh_key(request);
  const Descriptor& region = *v1::Region::descriptor();
  for (int i = 0; i < region.field_count(); ++i) {
    v1::GenerateMeshRequest changed = request;
    change(*changed.mutable_domain()->mutable_regions(0), *region.field(i));
    EXPECT_NE(mesh_key(changed), key) << region.field(i)->full_name();
  }
}

// A mesh that is found by its key has the names that were asked for.
TEST(MeshKey, DependsOnEveryFieldOfAName) {
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_domain()->add_marker_names();
  request.mutable_domain()->add_region_names();
  const std::string key = mesh_key(request);
  const Descriptor& name = *v1::Name::descriptor();
  std::set<std::string> keys = {key};
  for (int i = 0; i < name.field_count(); ++i) {
    v1::GenerateMeshRequest marker = request;
    change(*marker.mutable_domain()->mutable_marker_names(0), *name.field(i));
    EXPECT_TRUE(keys.insert(mesh_key(marker)).second) << name.field(i)->full_name();
    v1::GenerateMeshRequest region = request;
    change(*region.mutable_domain()->mutable_region_names(0), *name.field(i));
    EXPECT_TRUE(keys.insert(mesh_key(region)).second) << name.field(i)->full_name();
  }
}

TEST(MeshKey, LeavesOutWhatDoesNotChangeTheMesh) {
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_budget()->set_max_triangles(7);
  const std::string key = mesh_key(request);
  request.set_threads(3);
  request.set_first_chunk(2);
  request.set_want_quadtree(true);
  request.set_no_cache(true);
  request.mutable_budget()->set_max_bytes(1 << 30);
  request.mutable_budget()->set_max_seconds(5);
  EXPECT_EQ(mesh_key(request), key);
  request.mutable_budget()->clear_max_triangles();
  EXPECT_EQ(mesh_key(request), mesh_key(valid_request()));
}

TEST(MeshKey, IsTheSameForADefaultThatIsWrittenOut) {
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_domain()->clear_segment_markers();
  const std::string key = mesh_key(request);
  request.mutable_quality()->set_min_angle_deg(20);
  request.mutable_quality()->set_placement(v1::PLACEMENT_LATTICE);
  request.mutable_domain()->set_fill(v1::FILL_SEEDS);
  request.mutable_domain()->set_snap(-0.0);
  request.set_simplify(-0.0);
  request.mutable_size()->set_measure(v1::MEASURE_AREA);
  request.mutable_size()->set_gradation(-0.0);
  request.mutable_size()->set_cells_across(-0.0);
  request.mutable_size()->set_points_per_circle(-0.0);
  for (int i = 0; i < 4; ++i) request.mutable_domain()->add_segment_markers(0);
  EXPECT_EQ(mesh_key(request), key);
}

TEST(MeshKey, TakesLayersWithoutARatioForThoseOfOneHeight) {
  v1::GenerateMeshRequest request;
  v1::Layers& layers = *request.mutable_quality()->add_layers();
  const std::string key = mesh_key(request);
  layers.set_ratio(1);
  EXPECT_EQ(mesh_key(request), key);
  layers.set_ratio(1.2);
  EXPECT_NE(mesh_key(request), key);
}

// Regions have bounds of their own, from which a gradation grows.
TEST(MeshKey, HasWhatASizeWithoutAValueSays) {
  const auto key_of = [](void (*change)(v1::SizeField&)) {
    v1::GenerateMeshRequest request = valid_request();
    request.clear_size();
    request.mutable_domain()->add_regions()->set_max_area(0.1);
    change(*request.mutable_size());
    return mesh_key(request);
  };
  const std::string none = key_of([](v1::SizeField&) {});
  const std::string steep = key_of([](v1::SizeField& size) { size.set_gradation(1); });
  EXPECT_NE(steep, none);
  EXPECT_NE(key_of([](v1::SizeField& size) { size.set_gradation(0.1); }), steep);
  EXPECT_NE(key_of([](v1::SizeField& size) { size.set_gradation_within(true); }), none);
  EXPECT_NE(key_of([](v1::SizeField& size) { size.add_fields()->set_name("d"); }), none);
  EXPECT_EQ(key_of([](v1::SizeField& size) { size.set_measure(v1::MEASURE_EDGE); }), none);
}

TEST(MeshKey, IsTheSameForNamesInAnyOrder) {
  const auto key_of = [](std::initializer_list<int> ids) {
    v1::GenerateMeshRequest request = valid_request();
    for (const int id : ids) {
      for (auto* names : {request.mutable_domain()->mutable_marker_names(),
                          request.mutable_domain()->mutable_region_names()}) {
        v1::Name& name = *names->Add();
        name.set_id(id);
        name.set_name("name " + std::to_string(id));
      }
    }
    return mesh_key(request);
  };
  EXPECT_EQ(key_of({1, 2, -3}), key_of({-3, 2, 1}));
  EXPECT_NE(key_of({1, 2}), key_of({1, 2, -3}));
}

struct Change {
  const char* name;
  void (*make)(v1::GenerateMeshRequest&);
};

class MeshKeyOf : public ::testing::TestWithParam<Change> {};

TEST_P(MeshKeyOf, AnotherMeshIsAnother) {
  v1::GenerateMeshRequest request = valid_request();
  const std::string key = mesh_key(request);
  GetParam().make(request);
  EXPECT_NE(mesh_key(request), key);
}

INSTANTIATE_TEST_SUITE_P(
    Changes, MeshKeyOf,
    ::testing::Values(
        Change{"Point", [](auto& r) { r.mutable_domain()->set_points(0, 0.5); }},
        Change{"Segment", [](auto& r) { r.mutable_domain()->set_segments(0, 2); }},
        Change{"Marker", [](auto& r) { r.mutable_domain()->set_segment_markers(0, 9); }},
        Change{"Hole", [](auto& r) { r.mutable_domain()->add_holes(1); }},
        Change{"Region", [](auto& r) { r.mutable_domain()->add_regions()->set_id(1); }},
        Change{"Area", [](auto& r) { r.mutable_domain()->add_areas()->set_hole(true); }},
        Change{"Arc",
               [](auto& r) {
                 r.mutable_domain()->add_arc_segments(1);
                 r.mutable_domain()->add_arc_bulges(0.5);
               }},
        Change{"SegmentArea", [](auto& r) { r.mutable_domain()->add_segment_areas(1); }},
        Change{"Fill", [](auto& r) { r.mutable_domain()->set_fill(v1::FILL_EVEN_ODD); }},
        Change{"Size", [](auto& r) { r.mutable_size()->set_constant(0.2); }},
        Change{"Expression", [](auto& r) { r.mutable_size()->set_expression("0.1"); }},
        Change{"Raster", [](auto& r) { r.mutable_size()->mutable_raster()->add_values(1); }},
        Change{"Measure", [](auto& r) { r.mutable_size()->set_measure(v1::MEASURE_EDGE); }},
        Change{"Gradation", [](auto& r) { r.mutable_size()->set_gradation(0.2); }},
        Change{"GradationWithin",
               [](auto& r) {
                 r.mutable_size()->set_gradation(0.2);
                 r.mutable_size()->set_gradation_within(true);
               }},
        Change{"SizeAt", [](auto& r) { r.mutable_size()->add_at(); }},
        Change{"RegionEdge", [](auto& r) { r.mutable_domain()->add_regions()->set_max_edge(1); }},
        Change{"PointsPerCircle", [](auto& r) { r.mutable_size()->set_points_per_circle(36); }},
        Change{"CellsAcross", [](auto& r) { r.mutable_size()->set_cells_across(3); }},
        Change{"Field", [](auto& r) { r.mutable_size()->add_fields()->mutable_width(); }},
        Change{"Layers", [](auto& r) { r.mutable_quality()->add_layers(); }},
        Change{"Angle", [](auto& r) { r.mutable_quality()->set_min_angle_deg(21); }},
        Change{"Simplify", [](auto& r) { r.set_simplify(0.5); }},
        Change{"Snap", [](auto& r) { r.mutable_domain()->set_snap(1e-3); }},
        Change{"AllowUnrefined", [](auto& r) { r.set_allow_unrefined(true); }},
        Change{"Edge", [](auto& r) { r.mutable_quality()->set_min_edge(1); }},
        Change{"Placement",
               [](auto& r) { r.mutable_quality()->set_placement(v1::PLACEMENT_CIRCUMCENTRE); }},
        Change{"Optimise", [](auto& r) { r.mutable_quality()->set_optimise(0); }},
        Change{"Triangles", [](auto& r) { r.mutable_budget()->set_max_triangles(7); }}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Sha256, IsThatOfTheStandard) {
  EXPECT_EQ(sha256("abc").substr(0, 4), std::string("\xba\x78\x16\xbf", 4));
}

}  // namespace
}  // namespace weft::server::testing
