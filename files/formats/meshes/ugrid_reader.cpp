// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/netcdf_file.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/meshes/ugrid.h"

namespace weft::files {
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
    const auto& [name, mesh] = topology();
    read_nodes(mesh);
    read_faces(name, named(mesh, "face_node_connectivity"));
    NameReader names(path_.string());
    if (const Variable* const regions = file_.find(name + "_region"))
      read_names(*regions, NameKind::kRegion, names);
    if (const Variable* const markers = file_.find(name + "_edge_marker")) {
      read_edges(mesh, *markers);
      read_names(*markers, NameKind::kMarker, names);
    }
    mesh_.warnings = names.warnings();
    mesh_.names = names.take();
    return validated(path_, std::move(mesh_));
  }

  Result<MeshWithArrays> read_values(const std::optional<std::string>& wanted) {
    const std::map<std::string, const Variable*> all = values_at_nodes();
    std::vector<std::string> names;
    for (const auto& [name, variable] : all) names.push_back(name);
    const auto chosen = chosen_arrays(path_, std::move(names), wanted);
    if (!chosen) return tl::unexpected(chosen.error());
    MeshWithArrays out;
    for (const std::string& name : *chosen) out.arrays.push_back({name, values_of(*all.at(name))});
    auto mesh = read();
    if (!mesh) return tl::unexpected(mesh.error());
    out.mesh = std::move(*mesh);
    return out;
  }

 private:
  const std::pair<const std::string, Variable>& topology() const {
    const auto topology =
        std::find_if(file_.variables().begin(), file_.variables().end(), [](const auto& entry) {
          return entry.second.text("cf_role") == "mesh_topology" &&
                 entry.second.number("topology_dimension", 0) == 2;
        });
    if (topology == file_.variables().end())
      throw Malformed{"has no two-dimensional mesh of UGRID"};
    return *topology;
  }

  // The variables with a number at each node, by their names without that of the mesh. The bed is
  // called as bed.h has it.
  std::map<std::string, const Variable*> values_at_nodes() const {
    const auto& [mesh_name, mesh] = topology();
    std::string_view axes = mesh.text("node_coordinates");
    const std::string_view x = next_word(axes);
    const std::string_view y = next_word(axes);
    const std::vector<std::uint64_t>& shape = variable(x).shape;
    std::map<std::string, const Variable*> found;
    const Variable* bed = nullptr;
    for (const auto& [name, values] : file_.variables()) {
      if (name == x || name == y || values.grows || values.shape != shape ||
          values.text("mesh") != mesh_name || values.text("location") != "node")
        continue;
      if (name == mesh_name + "_node_z")
        bed = &values;
      else
        found.emplace(name.starts_with(mesh_name + "_") ? name.substr(mesh_name.size() + 1) : name,
                      &values);
    }
    if (bed != nullptr && !found.contains("depth") && !found.contains("elevation"))
      found.emplace(bed->text("positive") == "down" ? "depth" : "elevation", bed);
    return found;
  }

  Result<std::vector<double>> values_of(const Variable& variable) const {
    std::vector<double> values = file_.reals(variable);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const double fill = variable.number("_FillValue", kNone);
    std::replace(values.begin(), values.end(), fill, kNone);
    return values;
  }

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

  // Rows of three nodes or more; those that have fewer than the widest end in fill values.
  void read_faces(const std::string& mesh, const Variable& rows) {
    if (rows.shape.size() != 2) throw Malformed{"its faces are no rows of nodes"};
    const auto optional_numbers = [&](const char* what) {
      const Variable* const found = file_.find(mesh + what);
      return found == nullptr ? std::vector<std::int32_t>{} : numbers(*found, rows.shape[0]);
    };
    const std::vector<std::int32_t> regions = optional_numbers("_region");
    const std::vector<std::int32_t> parts = optional_numbers("_part");
    const auto start = static_cast<std::int64_t>(rows.number("start_index", 0) != 0);
    const double fill = rows.number("_FillValue", -1);
    const std::vector<std::int64_t> nodes = file_.integers(rows);
    std::vector<std::uint32_t> face;
    for (std::size_t row = 0; row < rows.shape[0]; ++row) {
      const auto bad = [row] {
        return Malformed{"row " + std::to_string(row) +
                         " of its faces has not three nodes or more, and fill values after them"};
      };
      face.clear();
      for (std::size_t k = 0; k < rows.shape[1]; ++k) {
        const std::int64_t value = nodes[row * rows.shape[1] + k];
        if (static_cast<double>(value) == fill) continue;
        const std::int64_t node = value - start;
        if (face.size() < k || node < 0 || node > std::numeric_limits<std::uint32_t>::max())
          throw bad();
        face.push_back(static_cast<std::uint32_t>(node));
      }
      if (face.size() < 3) throw bad();
      const bool is_triangle = face.size() == 3;
      if (is_triangle) {
        mesh_.triangles.insert(mesh_.triangles.end(), face.begin(), face.end());
        mesh_.regions.push_back(regions.empty() ? 0 : regions[row]);
      } else {
        mesh_.faces.add(face, regions.empty() ? 0 : regions[row]);
      }
      if (!parts.empty()) (is_triangle ? mesh_.parts : mesh_.faces.parts).push_back(parts[row]);
    }
  }

  // Rows of two nodes, from 0.
  std::vector<std::uint32_t> edge_nodes(const Variable& rows) const {
    if (rows.shape.size() != 2 || rows.shape[1] != 2)
      throw Malformed{"its edges are no rows of 2 nodes"};
    const auto start = static_cast<std::int64_t>(rows.number("start_index", 0) != 0);
    std::vector<std::uint32_t> out;
    for (const std::int64_t value : file_.integers(rows)) {
      if (value < start || value - start > std::numeric_limits<std::uint32_t>::max())
        throw Malformed{"row " + std::to_string(out.size() / 2) + " of its edges has not 2 nodes"};
      out.push_back(static_cast<std::uint32_t>(value - start));
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
    const std::vector<std::uint32_t> edges = edge_nodes(named(mesh, "edge_node_connectivity"));
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
      constexpr double kMax = std::numeric_limits<std::int32_t>::max();
      if (value >= -kMax - 1 && value <= kMax)
        names.add(kind, static_cast<std::int32_t>(value), name);
    }
  }

  const std::filesystem::path& path_;
  NetcdfFile file_;
  Mesh mesh_;
};

template <class T, class Read>
Result<T> read_file_by(const std::filesystem::path& path, const Read& read) {
  const auto contents = read_file(path, kMaxFileBytes);
  if (!contents) return tl::unexpected(contents.error());
  try {
    return read(Reader(path, contents->text()));
  } catch (const Malformed& malformed) {
    return fail(ExitCode::kUnreadableInput, path.string() + ": " + malformed.why);
  }
}

}  // namespace

Result<Mesh> read_ugrid(const std::filesystem::path& path) {
  return read_file_by<Mesh>(path, [](Reader reader) { return reader.read(); });
}

Result<MeshWithArrays> read_ugrid_values(const std::filesystem::path& path,
                                         const std::optional<std::string>& wanted) {
  return read_file_by<MeshWithArrays>(path,
                                      [&](Reader reader) { return reader.read_values(wanted); });
}

}  // namespace weft::files
