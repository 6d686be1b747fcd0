// SPDX-License-Identifier: Apache-2.0
// The engine against the checker, on PSLGs of mesh_case.h. Asserts:
//   checker-RULE    the independent checker finds nothing against the mesh, nor does its summary;
//                   plain-RULE of a case without jitter, where no tolerance is in question; of a
//                   contested case (features.h), only what the mesh is by itself; sizes by the
//                   local width, which the checker cannot tell, are left out
//   internal        no error is kInternal: whatever else is wrong with a case has a name
//   bounds          up to 30 degrees, every triangle that misses a bound has an excuse: whatever is
//                   too near for double precision is merged, all else is refined, unless the case
//                   is too fine for that (features.h)
//   threads         one thread and three give the same bytes, or the same error; without
//                   allow_unrefined, kBoundsNotMet stands for what has no excuse
//   explosion       a domain of a few points on a coarse grid without a size, whose features are
//                   all far apart, has not thousands of triangles
// A case that is refused, or that reaches its limit of triangles, is in order.
#include <algorithm>
#include <cstdint>
#include <string>
#include <variant>

#include "tests/fuzz/features.h"
#include "tests/fuzz/law.h"
#include "tests/fuzz/mesh_case.h"
#include "tests/support/collected_mesh.h"

namespace weft::fuzz {
namespace {

constexpr int kThreads = 3;

struct Outcome {
  Result<Summary> summary;
  CollectedMesh mesh;
};

Outcome generate(const MeshCase& made, Arena* arena, bool allow_unrefined) {
  ExecutionContext context(made.budget);
  if (arena != nullptr) context.set_arena(*arena, kThreads);
  CollectedMesh mesh;
  MeshRequest request = made.request;
  request.allow_unrefined = allow_unrefined;
  Result<Summary> summary = generate_mesh(request, mesh, context);
  return {std::move(summary), std::move(mesh)};
}

std::string name_of(const Result<Summary>& summary) {
  if (summary) return "a mesh of " + std::to_string(summary->triangles) + " triangles";
  return "error " + std::to_string(static_cast<int>(summary.error().code)) + ", " +
         summary.error().field + ": " + summary.error().message;
}

bool same(const Result<Summary>& a, const Result<Summary>& b) {
  if (a.has_value() != b.has_value()) return false;
  if (a) return a->digest == b->digest && a->vertices == b->vertices;
  return a.error().code == b.error().code && a.error().field == b.error().field;
}

// "chains" of "chains: segment 3 has a gap": the first line that begins with a rule.
std::string law_of(const MeshCase& made, const std::string& verdict) {
  const std::string judge = made.plain ? "plain-" : "checker-";
  for (std::size_t r = 0; r < check::kRules; ++r) {
    const std::string name(check::rule_name(static_cast<check::Rule>(r)));
    if (verdict.find("\n" + name + ":") != std::string::npos) return judge + name;
  }
  return judge + "summary";
}

// Whether the checker found nothing but that the mesh does not fit the domain.
bool is_of_the_domain(const std::string& verdict) {
  using check::Rule;
  if (verdict.find("\nthe summary") != std::string::npos ||
      verdict.compare(0, 11, "the summary") == 0)
    return false;
  for (const Rule rule :
       {Rule::kStructure, Rule::kOrientation, Rule::kConformity, Rule::kOverlap, Rule::kDelaunay})
    if (verdict.find("\n" + std::string(rule_name(rule)) + ":") != std::string::npos) return false;
  return true;
}

// The checker's verdict, but for sizes by the local width: then no bound on areas is judged,
// because the least number of triangles is that of all of them.
std::string verdict_on(const MeshRequest& request, const CollectedMesh& mesh,
                       const Summary& summary) {
  const auto is_width = [](const FieldSpec& field) {
    return std::holds_alternative<WidthSpec>(field.kind);
  };
  const SizeSpec& size = request.size;
  if (size.cells_across == 0 && std::none_of(size.fields.begin(), size.fields.end(), is_width))
    return verdict(request, mesh, summary);
  MeshRequest without_size = request;
  without_size.size = {};
  for (RegionSeed& region : without_size.pslg.regions) region.max_area.reset();
  Summary of_it = summary;
  of_it.ideal_ratio = 0;
  return verdict(without_size, mesh, of_it);
}

void judge(const std::uint8_t* data, std::size_t size) {
  const MeshCase made = decode_mesh_case(ByteSource(data, size));
  const auto must = [&](bool holds, const std::string& law, const std::string& evidence) {
    if (!holds) broken(law, evidence + "\n" + to_text(made), data, size);
  };
  const Outcome one = generate(made, nullptr, true);
  const bool excused = !one.summary || one.summary->unrefined.without_excuse() == 0;
  if (one.summary) {
    const std::string wrong = verdict_on(made.request, one.mesh, *one.summary);
    must(wrong.empty() || (is_of_the_domain(wrong) && is_contested(made)), law_of(made, wrong),
         wrong);
    must(excused || made.request.min_angle_deg > 30 || is_too_fine(made), "bounds",
         std::to_string(one.summary->unrefined.without_excuse()) + " of " + name_of(one.summary));
  } else {
    const Error& error = one.summary.error();
    must(error.code != ErrorCode::kInternal, "internal", error.message);
    const bool endless = error.code == ErrorCode::kLimitExceeded && made.plain &&
                         std::holds_alternative<std::monostate>(made.request.size.value) &&
                         made.request.size.cells_across == 0 && made.request.size.at.empty() &&
                         made.request.min_angle_deg <= 25;
    must(!endless, "explosion", error.message);
  }
  // The arena is never freed: its threads would have to be waited for as the process ends.
  static Arena& arena = *new Arena(kThreads);
  const Outcome three = generate(made, &arena, false);
  const bool alike = excused
                         ? same(one.summary, three.summary)
                         : !three.summary && three.summary.error().code == ErrorCode::kBoundsNotMet;
  must(alike, "threads",
       "one thread: " + name_of(one.summary) + "\nthree: " + name_of(three.summary));
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  weft::fuzz::judge(data, size);
  return 0;
}
