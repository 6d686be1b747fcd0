// SPDX-License-Identifier: Apache-2.0
#include "client/call/server_error.h"

#include <gtest/gtest.h>

#include "files/base/text.h"
#include "files/message/domain_message.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"

namespace weft::client {
namespace {

grpc::Status refusal(const std::string& field, const std::string& message) {
  google::rpc::Status details;
  google::rpc::ErrorInfo info;
  info.set_reason("INDEX_OUT_OF_RANGE");
  details.add_details()->PackFrom(info);
  google::rpc::BadRequest bad;
  bad.add_field_violations()->set_field(field);
  details.add_details()->PackFrom(bad);
  return {grpc::StatusCode::INVALID_ARGUMENT, message, details.SerializeAsString()};
}

Domain domain_with_places() {
  Domain domain;
  domain.points.resize(3);
  domain.segments.resize(3);
  domain.point_places.add(0, "coast.poly:", 2, "");
  domain.segment_places.add(0, "coast.poly:", 6, "");
  domain.segment_places.add(2, "coast.poly:", 10, "");
  return domain;
}

TEST(ServerError, NamesReasonFieldAndPlaceInTheFile) {
  const Domain domain = domain_with_places();
  const Error error =
      error_of(refusal("domain.segments[2].b", "segment 2 ends at point 7, but there are 3 points"),
               "unix:/s", {.domain = &domain});
  EXPECT_EQ(static_cast<int>(error.exit), 67);
  EXPECT_EQ(error.message,
            "the server unix:/s answers INVALID_ARGUMENT (INDEX_OUT_OF_RANGE)\n"
            "  field domain.segments[2].b, at coast.poly:10\n"
            "  segment 2 ends at point 7, but there are 3 points");
}

TEST(ServerError, NamesTheFlagOrTheKeyThatSetTheField) {
  RequestOptions options{.edge = "x + )", .given = {"edge"}};
  const auto status = refusal("size.expression", "unexpected ')'\nx + )\n    ^");
  EXPECT_EQ(error_of(status, "a", {.options = &options}).message,
            "the server a answers INVALID_ARGUMENT (INDEX_OUT_OF_RANGE)\n"
            "  --edge: unexpected ')'\n"
            "  x + )\n"
            "      ^");
  options.from_manifest = true;
  EXPECT_NE(error_of(status, "a", {.options = &options}).message.find("\n  edge: unexpected"),
            std::string::npos);
  const auto other = refusal("threads", "threads is 9");
  EXPECT_TRUE(error_of(other, "a", {.options = &options})
                  .message.ends_with("\n  field threads\n  threads is 9"));
}

TEST(ServerError, GivesPlacesInThePlaneOnTheGlobe) {
  if (!Projection::available()) GTEST_SKIP() << "built without PROJ";
  Domain domain;
  domain.points = {{-72, 37}, {-71, 37}, {-71, 38}};
  const auto projection = DomainProjection::project(domain, {.lonlat = true});
  ASSERT_TRUE(projection) << projection.error().message;
  google::rpc::Status details;
  google::rpc::ErrorInfo info;
  const auto message = [&](grpc::StatusCode code) {
    details.clear_details();
    details.add_details()->PackFrom(info);
    return error_of({code, "no", details.SerializeAsString()}, "a", {.projection = &*projection})
        .message;
  };
  const std::string plane = "\n  no\n  places are in metres of " + projection->name();
  EXPECT_TRUE(message(grpc::StatusCode::INVALID_ARGUMENT).ends_with(plane));
  const Point at = projection->to_plane({-71.25, 37.5});
  EXPECT_TRUE(message(grpc::StatusCode::RESOURCE_EXHAUSTED).ends_with("\n  no"));
  (*info.mutable_metadata())["x"] = shortest(at.x);
  EXPECT_TRUE(message(grpc::StatusCode::INVALID_ARGUMENT).ends_with(plane)) << "half a place";
  (*info.mutable_metadata())["y"] = shortest(at.y);
  const std::string globe = plane + "; this one is at longitude -71.25, latitude 37.5";
  EXPECT_TRUE(message(grpc::StatusCode::INVALID_ARGUMENT).ends_with(globe))
      << message(grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_TRUE(message(grpc::StatusCode::FAILED_PRECONDITION).ends_with(globe));
  EXPECT_TRUE(message(grpc::StatusCode::RESOURCE_EXHAUSTED).ends_with(globe));
  (*info.mutable_metadata())["x"] = "1e300";
  EXPECT_TRUE(message(grpc::StatusCode::INVALID_ARGUMENT).ends_with(plane));
  (*info.mutable_metadata())["x"] = "east";
  EXPECT_TRUE(message(grpc::StatusCode::INVALID_ARGUMENT).ends_with(plane));
}

TEST(ServerError, KeepsACaretUnderItsColumn) {
  const Error error = error_of(refusal("size.expression", "unexpected ')'\nx + )\n    ^"), "a");
  EXPECT_TRUE(error.message.ends_with("\n  unexpected ')'\n  x + )\n      ^"));
}

TEST(ServerError, HintsAtTheFlagsOfAConnectionThatDidNotComeAbout) {
  const auto message = [](grpc::StatusCode code, const std::string& why) {
    return error_of(grpc::Status(code, "failed to connect to all addresses; last error: " + why),
                    "a")
        .message;
  };
  const auto unavailable = grpc::StatusCode::UNAVAILABLE;
  EXPECT_TRUE(message(unavailable, "Ssl handshake failed: SSL_ERROR_SSL: certificate verify failed")
                  .ends_with("--tls-ca FILE adds the CA"));
  EXPECT_TRUE(message(unavailable, "Peer name a is not in peer certificate")
                  .ends_with("--tls-server-name NAME gives that name"));
  EXPECT_TRUE(message(unavailable, "Ssl handshake failed: SSL_ERROR_SSL: wrong version number")
                  .ends_with("leave out --tls and --tls-ca"));
  EXPECT_TRUE(message(unavailable, "Socket closed").ends_with("give --tls or --tls-ca FILE"));
  EXPECT_TRUE(message(unavailable, "Connection refused").ends_with("Connection refused"));
  EXPECT_TRUE(message(grpc::StatusCode::INTERNAL, "Socket closed").ends_with("Socket closed"));
}

TEST(ServerError, SaysWhichFlagTakesAMeshThatMissesItsBounds) {
  google::rpc::Status details;
  google::rpc::ErrorInfo info;
  info.set_reason("BOUNDS_NOT_MET");
  details.add_details()->PackFrom(info);
  const Error error = error_of(
      {grpc::StatusCode::FAILED_PRECONDITION, "12 triangles miss", details.SerializeAsString()},
      "a");
  EXPECT_EQ(static_cast<int>(error.exit), 73);
  EXPECT_EQ(error.message,
            "the server a answers FAILED_PRECONDITION (BOUNDS_NOT_MET)\n"
            "  12 triangles miss\n"
            "  --allow-unrefined takes such a mesh all the same");
}

TEST(ServerError, LetsNoControlCharactersReachTheTerminal) {
  const Error error = error_of({grpc::StatusCode::UNKNOWN, "\x1b[2Jboo"}, "a");
  EXPECT_EQ(error.message, "the server a answers UNKNOWN\n  ?[2Jboo");
}

TEST(ServerError, LivesWithDetailsThatAreGarbage) {
  const Error error = error_of({grpc::StatusCode::UNAVAILABLE, "gone", "\xff\xff garbage"}, "a");
  EXPECT_EQ(static_cast<int>(error.exit), 78);
}

TEST(ServerError, LocatesNothingWhereTheFieldIsNotOfAList) {
  const Domain domain = domain_with_places();
  EXPECT_EQ(locate_field("domain.points[1].x", domain), "coast.poly:3");
  EXPECT_EQ(locate_field("size.constant", domain), "");
  EXPECT_EQ(locate_field("domain.points[", domain), "");
  EXPECT_EQ(locate_field("domain.points[-1]", domain), "");
  EXPECT_EQ(locate_field("domain.holes[0]", domain), "");
}

}  // namespace
}  // namespace weft::client
