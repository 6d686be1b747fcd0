// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/vertex_values.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "files/base/did_you_mean.h"
#include "files/base/text.h"
#include "files/formats/derived/middles.h"

namespace weft::files {
namespace {

// "'a', 'b' and 'c'"
std::string listed(const std::vector<std::string>& arrays) {
  constexpr std::size_t kMax = 16;
  const std::size_t shown = std::min(arrays.size(), kMax);
  std::string list;
  for (std::size_t i = 0; i < shown; ++i) {
    if (i > 0) list += i + 1 == arrays.size() ? " and " : ", ";
    list += in_quotes(arrays[i]);
  }
  if (shown < arrays.size()) list += " and " + std::to_string(arrays.size() - shown) + " more";
  return list;
}

}  // namespace

Result<std::vector<std::string>> chosen_arrays(const std::filesystem::path& path,
                                               std::vector<std::string> arrays,
                                               const std::optional<std::string>& wanted) {
  if (!wanted) return arrays;
  const auto refuse = [&path](const std::string& why) {
    return fail(ExitCode::kUnreadableInput, path.string() + ": " + why);
  };
  if (arrays.empty()) return refuse("has no values at its vertices");
  if (wanted->empty()) {
    if (arrays.size() == 1) return arrays;
    return refuse("has several arrays of values at its vertices, name one: " + listed(arrays));
  }
  if (std::find(arrays.begin(), arrays.end(), *wanted) != arrays.end())
    return std::vector<std::string>{*wanted};
  const std::string meant = did_you_mean(*wanted, arrays);
  return refuse("has no array " + in_quotes(*wanted) + " of values at its vertices, but " +
                listed(arrays) + (meant.empty() ? "" : "; " + meant));
}

MeshWithArrays with_bed_column(Mesh mesh, const std::string& name, std::vector<double> values,
                               const std::optional<std::string>& wanted) {
  MeshWithArrays all{std::move(mesh), {}};
  const auto is_known = [](double value) { return value != 0; };
  if (wanted || std::any_of(values.begin(), values.end(), is_known))
    all.arrays.push_back({name, std::move(values)});
  return all;
}

Result<std::vector<double>> checked(const std::filesystem::path& path, const std::string& name,
                                    Result<std::vector<double>> values, const Mesh& mesh) {
  if (!values) return values;
  const auto refuse = [&path](const std::string& why) {
    return fail(ExitCode::kUnreadableInput, path.string() + ": " + why);
  };
  const std::size_t vertices = mesh.coordinates.size() / 2;
  *values = at_vertices(mesh, std::move(*values));
  if (values->size() != vertices)
    return refuse("the array " + in_quotes(name) + " has " + std::to_string(values->size()) +
                  " values for " + std::to_string(vertices) + " vertices");
  const auto infinite =
      std::find_if(values->begin(), values->end(), [](double value) { return std::isinf(value); });
  if (infinite != values->end())
    return refuse("the array " + in_quotes(name) + " is infinite at vertex " +
                  std::to_string(infinite - values->begin()));
  return values;
}

}  // namespace weft::files
