// SPDX-License-Identifier: Apache-2.0
#include "server/observe/log.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "server/observe/log_json.h"

namespace weft::server {
namespace {

TEST(LogValue, LeavesPlainWordsAlone) {
  EXPECT_EQ(log_value("ipv4:127.0.0.1:80"), "ipv4:127.0.0.1:80");
}

TEST(LogValue, QuotesWhatWouldBreakALine) {
  EXPECT_EQ(log_value(""), R"("")");
  EXPECT_EQ(log_value("a b"), R"("a b")");
  EXPECT_EQ(log_value("a=b"), R"("a=b")");
  EXPECT_EQ(log_value("a\"b\\c"), R"("a\"b\\c")");
  EXPECT_EQ(log_value("a\nevent=forged"), R"("a\nevent=forged")");
  EXPECT_EQ(log_value("a\x1b[0m"), R"("a\x1b[0m")");
}

TEST(LogValue, QuotesATextThatWouldBeReadAsANumber) {
  EXPECT_EQ(log_value("12"), R"("12")");
  EXPECT_EQ(log_value("1e5"), R"("1e5")");
  EXPECT_EQ(log_value("12-1"), "12-1");
}

TEST(LogJson, HasTheSameKeysInTheSameOrder) {
  EXPECT_EQ(json_of_fields("b=x a=2 event=call_ended c=-"),
            R"({"b":"x","a":2,"event":"call_ended","c":"-"})");
}

TEST(LogJson, WritesNumbersAsNumbersAndAllElseAsText) {
  EXPECT_EQ(json_of_fields("a=0.250 b=-3 c=1e-5 d=18446744073709551615"),
            R"({"a":0.250,"b":-3,"c":1e-5,"d":18446744073709551615})");
  EXPECT_EQ(json_of_fields("a=007 b=1. c=.5 d=+1 e=0x1 f=nan g=- h=1e i= j=1.2.3"),
            R"({"a":"007","b":"1.","c":".5","d":"+1","e":"0x1","f":"nan","g":"-","h":"1e","i":"",)"
            R"("j":"1.2.3"})");
}

TEST(LogJson, GivesBackEveryTextThatWasLogged) {
  for (const std::string& text : std::vector<std::string>{
           "", "plain", "12", "two words", "a=b", "\"quoted\"", "back\\slash", "\\n", "line\nfeed",
           std::string("\0\x01\x1f\x7f", 4), "caf\xc3\xa9", "ends with \\", "} \",{"}) {
    const auto json = nlohmann::json::parse(json_of_fields("event=e text=" + log_value(text)));
    EXPECT_EQ(json.at("text").get<std::string>(), text);
    EXPECT_EQ(json.at("event"), "e");
  }
}

TEST(LogJson, StaysJsonWhereATextIsNoUtf8) {
  const auto json =
      nlohmann::json::parse(json_of_fields("text=" + log_value("a \xff\xc3 b") + " n=1"));
  EXPECT_EQ(json.at("text"), "a \xef\xbf\xbd\xef\xbf\xbd b");
  EXPECT_EQ(json.at("n"), 1);
}

TEST(LogJson, KeepsALineThatIsNotKeysAndValues) {
  for (const char* line : {"no keys here", "a=1 b", "a=\"open", "=1", "a=\"x\"y", "a=\"\\q\""}) {
    const auto json = nlohmann::json::parse(json_of_fields(line));
    EXPECT_EQ(json.at("message"), line);
  }
}

}  // namespace
}  // namespace weft::server
