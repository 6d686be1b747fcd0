// SPDX-License-Identifier: Apache-2.0
// The engine as a whole gives the bytes that digests.txt has, on every machine and with every
// compiler: meshes of all models, and of 900 random requests, as the fuzzer makes them. With
// WEFT_ANEW=FILE it adds what it gives to FILE, the next digests.txt after a change that is meant
// to change meshes.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/fuzz/mesh_case.h"
#include "tests/support/generator.h"
#include "tests/support/poly.h"
#include "weft/weft.h"

namespace weft {
namespace {

struct NoSink : ChunkSink {
  bool accept(Chunk&&) override { return true; }
};

// The digest, or the error.
std::string outcome(const MeshRequest& request, const Budget& budget) {
  NoSink sink;
  Run run(budget);
  const auto summary = stream(request, sink, run);
  if (!summary)
    return "error " + std::to_string(static_cast<int>(summary.error().code)) + " of " +
           (summary.error().field.empty() ? "-" : summary.error().field);
  std::string hex;
  for (const unsigned byte : summary->digest) {
    constexpr char kDigits[] = "0123456789abcdef";
    hex += {kDigits[byte >> 4], kDigits[byte & 15]};
  }
  return hex;
}

using Outcomes = std::vector<std::pair<std::string, std::string>>;

// What is asked of a model. Lengths are shares of its extent.
struct Wish {
  const char* name;
  void (*ask)(MeshRequest&, double extent);
};

constexpr Wish kWishes[] = {
    {"plain", [](MeshRequest&, double) {}},
    {"constant", [](MeshRequest& r, double e) { r.size = 1e-4 * e * e; }},
    {"circumcentre",
     [](MeshRequest& r, double e) {
       r.size = 2e-4 * e * e;
       r.placement = Placement::kCircumcentre;
       r.min_angle_deg = 30;
     }},
    {"functions",
     [](MeshRequest& r, double e) {
       const std::string u = "(x/" + std::to_string(e) + ")";
       const std::string v = "(y/" + std::to_string(e) + ")";
       r.size = std::to_string(2e-4 * e * e) + "*(1.2+0.3*sin(7*" + u + ")*cos(5*" + v +
                ")+0.1*tan(" + u + "/9)+0.1*exp(-" + v + "^2)+0.1*log(9+" + u + "^2)+0.1*atan2(" +
                v + "," + u + "-3)+0.1*hypot(" + u + "," + v + ")+0.1*(2+" + u +
                "^2)^1.7+0.1*sqrt(1+" + v + "^2)+0.01*floor(5*" + u + ")+min(" + u + "^2," + v +
                "^2))";
     }},
    {"distance",
     [](MeshRequest& r, double e) {
       r.size = std::to_string(0.01 * e) + "+0.2*d";
       r.size.measure = Measure::kEdge;
       r.size.fields = {{.name = "d", .kind = DistanceSpec{}}};
     }},
    {"width",
     [](MeshRequest& r, double e) {
       r.size = std::to_string(0.003 * e) + "+0.2*w";
       r.size.measure = Measure::kEdge;
       r.size.fields = {{.name = "w", .kind = WidthSpec{}}};
     }},
    {"graded",
     [](MeshRequest& r, double e) {
       r.size.gradation = 0.3;
       r.size.points_per_circle = 24;
       r.sweeps = 3;
       r.size.value = 4e-3 * e * e;
     }},
    {"simplified",
     [](MeshRequest& r, double e) {
       r.size = 5e-4 * e * e;
       r.simplify = 0.4;
     }},
    {"tasks",
     [](MeshRequest& r, double e) {
       r.size = 4e-5 * e * e;
       r.leaf_triangles = 200;
     }},
};

// Of a model, or of random requests.
Outcomes outcomes_of(const std::string& what) {
  constexpr std::pair<const char*, double> kModels[] = {
      {"cylinder", 65}, {"key", 100}, {"pipe", 390}, {"coast", 20}};
  constexpr std::uint32_t kCases = 180;
  Outcomes outcomes;
  for (const auto& [name, extent] : kModels) {
    if (what != name) continue;
    MeshRequest request{
        .pslg = read_poly(model(what == "coast" ? "us-east-coast.poly" : what + ".poly"))};
    request.allow_unrefined = true;
    for (const Wish& wish : kWishes) {
      MeshRequest asked = request;
      wish.ask(asked, extent);
      outcomes.emplace_back(what + "-" + wish.name, outcome(asked, {}));
    }
    return outcomes;
  }
  Generator random(what.back());
  for (std::uint32_t i = 0; i < kCases; ++i) {
    std::uint8_t bytes[256];
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.below(256));
    fuzz::MeshCase made = fuzz::decode_mesh_case(fuzz::ByteSource(bytes, sizeof bytes));
    made.request.allow_unrefined = true;
    outcomes.emplace_back(what + "-" + std::to_string(i), outcome(made.request, made.budget));
  }
  return outcomes;
}

class MeshDigests : public testing::TestWithParam<const char*> {};

TEST_P(MeshDigests, AreTheRecordedOnesOnEveryMachine) {
  std::map<std::string, std::string> recorded;
  std::ifstream file(WEFT_DIGESTS);
  for (std::string name, what; file >> name && std::getline(file >> std::ws, what);)
    recorded[name] = what;
  std::string text;
  for (const auto& [name, what] : outcomes_of(GetParam())) {
    EXPECT_EQ(what, recorded[name]) << name;
    text += name + " " + what + "\n";
  }
  if (const char* const anew = std::getenv("WEFT_ANEW")) std::ofstream(anew, std::ios::app) << text;
}

INSTANTIATE_TEST_SUITE_P(Of, MeshDigests,
                         testing::Values("cylinder", "key", "pipe", "coast", "random1", "random2",
                                         "random3", "random4", "random5"),
                         [](const auto& of) { return std::string(of.param); });

}  // namespace
}  // namespace weft
