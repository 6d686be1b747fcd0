// SPDX-License-Identifier: Apache-2.0
// The engine against the checker, on PSLGs of mesh_case.h. Asserts:
//   checker-RULE    the independent checker finds nothing against the mesh, nor does its summary;
//                   plain-RULE of a case without jitter, where no tolerance is in question; of a
//                   contested case (features.h), only what the mesh is by itself; sizes by the
//                   local width, which the checker cannot tell, are left out
//   internal        no error is kInternal: whatever else is wrong with a case has a name
//   bounds          up to 30 degrees, every triangle that misses a bound is exempt: whatever is
//                   too near for double precision is merged, all else is refined, unless the case
//                   is too fine for that (features.h)
//   threads         one thread and three give the same bytes, or the same error; without
//                   allow_unrefined, kBoundsNotMet stands for what is not exempt; three may
//                   take more memory
//   explosion       a domain of a few points on a coarse grid without a size, whose features are
//                   all far apart, has not thousands of triangles
// A case that is refused, or that reaches its limit of triangles, is in order.
#include <algorithm>
#include <cstdint>
#include <string>
#include <variant>

#include "engine/engine.h"
#include "tests/fuzz/features.h"
#include "tests/fuzz/law.h"
#include "tests/fuzz/mesh_case.h"
#include "tests/support/collected_mesh.h"

namespace weft::fuzz {
namespace {

constexpr int kThreads = 3;

// The summary's digest tells what the chunks were.
struct NoSink : ChunkSink {
  bool accept(Chunk&&) override { return true; }
};

Result<Summary> generate(const MeshCase& made, bool allow_unrefined, ChunkSink& sink,
                         ExecutionContext& context) {
  MeshRequest request = made.request;
  request.allow_unrefined = allow_unrefined;
  return generate_mesh(request, sink, context);
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

// The checker's verdict, but for sizes by the local width, for those that are 0 somewhere, and
// where a field's mesh is ambiguous: then no bound on areas is judged, because the least number of
// triangles is that of all of them.
std::string verdict_on(const MeshCase& made, const CollectedMesh& mesh, const Summary& summary) {
  const MeshRequest& request = made.request;
  const auto is_any = [&](auto&& of_kind) {
    const auto& fields = request.size.fields;
    return std::any_of(fields.begin(), fields.end(), of_kind);
  };
  const bool has_width =
      is_any([](const FieldSpec& field) { return std::holds_alternative<WidthSpec>(field.kind); });
  if (request.size.cells_across == 0 && !asks_for_nothing(made) && !has_width) {
    std::string wrong = verdict(request, mesh, summary);
    if (wrong.empty() || !is_any([](const FieldSpec& field) {
          const auto* const of = std::get_if<FieldMesh>(&field.kind);
          return of != nullptr && is_ambiguous(*of);
        }))
      return wrong;
  }
  MeshRequest without_size = request;
  without_size.size = {};
  for (RegionSeed& region : without_size.pslg.regions) region.max_area.reset();
  Summary of_it = summary;
  of_it.ideal_ratio = 0;
  return verdict(without_size, mesh, of_it);
}

void judge(const std::uint8_t* data, std::size_t size, Arena& arena) {
  const MeshCase made = decode_mesh_case(ByteSource(data, size));
  const auto must = [&](bool holds, const std::string& law, const std::string& evidence) {
    if (!holds) broken(law, evidence + "\n" + to_text(made), data, size);
  };
  ExecutionContext on_one(made.budget);
  CollectedMesh mesh;
  const Result<Summary> one = generate(made, true, mesh, on_one);
  const bool exempt = !one || one->unrefined.without_exemption() == 0;
  if (one) {
    const std::string wrong = verdict_on(made, mesh, *one);
    must(wrong.empty() || (is_of_the_domain(wrong) && is_contested(made)), law_of(made, wrong),
         wrong);
    must(exempt || made.request.min_angle_deg > 30 || is_too_fine(made) || asks_for_nothing(made),
         "bounds", std::to_string(one->unrefined.without_exemption()) + " of " + name_of(one));
  } else {
    const Error& error = one.error();
    must(error.code != ErrorCode::kInternal, "internal", error.message);
    const bool endless = error.code == ErrorCode::kLimitExceeded && made.plain &&
                         std::holds_alternative<std::monostate>(made.request.size.value) &&
                         made.request.size.cells_across == 0 && made.request.size.at.empty() &&
                         made.request.min_angle_deg <= 25;
    must(!endless, "explosion", error.message);
  }
  // Three threads take more memory than one.
  Budget budget = made.budget;
  if (one || one.error().code != ErrorCode::kBudgetExceeded) budget.max_bytes = kMaxBytes;
  ExecutionContext on_three(budget);
  on_three.set_arena(arena, kThreads);
  NoSink no_sink;
  const Result<Summary> three = generate(made, false, no_sink, on_three);
  const bool alike =
      exempt ? same(one, three) : !three && three.error().code == ErrorCode::kBoundsNotMet;
  must(alike, "threads", "one thread: " + name_of(one) + "\nthree: " + name_of(three));
}

}  // namespace
}  // namespace weft::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace weft::fuzz;
  // The arena is never freed: its threads would have to be waited for as the process ends. All of a
  // case runs on one of them, because each step into the arena wakes threads that then look for
  // work for a while.
  static weft::Arena& arena = *new weft::Arena(kThreads);
  arena.run([&] { judge(data, size, arena); });
  return 0;
}
