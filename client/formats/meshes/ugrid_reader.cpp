// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "client/base/text.h"
#include "client/formats/files/file_contents.h"
#include "client/formats/files/netcdf_file.h"
#include "client/formats/mesh_formats.h"
#include "client/formats/meshes/ugrid.h"

namespace weft::client {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{64} << 30;

using Variable = NetcdfFile::Variable;
using Malformed = NetcdfFile::Malformed;

// The next word of a list whose words are divided by blanks; empty at the end.
std::string_view next_word(std::string_view& list) {
  list.remove_prefix(std::min(list.find_first_not_of(' '), list.size()));
  const std::string_view word = list.substr(0, list.find(' '));
  list.remove_prefix(word.size());
  return word;
}

class Reader {
 public:
  Reader(const std::filesystem::path& path, std::string_view bytes) : path_(path), file_(bytes) {}

  Result<Mesh> read() {
    const auto topology =
        std::find_if(file_.variables().begin(), file_.variables().end(), [](const auto& entry) {
          return entry.second.text("cf_role") == "mesh_topology" &&
                 entry.second.number("topology_dimension", 0) == 2;
        });
    if (topology == file_.variables().end())
      throw Malformed{"has no two-dimensional mesh of UGRID"};
    const auto& [name, mesh] = *topology;
    read_nodes(mesh);
    const Variable& faces = named(mesh, "face_node_connectivity");
    mesh_.triangles = connectivity(faces, 3);
    NameReader names(path_.string());
    if (const Variable* const regions = file_.find(name + "_region")) {
      mesh_.regions = numbers(*regions, mesh_.triangles.size() / 3);
      read_names(*regions, NameKind::kRegion, names);
    }
    if (const Variable* const parts = file_.find(name + "_part"))
      mesh_.parts = numbers(*parts, mesh_.triangles.size() / 3);
    if (const Variable* const markers = file_.find(name + "_edge_marker")) {
      read_edges(mesh, *markers);
      read_names(*markers, NameKind::kMarker, names);
    }
    mesh_.warnings = names.warnings();
    mesh_.names = names.take();
    return validated(path_, std::move(mesh_));
  }

 private:
  const Variable& variable(std::string_view name) const {
    const Variable* const found = file_.find(name);
    if (found == nullptr) throw Malformed{"has no variable " + in_quotes(name)};
    if (found->grows) throw Malformed{"variable " + in_quotes(name) + " has no fixed length"};
    return *found;
  }

  // The variable that an attribute of the mesh names.
  const Variable& named(const Variable& mesh, std::string_view attribute) const {
    const std::string_view name = mesh.text(attribute);
    if (name.empty()) throw Malformed{"its mesh has no attribute " + in_quotes(attribute)};
    return variable(name);
  }

  void read_nodes(const Variable& mesh) {
    std::string_view list = mesh.text("node_coordinates");
    const std::string_view x = next_word(list);
    const std::string_view y = next_word(list);
    const std::vector<double> xs = file_.reals(variable(x));
    const std::vector<double> ys = file_.reals(variable(y));
    if (xs.size() != ys.size()) throw Malformed{"its nodes have more x than y, or fewer"};
    mesh_.coordinates.reserve(2 * xs.size());
    for (std::size_t v = 0; v < xs.size(); ++v)
      mesh_.coordinates.insert(mesh_.coordinates.end(), {xs[v], ys[v]});
  }

  // Rows of `width` nodes, from 0. A wider row must end in fill values.
  std::vector<std::uint32_t> connectivity(const Variable& rows, std::size_t width) const {
    if (rows.shape.size() != 2 || rows.shape[1] < width)
      throw Malformed{"its faces or edges are no rows of " + std::to_string(width) + " nodes"};
    const auto start = static_cast<std::int64_t>(rows.number("start_index", 0) != 0);
    const double fill = rows.number("_FillValue", -1);
    const std::vector<std::int64_t> nodes = file_.integers(rows);
    std::vector<std::uint32_t> out;
    out.reserve(rows.shape[0] * width);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const bool inside = i % rows.shape[1] < width;
      const bool is_node = static_cast<double>(nodes[i]) != fill;
      const std::int64_t node = nodes[i] - start;
      if (inside != is_node ||
          (inside && (node < 0 || node > std::numeric_limits<std::uint32_t>::max())))
        throw Malformed{"row " + std::to_string(i / rows.shape[1]) +
                        " of its faces or edges has not " + std::to_string(width) + " nodes"};
      if (inside) out.push_back(static_cast<std::uint32_t>(node));
    }
    return out;
  }

  std::vector<std::int32_t> numbers(const Variable& variable, std::size_t count) const {
    const std::vector<std::int64_t> all = file_.integers(variable);
    if (all.size() != count)
      throw Malformed{"has " + std::to_string(all.size()) + " regions, markers or parts for " +
                      std::to_string(count) + " faces or edges"};
    std::vector<std::int32_t> out;
    out.reserve(count);
    for (const std::int64_t value : all) {
      if (!std::in_range<std::int32_t>(value))
        throw Malformed{"has the region, marker or part " + std::to_string(value) +
                        ", which has no 32 bits"};
      out.push_back(static_cast<std::int32_t>(value));
    }
    return out;
  }

  void read_edges(const Variable& mesh, const Variable& markers) {
    const std::vector<std::uint32_t> edges = connectivity(named(mesh, "edge_node_connectivity"), 2);
    const std::vector<std::int32_t> all = numbers(markers, edges.size() / 2);
    for (std::size_t e = 0; e < all.size(); ++e) {
      if (all[e] == 0) continue;
      mesh_.edges.insert(mesh_.edges.end(), {edges[2 * e], edges[2 * e + 1]});
      mesh_.edge_markers.push_back(all[e]);
    }
  }

  static void read_names(const Variable& variable, NameKind kind, NameReader& names) {
    const auto values = variable.attributes.find("flag_values");
    if (values == variable.attributes.end()) return;
    std::string_view meanings = variable.text("flag_meanings");
    for (const double value : values->second.numbers) {
      const std::string_view name = next_word(meanings);
      if (name.empty()) return;
      constexpr double kMost = std::numeric_limits<std::int32_t>::max();
      if (value >= -kMost - 1 && value <= kMost)
        names.add(kind, static_cast<std::int32_t>(value), name);
    }
  }

  const std::filesystem::path& path_;
  NetcdfFile file_;
  Mesh mesh_;
};

}  // namespace

Result<Mesh> read_ugrid(const std::filesystem::path& path) {
  const auto contents = read_file(path, kMaxFileBytes);
  if (!contents) return tl::unexpected(contents.error());
  try {
    return Reader(path, contents->text()).read();
  } catch (const Malformed& malformed) {
    return fail(ExitCode::kUnreadableInput, path.string() + ": " + malformed.why);
  }
}

}  // namespace weft::client
