// SPDX-License-Identifier: Apache-2.0
// What a request may be, by its headers.
#include "server/console/request_rules.h"

#include <gtest/gtest.h>

namespace weft::server {
namespace {

using std::chrono::nanoseconds;

TEST(Hosts, AreAddressesAndLocalhostAndWhatIsNamed) {
  const OriginRules rules{.host = "mesh.example.org",
                          .origins = {"https://proxy.example.org:8443"}};
  for (const char* known : {"127.0.0.1", "127.0.0.1:8080", "[::1]:8080", "192.168.1.2", "localhost",
                            "LocalHost:1", "mesh.example.org:8080", "proxy.example.org:8443"})
    EXPECT_TRUE(rules.knows_host(known)) << known;
  for (const char* unknown :
       {"", "evil.example.org", "evil.example.org:8080", "localhost.evil.example.org",
        "127.0.0.1.evil.example.org", "proxy.example.org", "[::1", "["})
    EXPECT_FALSE(rules.knows_host(unknown)) << unknown;
}

TEST(Hosts, AreJudgedByTheCertificateIfThereIsOne) {
  EXPECT_TRUE((OriginRules{.tls = true}).knows_host("mesh.example.org"));
}

TEST(Origins, AreTheConsolesOwnOrNamedOrForeign) {
  const OriginRules rules{.origins = {"https://app.example.org"}};
  const auto judge = [&](const char* origin) { return rules.judge(origin, "localhost:8080"); };
  EXPECT_EQ(judge(""), PageOrigin::kOwn);
  EXPECT_EQ(judge("http://localhost:8080"), PageOrigin::kOwn);
  EXPECT_EQ(judge("https://app.example.org"), PageOrigin::kListed);
  for (const char* foreign : {"null", "http://localhost", "http://localhost:9999",
                              "https://localhost:8080", "http://app.example.org",
                              "https://app.example.org:444", "https://app.example.org.evil.org"})
    EXPECT_EQ(judge(foreign), PageOrigin::kForeign) << foreign;
}

TEST(Origins, OfAnEncryptedConsoleAreEncrypted) {
  const OriginRules rules{.tls = true};
  EXPECT_EQ(rules.judge("https://mesh.example.org", "mesh.example.org"), PageOrigin::kOwn);
  EXPECT_EQ(rules.judge("http://mesh.example.org", "mesh.example.org"), PageOrigin::kForeign);
}

TEST(Origins, AreSpelledAsBrowsersDo) {
  for (const char* right :
       {"https://example.org", "http://localhost:5173", "https://[::1]:8443", "http://10.0.0.1"})
    EXPECT_TRUE(is_origin(right)) << right;
  for (const char* wrong : {"", "*", "null", "example.org", "https://", "https://example.org/",
                            "ftp://example.org", "https://Example.org", "https://a b", "http://:1"})
    EXPECT_FALSE(is_origin(wrong)) << wrong;
}

TEST(MetadataNames, AreNeitherOfHttpNorReserved) {
  for (const char* passed : {"authorization", "traceparent", "x-request-id", "some-bin"})
    EXPECT_TRUE(is_metadata(passed)) << passed;
  for (const char* kept : {"host", "cookie", "content-length", "transfer-encoding", "te",
                           "grpc-timeout", "grpc-encoding", "sec-fetch-site", "weft-console-secret",
                           "weft-console-name", "weft-console-peer", "x-user-agent"})
    EXPECT_FALSE(is_metadata(kept)) << kept;
}

TEST(Timeouts, HaveDigitsAndAUnit) {
  EXPECT_EQ(parse_timeout("1H"), std::chrono::hours(1));
  EXPECT_EQ(parse_timeout("2M"), std::chrono::minutes(2));
  EXPECT_EQ(parse_timeout("3S"), std::chrono::seconds(3));
  EXPECT_EQ(parse_timeout("4m"), std::chrono::milliseconds(4));
  EXPECT_EQ(parse_timeout("5u"), std::chrono::microseconds(5));
  EXPECT_EQ(parse_timeout("99999999n"), nanoseconds(99'999'999));
  EXPECT_EQ(parse_timeout("0S"), nanoseconds(0));
  EXPECT_GT(parse_timeout("99999999H").value(), std::chrono::hours(8000));
  EXPECT_GT(parse_timeout("99999999M").value(), std::chrono::hours(8000));
  for (const char* wrong : {"", "1", "S", "1s", "-1S", "+1S", "1.5S", " 1S", "1S ", "123456789S"})
    EXPECT_EQ(parse_timeout(wrong), std::nullopt) << wrong;
}

TEST(MethodPaths, HaveAServiceAndAMethod) {
  EXPECT_TRUE(is_method_path("/weft.v1.MeshService/GenerateMesh"));
  for (const char* wrong : {"", "/", "weft.v1.MeshService/GenerateMesh", "/service", "/service/",
                            "//method", "/a/b/c", "/a/b?c", "/a%20/b", "/a.b/c.d"})
    EXPECT_FALSE(is_method_path(wrong)) << wrong;
}

TEST(Gzip, IsTakenByWhoSaysSo) {
  for (const char* yes : {"gzip", "deflate, gzip, br", "br;q=1.0, GZIP;q=0.5", "gzip;q=0.001"})
    EXPECT_TRUE(accepts_gzip(yes)) << yes;
  for (const char* no : {"", "br", "identity", "gzip;q=0", "gzip;q=0.000, br", "xgzip"})
    EXPECT_FALSE(accepts_gzip(no)) << no;
}

}  // namespace
}  // namespace weft::server
