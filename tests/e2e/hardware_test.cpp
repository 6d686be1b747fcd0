// SPDX-License-Identifier: Apache-2.0
// The mesh does not depend on what the processor can do: libm and OpenSSL choose their code by it,
// and are told here to believe in an old one.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <nlohmann/json.hpp>

#include "tests/e2e/programs.h"

namespace weft::e2e {
namespace {

// An environment variable of this process, and so of those that it starts, while this lives.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) { setenv(name, value, 1); }
  ~Environment() { unsetenv(name_); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
};

std::string digest(const char* name, const std::string& size) {
  const Folder folder;
  const Outcome mesh = run_weft(
      {"mesh", model(name), "-o", folder / "mesh.vtu", "--size", size, "--json", "--quiet"});
  EXPECT_EQ(mesh.exit_code, 0) << mesh.err;
  if (mesh.exit_code != 0) return "";
  return nlohmann::json::parse(mesh.out).at("digest").get<std::string>();
}

// The functions whose last bit libm gets differently with and without FMA.
struct Case {
  const char* name;
  const char* model;
  const char* size;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

class Hardware : public ::testing::TestWithParam<Case> {};

TEST_P(Hardware, WithoutAvx2AndFmaGivesTheSameMesh) {
  const Case& c = GetParam();
  const std::string here = digest(c.model, c.size);
  const Environment libm("GLIBC_TUNABLES",
                         "glibc.cpu.hwcaps=-AVX2_Usable,-FMA_Usable,-AVX2,-FMA,-AVX512F");
  // No AVX, no SHA extensions, no AVX2, no BMI: OpenSSL's plain code.
  const Environment openssl("OPENSSL_ia32cap", "~0x1000000000000000:~0x20000128");
  EXPECT_EQ(digest(c.model, c.size), here);
}

INSTANTIATE_TEST_SUITE_P(
    On, Hardware,
    ::testing::Values(Case{"Cylinder", "cylinder.poly",
                           "(x>=0 && abs(y)<5) || (x<0 && x^2+y^2<25) ? 6e-3 : 5e-2"},
                      Case{"Pipe", "pipe.poly",
                           "2+sin(x)^2+exp(-abs(y)/100)+0.01*(abs(x)+1)^0.7+cos(x*y)"},
                      Case{"Coast", "us-east-coast.poly", "1e-2*(1.5+sin(x)*cos(y))"}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace weft::e2e
