// SPDX-License-Identifier: Apache-2.0
#include "server/callbacks/callback_url.h"

#include <gtest/gtest.h>

namespace weft::server {
namespace {

std::string fault_of(std::string_view text) {
  const auto url = CallbackUrl::parse(text);
  return url ? "" : url.error();
}

TEST(CallbackUrl, HasHostPortAndTarget) {
  const auto url = CallbackUrl::parse("HTTPS://Hooks.Example.org/a/b?c=d/e");
  ASSERT_TRUE(url) << url.error();
  EXPECT_TRUE(url->tls);
  EXPECT_EQ(url->host, "hooks.example.org");
  EXPECT_EQ(url->port, "443");
  EXPECT_EQ(url->target, "/a/b?c=d/e");
  EXPECT_EQ(url->authority(), "hooks.example.org");
  EXPECT_EQ(url->place(), "hooks.example.org:443");
}

TEST(CallbackUrl, HasAPortOfItsOwnAndARootByDefault) {
  const auto plain = CallbackUrl::parse("http://example.org:8080?x");
  ASSERT_TRUE(plain) << plain.error();
  EXPECT_FALSE(plain->tls);
  EXPECT_EQ(plain->target, "/?x");
  EXPECT_EQ(plain->authority(), "example.org:8080");
  const auto six = CallbackUrl::parse("http://[2001:db8::1]");
  ASSERT_TRUE(six) << six.error();
  EXPECT_EQ(six->host, "2001:db8::1");
  EXPECT_EQ(six->authority(), "[2001:db8::1]");
  EXPECT_EQ(six->place(), "[2001:db8::1]:80");
}

TEST(CallbackUrl, IsOfHttpAlone) {
  for (const char* text : {"", "example.org", "ftp://example.org/", "file:///etc/passwd",
                           "gopher://example.org/", "//example.org/", "https:/example.org"})
    EXPECT_EQ(fault_of(text), "does not begin with http:// or https://") << text;
}

TEST(CallbackUrl, NamesNoUser) {
  for (const char* text : {"http://ann@example.org/", "http://ann:secret@example.org/",
                           "http://example.org@127.0.0.1/", "http://@example.org/"})
    EXPECT_EQ(fault_of(text), "names a user") << text;
}

TEST(CallbackUrl, HasNothingThatAnotherReaderMayTakeOtherwise) {
  for (const char* text :
       {"http:///path", "http://", "http://[::1", "http://[fe80::1%25eth0]/", "http://[127.0.0.1]/",
        "http://exa%6dple.org/", "http://example.org\\.evil.org/", "http://::1/", "http://[::1]x/",
        "http://example.org:/", "http://example.org:0/", "http://example.org:65536/",
        "http://example.org:80x/", "http://example.org:-1/"})
    EXPECT_NE(fault_of(text), "") << text;
  EXPECT_EQ(fault_of("http://example.org/#part"), "has a fragment");
  EXPECT_NE(fault_of("http://example.org/a b"), "");
  EXPECT_NE(fault_of("http://example.org/\r\nHost: other"), "");
  EXPECT_NE(fault_of("http://ex\xc3\xa4mple.org/"), "");
}

TEST(CallbackUrl, IsBounded) {
  const std::string start = "http://example.org/";
  EXPECT_EQ(fault_of(start + std::string(2048 - start.size(), 'x')), "");
  EXPECT_EQ(fault_of(start + std::string(2049 - start.size(), 'x')), "has more than 2048 bytes");
}

}  // namespace
}  // namespace weft::server
