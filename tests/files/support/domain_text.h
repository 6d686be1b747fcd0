// SPDX-License-Identifier: Apache-2.0
// What a reader of domains makes of a text in a file.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "files/formats/domain_formats.h"
#include "tests/files/support/temp_folder.h"

namespace weft::files {

class DomainText : public ::testing::Test {
 protected:
  // `name`: of the file; its extension is that of the format.
  explicit DomainText(std::string name) : name_(std::move(name)) {}

  Domain read(const std::string& text) { return read(text, name_); }
  Domain read(const std::string& text, const std::string& name) {
    const auto domain = read_domain(folder_.write(name, text));
    EXPECT_TRUE(domain) << domain.error().message << " of\n" << text;
    return domain ? *domain : Domain{};
  }
  // Messages begin with the name of the file.
  std::string refusal(const std::string& text) {
    const auto domain = read_domain(folder_.write(name_, text));
    if (domain) return "it was read";
    EXPECT_EQ(domain.error().exit, ExitCode::kUnreadableInput);
    return domain.error().message.substr(folder_.path().string().size() + 1);
  }
  std::vector<std::string> warnings(const std::string& text) { return warnings(text, name_); }
  std::vector<std::string> warnings(const std::string& text, const std::string& name) {
    std::vector<std::string> out;
    for (const std::string& warning : sentences(read(text, name).warnings))
      out.push_back(warning.substr(folder_.path().string().size() + 1));
    return out;
  }

  TempFolder folder_;

 private:
  const std::string name_;
};

}  // namespace weft::files
