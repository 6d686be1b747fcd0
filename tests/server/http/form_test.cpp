// SPDX-License-Identifier: Apache-2.0
#include "server/http/form.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace weft::server {
namespace {

constexpr std::string_view kType = "multipart/form-data; boundary=\"--x\"";

std::string fault(std::string_view body, std::string_view type = kType) {
  const auto parts = parts_of(type, body);
  return parts ? "none" : parts.error();
}

TEST(Form, IsWhatItsContentTypeSays) {
  EXPECT_TRUE(is_form("multipart/form-data; boundary=x"));
  EXPECT_TRUE(is_form("Multipart/Form-Data;boundary=x"));
  EXPECT_TRUE(is_form("multipart/form-data ; boundary=x"));
  for (const char* type : {"", "multipart/form-dat", "multipart/mixed; boundary=x", "text/csv"})
    EXPECT_FALSE(is_form(type)) << type;
}

TEST(Form, HasFilesAndTexts) {
  constexpr std::string_view kBody =
      "a preamble\r\n"
      "----x\r\n"
      "Content-Disposition: form-data; name=\"domain\"; filename=\"a \\\"b\\\".csv\"\r\n"
      "content-type:  text/csv\r\n"
      "\r\n"
      "0,0\r\n--y\r\n\r\n"
      "----x \t\r\n"
      "Content-Disposition: form-data; name=edge\r\n"
      "\r\n"
      "0.1+x\r\n"
      "----x--\r\n"
      "an epilogue";
  const auto parts = parts_of(kType, kBody);
  ASSERT_TRUE(parts) << parts.error();
  ASSERT_EQ(parts->size(), 2u);
  EXPECT_EQ(parts->front().name, "domain");
  EXPECT_EQ(parts->front().filename, "a \"b\".csv");
  EXPECT_EQ(parts->front().content_type, "text/csv");
  EXPECT_EQ(parts->front().body, "0,0\r\n--y\r\n");
  EXPECT_EQ(parts->back().name, "edge");
  EXPECT_EQ(parts->back().filename, std::nullopt);
  EXPECT_EQ(parts->back().body, "0.1+x");
}

TEST(Form, MayBeginWithItsBoundaryAndHaveEmptyParts) {
  const auto parts =
      parts_of("multipart/form-data; boundary=x",
               "--x\r\nContent-Disposition: form-data; name=\"lonlat\"\r\n\r\n\r\n--x--");
  ASSERT_TRUE(parts) << parts.error();
  EXPECT_EQ(parts->at(0).body, "");
  EXPECT_TRUE(parts_of("multipart/form-data; boundary=x", "--x--").value().empty());
}

TEST(Form, WithAFaultSaysWhatIsWrong) {
  const std::string part = "----x\r\nContent-Disposition: form-data; name=a\r\n\r\nb\r\n";
  EXPECT_EQ(fault(part + "----x--"), "none");
  EXPECT_EQ(fault(part, "multipart/form-data"),
            "Content-Type names no boundary of the form's parts");
  EXPECT_EQ(fault(""), "the form ends within a part");
  EXPECT_EQ(fault(part), "the form ends within a part");
  EXPECT_EQ(fault(part + "----xy\r\n"), "a boundary of the form goes on");
  EXPECT_EQ(fault("----x\r\nContent-Disposition: form-data; filename=b\r\n\r\n\r\n----x--"),
            "a part of the form has no name");
  EXPECT_EQ(fault("----x\r\nContent-Type: text/csv\r\n----x--"), "a part of the form has no body");
  EXPECT_EQ(fault("----x\r\n----x--"), "a part of the form has no body");
  EXPECT_EQ(fault("----x\r\n" + part + "----x--"), "a part of the form has no body");
  std::string many;
  for (int i = 0; i < 101; ++i) many += part;
  EXPECT_EQ(fault(many + "----x--"), "the form has more than 100 parts");
}

}  // namespace
}  // namespace weft::server
