// SPDX-License-Identifier: Apache-2.0
// What is known of a message before it is parsed, and what is taken out of it.
#include "server/wire/wire_scan.h"

#include <gtest/gtest.h>

#include <string>

#include "server/wire/limits.h"
#include "server/wire/request_reader.h"
#include "tests/server/raw_call.h"
#include "weft/v1/job_service.pb.h"

namespace weft::server::testing {
namespace {

using Domain = v1::Domain;

const google::protobuf::Descriptor& submission() {
  return *v1::SubmitJobRequest::descriptor();
}

v1::SubmitJobRequest request() {
  v1::SubmitJobRequest request;
  v1::Domain& domain = *request.mutable_mesh()->mutable_domain();
  for (const double coordinate : {0.0, 0.0, 1.0, 0.0, 1.0, 1.0}) domain.add_points(coordinate);
  for (const std::uint32_t end : {0u, 1u, 1u, 2u, 2u, 300u}) domain.add_segments(end);
  domain.add_segment_markers(-1);
  domain.add_regions()->set_max_area(2);
  domain.add_regions();
  request.mutable_mesh()->mutable_size()->set_expression("x+1");
  request.set_request_id("one");
  return request;
}

std::uint64_t count(const std::string& bytes, int field) {
  return scan_wire(to_buffer(bytes), submission()).count(*Domain::descriptor(), field);
}

TEST(WireScan, CountsWhatParsingKeeps) {
  const std::string bytes = request().SerializeAsString();
  const WireScan scan = scan_wire(to_buffer(bytes), submission());
  EXPECT_FALSE(scan.malformed);
  EXPECT_EQ(scan.unknown_fields, 0u);
  EXPECT_EQ(count(bytes, Domain::kPointsFieldNumber), 6u);
  EXPECT_EQ(count(bytes, Domain::kSegmentsFieldNumber), 6u) << "one of them has two bytes";
  EXPECT_EQ(count(bytes, Domain::kSegmentMarkersFieldNumber), 1u);
  EXPECT_EQ(count(bytes, Domain::kRegionsFieldNumber), 2u);
  EXPECT_EQ(count(bytes, Domain::kHolesFieldNumber), 0u);
  EXPECT_EQ(scan.count(*v1::SizeField::descriptor(), v1::SizeField::kExpressionFieldNumber), 3u);
}

TEST(WireScan, CountsTwoHalvesOfAMessageTogether) {
  const std::string twice = request().SerializeAsString() + request().SerializeAsString();
  EXPECT_EQ(count(twice, Domain::kRegionsFieldNumber), 4u);
  EXPECT_EQ(count(twice, Domain::kPointsFieldNumber), 12u);
}

TEST(WireScan, CountsNumbersThatComeOneByOne) {
  // Domain.segments, not packed: tag 2 with a varint each.
  const std::string domain("\x10\x01\x10\x02\x10\x03", 6);
  const std::string mesh = "\x0a" + std::string(1, static_cast<char>(domain.size())) + domain;
  const std::string bytes = "\x0a" + std::string(1, static_cast<char>(mesh.size())) + mesh;
  EXPECT_EQ(count(bytes, Domain::kSegmentsFieldNumber), 3u);
}

TEST(WireScan, FindsWhatIsMalformed) {
  for (const std::string& bytes :
       {std::string(1, '\0'), std::string(11, '\xff'), std::string("\x0a\xff\xff\xff\xff\x07"),
        std::string(200, '\x0b'), std::string("\x0c"), std::string("\x0f\x00", 2),
        std::string("\x0a\x03\x0a\x7f\x00", 5), std::string("\x0a\x02\x0a\x7f"),
        std::string("\x0a\x04\x0a\x02\x0a\x03", 6)})
    EXPECT_TRUE(scan_wire(to_buffer(bytes), submission()).malformed) << bytes.size();
}

// Fields 100 and 101 of no message: a number, a text, a group with a group in it.
const std::string kUnknown("\xa0\x06\x07\xaa\x06\x02hi\xa3\x06\xab\x06\xac\x06\xa4\x06", 16);

TEST(UnknownFields, AreCountedAndTakenOutAtEveryDepth) {
  v1::SubmitJobRequest strange = request();
  const auto add = [](google::protobuf::Message& message) {
    message.GetReflection()->MutableUnknownFields(&message)->AddVarint(100, 300);
    message.GetReflection()->MutableUnknownFields(&message)->AddLengthDelimited(
        101, std::string(200, 'u'));
  };
  add(strange);
  add(*strange.mutable_mesh());
  add(*strange.mutable_mesh()->mutable_domain());
  add(*strange.mutable_mesh()->mutable_domain()->mutable_regions(1));
  add(*strange.mutable_mesh()->mutable_size());
  const std::string bytes = kUnknown + strange.SerializeAsString() + kUnknown;
  const WireScan scan = scan_wire(to_buffer(bytes), submission());
  EXPECT_FALSE(scan.malformed);
  EXPECT_EQ(scan.unknown_fields, 2u * 5 + 2u * 3);
  const std::string kept = to_string(without_unknown_fields(to_buffer(bytes), submission()));
  EXPECT_LT(kept.size(), bytes.size());
  v1::SubmitJobRequest parsed;
  ASSERT_TRUE(parsed.ParseFromString(kept));
  EXPECT_EQ(parsed.SerializeAsString(), request().SerializeAsString());
  EXPECT_EQ(scan_wire(to_buffer(kept), submission()).unknown_fields, 0u);
}

TEST(UnknownFields, AreThoseOfAnotherWireType) {
  // request_id, a text, as a number.
  const std::string bytes("\x10\x05", 2);
  EXPECT_EQ(scan_wire(to_buffer(bytes), submission()).unknown_fields, 1u);
  v1::SubmitJobRequest parsed;
  ASSERT_TRUE(parsed.ParseFromString(bytes));
  EXPECT_FALSE(parsed.GetReflection()->GetUnknownFields(parsed).empty());
}

TEST(UnknownFields, OfANewerClientAreIgnored) {
  v1::SubmitJobRequest valid = request();
  v1::Domain& domain = *valid.mutable_mesh()->mutable_domain();
  domain.clear_segment_markers();
  domain.set_segments(5, 0);
  const auto read = read_submission(to_buffer(valid.SerializeAsString() + kUnknown), {});
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->SerializeAsString(), valid.SerializeAsString());
}

TEST(LimitsOfBytes, AreThoseOfTheRequest) {
  Limits limits;
  limits.max_segments = 2;
  const auto read = read_submission(to_buffer(request().SerializeAsString()), limits);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().field, "domain.segments");
  EXPECT_EQ(read.error().reason, Reason::kLimitExceeded);
}

}  // namespace
}  // namespace weft::server::testing
