// SPDX-License-Identifier: Apache-2.0
// Requests that are refused before any work: over a limit, ill-shaped, or no request at all.
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "tests/server/harness.h"
#include "tests/server/raw_call.h"

namespace weft::server::testing {
namespace {

struct Case {
  const char* name;
  std::function<void(v1::GenerateMeshRequest&)> change;
  const char* field;
  const char* in_message;
};

class Refusals : public ::testing::TestWithParam<Case> {};

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

ServiceOptions small_limits() {
  ServiceOptions options;
  options.limits.max_points = 100;
  options.limits.max_segments = 90;
  options.limits.max_seeds = 80;
  options.limits.max_expression_bytes = 70;
  options.limits.max_raster_values = 65;
  options.limits.max_triangles = 60;
  options.limits.max_bytes = 50;
  options.limits.max_seconds = 40;
  return options;
}

void set_raster(v1::GenerateMeshRequest& request, std::uint32_t columns, std::uint32_t rows) {
  v1::Raster& raster = *request.mutable_size()->mutable_raster();
  raster.set_dx(1);
  raster.set_dy(1);
  raster.set_columns(columns);
  raster.set_rows(rows);
  raster.mutable_values()->Resize(static_cast<int>(columns * rows), 1);
}

v1::NamedField& add_field(v1::GenerateMeshRequest& request) {
  v1::NamedField& field = *request.mutable_size()->add_fields();
  field.set_name("f" + std::to_string(request.size().fields_size()));
  return field;
}

EngineFn must_not_run() {
  return [](const auto&, ChunkSink& sink, auto&) {
    ADD_FAILURE() << "the engine ran";
    return send_chunks(sink, 0);
  };
}

void expect_refused(const Case& each, grpc::StatusCode code, const char* reason) {
  TestServer server(must_not_run(), small_limits());
  v1::GenerateMeshRequest request = valid_request();
  each.change(request);
  const Outcome outcome = call(*server.stub(), request);
  EXPECT_TRUE(outcome.messages.empty());
  EXPECT_EQ(outcome.status.error_code(), code) << outcome.status.error_message();
  EXPECT_NE(outcome.status.error_message().find(each.in_message), std::string::npos)
      << outcome.status.error_message();
  const Details details = details_of(outcome.status);
  EXPECT_EQ(details.error_info.reason(), reason);
  ASSERT_TRUE(details.bad_request);
  EXPECT_EQ(details.bad_request->field_violations(0).field(), each.field);
}

void add_name(google::protobuf::RepeatedPtrField<v1::Name>& table, int id,
              const std::string& text) {
  v1::Name& name = *table.Add();
  name.set_id(id);
  name.set_name(text);
}

// A case of a marker's name, after one that is sound: marker 2 is "inlet".
Case name_case(const char* name, int id, const std::string& text, const char* field,
               const char* in_message) {
  return {name,
          [=](v1::GenerateMeshRequest& r) {
            add_name(*r.mutable_domain()->mutable_marker_names(), 2, "inlet");
            add_name(*r.mutable_domain()->mutable_marker_names(), id, text);
          },
          field, in_message};
}

class OverLimit : public Refusals {};
TEST_P(OverLimit, IsRefusedNamingFieldValueAndLimit) {
  expect_refused(GetParam(), grpc::StatusCode::RESOURCE_EXHAUSTED, "LIMIT_EXCEEDED");
}

class IllShaped : public Refusals {};
TEST_P(IllShaped, IsRefusedNamingTheField) {
  expect_refused(GetParam(), grpc::StatusCode::INVALID_ARGUMENT, "BAD_ARRAY");
}

class BadSizeValue : public Refusals {};
TEST_P(BadSizeValue, IsRefusedBeforeTheEngineRuns) {
  expect_refused(GetParam(), grpc::StatusCode::INVALID_ARGUMENT, "BAD_SIZE_VALUE");
}

class ExpressionSyntax : public Refusals {};
TEST_P(ExpressionSyntax, IsRefusedBeforeTheEngineRuns) {
  expect_refused(GetParam(), grpc::StatusCode::INVALID_ARGUMENT, "EXPRESSION_SYNTAX");
}

class BadOption : public Refusals {};
TEST_P(BadOption, IsRefusedNamingFieldValueAndRange) {
  expect_refused(GetParam(), grpc::StatusCode::INVALID_ARGUMENT, "BAD_OPTION");
}

std::string name_of(const ::testing::TestParamInfo<Case>& info) {
  return info.param.name;
}

using Request = v1::GenerateMeshRequest;

INSTANTIATE_TEST_SUITE_P(
    Refusal, OverLimit,
    ::testing::Values(
        Case{"Points", [](Request& r) { r.mutable_domain()->mutable_points()->Resize(202, 0); },
             "domain.points", "101 points; this server's limit is 100"},
        Case{"Segments",
             [](Request& r) {
               r.mutable_domain()->clear_segment_markers();
               r.mutable_domain()->mutable_segments()->Resize(182, 0);
             },
             "domain.segments", "91 segments; this server's limit is 90"},
        Case{"Holes", [](Request& r) { r.mutable_domain()->mutable_holes()->Resize(162, 0); },
             "domain.regions", "81 hole and region seeds and areas; this server's limit is 80"},
        Case{"Regions",
             [](Request& r) {
               for (int i = 0; i < 81; ++i) r.mutable_domain()->add_regions();
             },
             "domain.regions", "81 hole and region seeds and areas; this server's limit is 80"},
        Case{"Areas",
             [](Request& r) {
               for (int i = 0; i < 81; ++i) r.mutable_domain()->add_areas();
             },
             "domain.regions", "81 hole and region seeds and areas; this server's limit is 80"},
        Case{"SegmentAreas",
             [](Request& r) { r.mutable_domain()->mutable_segment_areas()->Resize(91, 0); },
             "domain.segment_areas", "91 areas; this server's limit is 90"},
        Case{"Names",
             [](Request& r) {
               for (int i = 0; i < 8192; ++i) r.mutable_domain()->add_marker_names();
               for (int i = 0; i < 8193; ++i) r.mutable_domain()->add_region_names();
             },
             "domain.marker_names",
             "16385 names of markers and regions; this server's limit is 16384"},
        Case{"NameBytes",
             [](Request& r) {
               for (int i = 0; i < 4200; ++i)
                 add_name(*r.mutable_domain()->mutable_region_names(), i,
                          std::to_string(1000 + i) + std::string(246, 'x'));
             },
             "domain.marker_names",
             "1050000 bytes of names of markers and regions; this server's limit is 1048576"},
        Case{"Expression",
             [](Request& r) { r.mutable_size()->set_expression(std::string(71, '1')); },
             "size.expression", "71 bytes; this server's limit is 70"},
        Case{"Raster", [](Request& r) { set_raster(r, 11, 6); }, "size.raster.values",
             "66 values; this server's limit is 65"},
        Case{"SizesAt",
             [](Request& r) {
               for (int i = 0; i < 33; ++i) r.mutable_size()->add_at();
             },
             "size.at", "33 markers; this server's limit is 32"},
        Case{"MarkersToKeep",
             [](Request& r) {
               for (int i = 0; i < 4097; ++i) r.mutable_quality()->mutable_keep()->add_markers(i);
             },
             "quality.keep.markers", "4097 markers; this server's limit is 4096"},
        Case{"PeriodicSides",
             [](Request& r) {
               for (int i = 0; i < 17; ++i) r.mutable_quality()->add_periodic();
             },
             "quality.periodic", "17 pairs of sides; this server's limit is 16"},
        Case{"Fields",
             [](Request& r) {
               for (int i = 0; i < 33; ++i) add_field(r).mutable_width();
             },
             "size.fields", "33 fields; this server's limit is 32"},
        Case{"FieldPoints",
             [](Request& r) {
               add_field(r).mutable_distance()->mutable_points()->Resize(102, 0);
               v1::FieldMesh& mesh = *add_field(r).mutable_mesh();
               mesh.mutable_vertices()->Resize(100, 0);
               mesh.mutable_values()->Resize(50, 0);
               mesh.mutable_triangles()->Resize(3, 0);
             },
             "size.fields", "101 points; this server's limit is 100"},
        Case{
            "FieldSegments",
            [](Request& r) { add_field(r).mutable_distance()->mutable_segments()->Resize(182, 0); },
            "size.fields", "91 segments; this server's limit is 90"},
        Case{"FieldMarkers",
             [](Request& r) { add_field(r).mutable_distance()->mutable_markers()->Resize(91, 0); },
             "size.fields", "91 markers; this server's limit is 90"},
        Case{"FieldTriangles",
             [](Request& r) { add_field(r).mutable_mesh()->mutable_triangles()->Resize(603, 0); },
             "size.fields", "201 triangles; this server's limit is 200"},
        Case{"FieldValues",
             [](Request& r) {
               for (int i = 0; i < 2; ++i)
                 add_field(r).mutable_raster()->mutable_values()->Resize(33, 0);
             },
             "size.fields", "66 raster values; this server's limit is 65"},
        Case{"Triangles", [](Request& r) { r.mutable_budget()->set_max_triangles(61); },
             "budget.max_triangles", "61 triangles; this server's limit is 60"},
        Case{"Bytes", [](Request& r) { r.mutable_budget()->set_max_bytes(51); }, "budget.max_bytes",
             "51 bytes; this server's limit is 50"},
        Case{"Seconds", [](Request& r) { r.mutable_budget()->set_max_seconds(40.5); },
             "budget.max_seconds", "40.5 seconds; this server's limit is 40"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Refusal, IllShaped,
    ::testing::Values(
        Case{"OddPoints", [](Request& r) { r.mutable_domain()->add_points(1); }, "domain.points",
             "9 numbers"},
        Case{"OddSegments", [](Request& r) { r.mutable_domain()->add_segments(1); },
             "domain.segments", "9 numbers"},
        Case{"OddHoles", [](Request& r) { r.mutable_domain()->add_holes(1); }, "domain.holes",
             "1 numbers"},
        Case{"Markers", [](Request& r) { r.mutable_domain()->add_segment_markers(1); },
             "domain.segment_markers", "5 markers for 4 segments"},
        Case{"Raster",
             [](Request& r) {
               set_raster(r, 3, 2);
               r.mutable_size()->mutable_raster()->add_values(1);
             },
             "size.raster.values", "7 values for 3 columns and 2 rows"},
        Case{"FieldRaster",
             [](Request& r) {
               v1::FieldRaster& raster = *add_field(r).mutable_raster();
               raster.set_dx(1);
               raster.set_dy(1);
               raster.set_columns(3);
               raster.set_rows(2);
             },
             "size.fields[0].raster.values", "0 values for 3 columns and 2 rows"},
        Case{"DistancePoints", [](Request& r) { add_field(r).mutable_distance()->add_points(1); },
             "size.fields[0].distance.points", "1 numbers; coordinates come in pairs"},
        Case{"DistanceSegments",
             [](Request& r) { add_field(r).mutable_distance()->add_segments(1); },
             "size.fields[0].distance.segments", "point indices come in pairs"},
        Case{"FieldTriangles", [](Request& r) { add_field(r).mutable_mesh()->add_triangles(1); },
             "size.fields[0].mesh.triangles", "vertex indices come in threes"},
        Case{"EmptyFieldMesh", [](Request& r) { add_field(r).mutable_mesh(); },
             "size.fields[0].mesh.triangles", "is empty"},
        Case{"FieldMeshValues",
             [](Request& r) {
               v1::FieldMesh& mesh = *add_field(r).mutable_mesh();
               mesh.mutable_vertices()->Resize(6, 0);
               mesh.mutable_triangles()->Resize(3, 0);
             },
             "size.fields[0].mesh.values", "0 values for 3 vertices"},
        Case{"EmptyRaster", [](Request& r) { set_raster(r, 0, 0); }, "size.raster.values",
             "0 values for 0 columns and 0 rows"},
        // 2^32 nodes.
        Case{"HugeRaster",
             [](Request& r) {
               set_raster(r, 0, 0);
               r.mutable_size()->mutable_raster()->set_columns(1u << 16);
               r.mutable_size()->mutable_raster()->set_rows(1u << 16);
             },
             "size.raster.values", "0 values for 65536 columns"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Refusal, BadOption,
    ::testing::Values(
        name_case("EmptyName", 3, "", "domain.marker_names[1].name", "is empty"),
        name_case("LongName", 3, std::string(256, 'x'), "domain.marker_names[1].name",
                  "has 256 bytes; a name has at most 255"),
        name_case("LineInName", 3, "in\nlet", "domain.marker_names[1].name",
                  "has a control character at byte 2"),
        name_case("DeleteInName", 3, "\x7f", "domain.marker_names[1].name",
                  "has a control character at byte 0"),
        name_case("NextLineInName", 3, "caf\xc3\xa9\xc2\x85", "domain.marker_names[1].name",
                  "has a control character at byte 5"),
        name_case("NameTwice", 3, "inlet", "domain.marker_names[1].name",
                  "is 'inlet', which is the name of 2 already"),
        name_case("NamedTwice", 2, "outlet", "domain.marker_names[1].id",
                  "is 2, which domain.marker_names[0].id names already"),
        Case{"RegionNamedTwice",
             [](Request& r) {
               auto& names = *r.mutable_domain()->mutable_region_names();
               for (const int id : {5, 1, 3, 1, 5})
                 add_name(names, id, std::to_string(names.size()));
             },
             "domain.region_names[3].id", "is 1, which domain.region_names[1].id names already"},
        Case{"NoDomain", [](Request& r) { r.clear_domain(); }, "domain", "required"},
        Case{"Fill", [](Request& r) { r.mutable_domain()->set_fill(static_cast<v1::Fill>(9)); },
             "domain.fill", "9"},
        Case{"RegionArea",
             [](Request& r) {
               r.mutable_domain()->add_regions();
               r.mutable_domain()->add_regions()->set_max_area(0);
             },
             "domain.regions[1].max_area", "is 0"},
        Case{"Measure",
             [](Request& r) { r.mutable_size()->set_measure(static_cast<v1::Measure>(9)); },
             "size.measure", "9"},
        Case{"RegionEdge",
             [](Request& r) { r.mutable_domain()->add_regions()->set_max_edge(1e-200); },
             "domain.regions[0].max_edge", "so must its square"},
        Case{"SizeAt", [](Request& r) { r.mutable_size()->add_at()->set_marker(3); },
             "size.at[0].max_edge", "is 0"},
        Case{"SizeAtTwice",
             [](Request& r) {
               r.mutable_size()->add_at()->set_max_edge(1);
               r.mutable_size()->add_at()->set_max_edge(2);
             },
             "size.at[1].marker", "as that of size.at[0]"},
        Case{"Gradation", [](Request& r) { r.mutable_size()->set_gradation(-1); }, "size.gradation",
             "is -1"},
        Case{"FieldOfNoKind", [](Request& r) { add_field(r); }, "size.fields[0]", "has no kind"},
        Case{"FieldName",
             [](Request& r) {
               add_field(r).mutable_width();
               add_field(r).mutable_width();
               r.mutable_size()->mutable_fields(1)->set_name("pi");
             },
             "size.fields[1].name", "means something else"},
        Case{"FieldRasterStep", [](Request& r) { add_field(r).mutable_raster()->set_dx(-1); },
             "size.fields[0].raster.dx", "is -1"},
        Case{"RasterOrigin",
             [](Request& r) {
               set_raster(r, 2, 2);
               r.mutable_size()->mutable_raster()->set_y(kNan);
             },
             "size.raster.y", "is nan"},
        Case{"RasterSpacing",
             [](Request& r) {
               set_raster(r, 2, 2);
               r.mutable_size()->mutable_raster()->set_dx(0);
             },
             "size.raster.dx", "is 0"},
        Case{"AngleOver", [](Request& r) { r.mutable_quality()->set_min_angle_deg(61); },
             "quality.min_angle_deg", "is 61; it must be from 0 to 36 degrees"},
        Case{"AngleUnder", [](Request& r) { r.mutable_quality()->set_min_angle_deg(-1); },
             "quality.min_angle_deg", "from 0 to 36"},
        Case{"AngleNan", [](Request& r) { r.mutable_quality()->set_min_angle_deg(kNan); },
             "quality.min_angle_deg", "from 0 to 36"},
        Case{"SweepsOver", [](Request& r) { r.mutable_quality()->set_optimise(17); },
             "quality.optimise", "is 17; it must be from 0 to 16 sweeps"},
        Case{"EdgeNegative", [](Request& r) { r.mutable_quality()->set_min_edge(-1); },
             "quality.min_edge", "is -1"},
        Case{"EdgeNan", [](Request& r) { r.mutable_quality()->set_min_edge(kNan); },
             "quality.min_edge", "not a number"},
        Case{"Placement",
             [](Request& r) { r.mutable_quality()->set_placement(static_cast<v1::Placement>(7)); },
             "quality.placement", "7"},
        Case{"SecondsNegative", [](Request& r) { r.mutable_budget()->set_max_seconds(-3); },
             "budget.max_seconds", "is -3"},
        Case{"SecondsFar", [](Request& r) { r.mutable_budget()->set_max_seconds(-100'000); },
             "budget.max_seconds", "is -100000;"},
        Case{"SecondsNan", [](Request& r) { r.mutable_budget()->set_max_seconds(kNan); },
             "budget.max_seconds", "nan"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Refusal, BadSizeValue,
    ::testing::Values(Case{"SizeZero", [](Request& r) { r.mutable_size()->set_constant(0); },
                           "size.constant", "is 0"},
                      Case{"SizeNegative", [](Request& r) { r.mutable_size()->set_constant(-1); },
                           "size.constant", "is -1"},
                      Case{"SizeNan", [](Request& r) { r.mutable_size()->set_constant(kNan); },
                           "size.constant", "not a number"},
                      Case{"SizeInfinite",
                           [](Request& r) { r.mutable_size()->set_constant(kInfinity); },
                           "size.constant", "inf"},
                      Case{"ExpressionNegative",
                           [](Request& r) { r.mutable_size()->set_expression("1-2"); },
                           "size.expression", "is -1"},
                      Case{"RasterValue",
                           [](Request& r) {
                             set_raster(r, 3, 2);
                             r.mutable_size()->mutable_raster()->set_values(4, kNan);
                           },
                           "size.raster.values[4]", "at column 1 of row 1"}),
    name_of);

INSTANTIATE_TEST_SUITE_P(
    Refusal, ExpressionSyntax,
    ::testing::Values(Case{"Half", [](Request& r) { r.mutable_size()->set_expression("1+"); },
                           "size.expression", "line 1, column 3"},
                      Case{"Name", [](Request& r) { r.mutable_size()->set_expression("nan"); },
                           "size.expression", "line 1, column 1"}),
    name_of);

TEST(Refusal, OfNamesThatAreNoTextNamesTheMessage) {
  TestServer server(must_not_run());
  v1::GenerateMeshRequest request = valid_request();
  add_name(*request.mutable_domain()->mutable_marker_names(), 2, "inlet");
  std::string bytes = request.SerializeAsString();
  bytes[bytes.find("inlet")] = '\xff';
  const grpc::Status status = raw_generate_mesh(server.channel(), bytes);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(details_of(status).error_info.reason(), "MALFORMED_REQUEST");
}

TEST(Refusal, OfManyEmptyNamesComesBeforeTheyAreParsed) {
  TestServer server(must_not_run());
  std::string names;
  for (int i = 0; i < 16'385; ++i) names += std::string("\x42\x00", 2);
  v1::GenerateMeshRequest request;
  ASSERT_TRUE(request.mutable_domain()->ParseFromString(names));
  const grpc::Status status = raw_generate_mesh(server.channel(), request.SerializeAsString());
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_NE(status.error_message().find("16385 names"), std::string::npos);
}

TEST(Refusal, AdmitsNamesAtTheirLimits) {
  TestServer server([](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, 0); },
                    small_limits());
  v1::GenerateMeshRequest request = valid_request();
  auto& markers = *request.mutable_domain()->mutable_marker_names();
  auto& regions = *request.mutable_domain()->mutable_region_names();
  add_name(markers, 2, std::string(255, 'x'));
  add_name(markers, std::numeric_limits<int>::min(), "\xc3\xa9 \"<&");
  add_name(regions, 2, "inlet");
  for (int i = 3; regions.size() + markers.size() < 16'384; ++i)
    add_name(regions, i, std::to_string(i));
  const Outcome outcome = call(*server.stub(), request);
  EXPECT_TRUE(outcome.status.ok()) << outcome.status.error_message();
}

TEST(Refusal, AdmitsWhatIsExactlyAtTheLimits) {
  TestServer server([](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, 0); },
                    small_limits());
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_domain()->mutable_points()->Resize(200, 0);
  request.mutable_domain()->mutable_holes()->Resize(160, 0);
  request.mutable_quality()->set_min_angle_deg(36);
  request.mutable_quality()->set_optimise(16);
  request.mutable_budget()->set_max_triangles(60);
  request.mutable_budget()->set_max_bytes(50);
  request.mutable_budget()->set_max_seconds(40);
  const Outcome outcome = call(*server.stub(), request);
  EXPECT_TRUE(outcome.status.ok()) << outcome.status.error_message();
}

TEST(Refusal, OfAMessageOverTheLimitOfBytesComesFromGrpc) {
  ServiceOptions options;
  options.limits.max_request_bytes = 1000;
  TestServer server(must_not_run(), options);
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_domain()->mutable_points()->Resize(200, 0);
  const Outcome outcome = call(*server.stub(), request);
  EXPECT_EQ(outcome.status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_NE(outcome.status.error_message().find("1000"), std::string::npos)
      << outcome.status.error_message();
}

TEST(Refusal, OfCompressedMessagesKeepsTheLimitOfBytes) {
  TestServer server(must_not_run());
  auto stub = server.stub();
  grpc::ClientContext context;
  context.set_compression_algorithm(GRPC_COMPRESS_GZIP);
  v1::GenerateMeshRequest request = valid_request();
  request.mutable_domain()->mutable_points()->Resize(20'000, 0);
  const Outcome outcome = read_all(*stub->GenerateMesh(&context, request));
  EXPECT_EQ(outcome.status.error_code(), grpc::StatusCode::UNIMPLEMENTED);
}

TEST(Refusal, OfManyEmptyRegionsComesBeforeTheyAreParsed) {
  TestServer server(must_not_run());
  std::string regions;
  for (int i = 0; i < 100'001; ++i) regions += std::string("\x2a\x00", 2);
  v1::GenerateMeshRequest request;
  ASSERT_TRUE(request.mutable_domain()->ParseFromString(regions));
  // In two halves of the field, which merge.
  const std::string twice = request.SerializeAsString() + valid_request().SerializeAsString();
  const grpc::Status status = raw_generate_mesh(server.channel(), twice);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_NE(status.error_message().find("100001"), std::string::npos);
}

TEST(Refusal, OfBytesThatAreNoRequestNamesTheMessage) {
  TestServer server(must_not_run());
  const grpc::Status status = raw_generate_mesh(server.channel(), "\x0a\xff\xff");
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(details_of(status).error_info.reason(), "MALFORMED_REQUEST");
}

TEST(Refusal, OfAnEmptyMessageNamesTheDomain) {
  TestServer server(must_not_run());
  EXPECT_EQ(
      details_of(raw_generate_mesh(server.channel(), "")).bad_request->field_violations(0).field(),
      "domain");
}

TEST(Refusal, OfACallWithoutAMessageComesAtOnce) {
  TestServer server(must_not_run());
  const auto channel = server.channel();
  grpc::ClientContext context;
  const grpc::internal::RpcMethod rpc("/weft.v1.MeshService/GenerateMesh",
                                      grpc::internal::RpcMethod::BIDI_STREAMING, channel);
  const std::unique_ptr<grpc::ClientReaderWriter<grpc::ByteBuffer, grpc::ByteBuffer>> stream(
      grpc::internal::ClientReaderWriterFactory<grpc::ByteBuffer, grpc::ByteBuffer>::Create(
          channel.get(), rpc, &context));
  stream->WritesDone();
  EXPECT_FALSE(stream->Finish().ok());
}

TEST(Refusal, RandomBytesNeverHarmTheServer) {
  TestServer server([](const auto&, ChunkSink& sink, auto&) { return send_chunks(sink, 1); });
  const auto channel = server.channel();
  std::mt19937 random(1);
  const std::string valid = valid_request().SerializeAsString();
  for (int round = 0; round < 1000; ++round) {
    std::string bytes = round % 2 == 0 ? valid : std::string(random() % 200, '\0');
    if (round % 2 == 0) {
      for (unsigned i = 0; i <= random() % 4; ++i)
        bytes[random() % bytes.size()] = static_cast<char>(random());
      if (random() % 4 == 0) bytes.resize(random() % bytes.size());
    } else {
      for (char& c : bytes) c = static_cast<char>(random());
    }
    const grpc::Status status = raw_generate_mesh(channel, bytes);
    EXPECT_TRUE(status.ok() || status.error_code() == grpc::StatusCode::INVALID_ARGUMENT ||
                status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED)
        << status.error_message();
  }
  EXPECT_TRUE(call(*server.stub(), valid_request()).status.ok());
}

}  // namespace
}  // namespace weft::server::testing
