// SPDX-License-Identifier: Apache-2.0
#include "client/batch/manifest.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "client/base/text.h"
#include "client/drawing/draw.h"
#include "client/formats/domain_formats.h"
#include "client/formats/mesh_formats.h"

namespace weft::client {
namespace {

// What is wrong, and where; only `read_manifest` sees it.
struct Wrong {
  YAML::Mark where;
  std::string what;
};

template <class T>
T scalar(const YAML::Node& node, const std::string& key, const char* what) {
  T value{};
  if (!node.IsScalar() || !YAML::convert<T>::decode(node, value))
    throw Wrong{node.Mark(), key + ": " +
                                 (node.IsScalar() ? in_quotes(node.Scalar()) : "a list or a map") +
                                 " is not " + what};
  return value;
}

std::string text_of(const YAML::Node& node, const std::string& key) {
  return scalar<std::string>(node, key, "a text");
}

double number_of(const YAML::Node& node, const std::string& key) {
  return scalar<double>(node, key, "a number");
}

// One path, or a list of them.
std::vector<std::filesystem::path> paths_of(const YAML::Node& node, const std::string& key,
                                            const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  if (!node.IsSequence()) return {folder / text_of(node, key)};
  for (const YAML::Node& one : node) paths.push_back(folder / text_of(one, key));
  return paths;
}

DrawColor color_of(const YAML::Node& node) {
  const std::string name = text_of(node, "color");
  if (name == "none") return DrawColor::kNone;
  if (name == "angle") return DrawColor::kAngle;
  if (name == "region") return DrawColor::kRegion;
  throw Wrong{node.Mark(), "color: " + in_quotes(name) + " is not angle, region or none"};
}

v1::Placement placement_of(const YAML::Node& node) {
  const std::string name = text_of(node, "placement");
  if (name == "lattice") return v1::PLACEMENT_LATTICE;
  if (name == "circumcentre") return v1::PLACEMENT_CIRCUMCENTRE;
  throw Wrong{node.Mark(), "placement: " + in_quotes(name) + " is not lattice or circumcentre"};
}

void require(const YAML::Node& node, std::vector<QualityGate>& gates) {
  if (!node.IsMap()) throw Wrong{node.Mark(), "require: not a map of figures to bounds"};
  for (const auto& entry : node) {
    auto gate =
        QualityGate::make(text_of(entry.first, "require"), text_of(entry.second, "require"));
    if (!gate) throw Wrong{entry.first.Mark(), "require: " + gate.error().message};
    // A mesh's own bound stands in for that of the defaults.
    std::erase_if(gates, [&](const QualityGate& g) { return g.figure() == gate->figure(); });
    gates.push_back(std::move(*gate));
  }
}

using Setter =
    std::function<void(const YAML::Node&, BatchMesh&, const std::filesystem::path& folder)>;

// The keys that defaults may have, too.
const std::map<std::string, Setter>& common_keys() {
  static const std::map<std::string, Setter> keys = {
      {"size",
       [](const auto& n, auto& m, const auto& folder) {
         m.request_options.size = text_of(n, "size");
         if (is_size_grid_path(m.request_options.size))
           m.request_options.size = folder / m.request_options.size;
       }},
      {"min-angle",
       [](const auto& n, auto& m, const auto&) {
         m.request_options.min_angle_deg = number_of(n, "min-angle");
       }},
      {"min-edge", [](const auto& n, auto& m,
                      const auto&) { m.request_options.min_edge = number_of(n, "min-edge"); }},
      {"placement",
       [](const auto& n, auto& m, const auto&) { m.request_options.placement = placement_of(n); }},
      {"optimise",
       [](const auto& n, auto& m, const auto&) {
         m.request_options.optimise = scalar<std::uint32_t>(n, "optimise", "a count of sweeps");
       }},
      {"snap",
       [](const auto& n, auto& m, const auto&) { m.request_options.snap = number_of(n, "snap"); }},
      {"allow-unrefined",
       [](const auto& n, auto& m, const auto&) {
         m.request_options.allow_unrefined = scalar<bool>(n, "allow-unrefined", "true or false");
       }},
      {"max-triangles",
       [](const auto& n, auto& m, const auto&) {
         m.request_options.max_triangles = scalar<std::uint64_t>(n, "max-triangles", "a count");
       }},
      {"max-seconds",
       [](const auto& n, auto& m, const auto&) {
         m.request_options.max_seconds = number_of(n, "max-seconds");
       }},
      {"order",
       [](const auto& n, auto& m, const auto&) {
         m.output.writing.order = scalar<int>(n, "order", "1 or 2");
         if (m.output.writing.order != 1 && m.output.writing.order != 2)
           throw Wrong{n.Mark(), "order: " + in_quotes(n.Scalar()) + " is not 1 or 2"};
       }},
      {"color", [](const auto& n, auto& m, const auto&) { m.output.color = color_of(n); }},
      {"require", [](const auto& n, auto& m, const auto&) { require(n, m.gates); }},
  };
  return keys;
}

const std::map<std::string, Setter>& mesh_keys() {
  static const std::map<std::string, Setter> keys = [] {
    std::map<std::string, Setter> all = common_keys();
    all["name"] = [](const auto& n, auto& m, const auto&) { m.name = text_of(n, "name"); };
    all["input"] = [](const auto& n, auto& m, const auto& folder) {
      m.input = folder / text_of(n, "input");
      if (!is_domain_path(m.input))
        throw Wrong{n.Mark(), "input: " + unknown_domain_format(m.input).value().message};
    };
    all["output"] = [](const auto& n, auto& m, const auto& folder) {
      m.output.files = paths_of(n, "output", folder);
      for (const auto& file : m.output.files)
        if (const auto ok = check_writable(file, {}); !ok)
          throw Wrong{n.Mark(), "output: " + ok.error().message};
    };
    all["draw"] = [](const auto& n, auto& m, const auto& folder) {
      m.output.drawings = paths_of(n, "draw", folder);
      for (const auto& file : m.output.drawings)
        if (!draw_format(file))
          throw Wrong{n.Mark(), "draw: " + in_quotes(file.string()) + " is no .png, .svg or .pdf"};
    };
    return all;
  }();
  return keys;
}

void set_all(const YAML::Node& node, const std::map<std::string, Setter>& keys, BatchMesh& mesh,
             const std::filesystem::path& folder) {
  if (!node.IsMap()) throw Wrong{node.Mark(), "not a map of keys to values"};
  for (const auto& entry : node) {
    const std::string name = text_of(entry.first, "a key");
    const auto found = keys.find(name);
    if (found == keys.end()) throw Wrong{entry.first.Mark(), in_quotes(name) + " is no key here"};
    found->second(entry.second, mesh, folder);
  }
}

std::vector<BatchMesh> meshes_of(const YAML::Node& root, const std::filesystem::path& folder) {
  if (!root.IsMap()) throw Wrong{root.Mark(), "not a map with a key 'meshes'"};
  for (const auto& entry : root) {
    const std::string name = text_of(entry.first, "a key");
    if (name != "defaults" && name != "meshes")
      throw Wrong{entry.first.Mark(),
                  in_quotes(name) + " is no key here: there are defaults and meshes"};
  }
  BatchMesh defaults;
  if (root["defaults"]) set_all(root["defaults"], common_keys(), defaults, folder);
  const YAML::Node list = root["meshes"];
  if (!list || !list.IsSequence() || list.size() == 0)
    throw Wrong{root.Mark(), "meshes: not a list of at least one mesh"};
  std::vector<BatchMesh> meshes;
  std::set<std::string> names;
  for (const YAML::Node& node : list) {
    BatchMesh mesh = defaults;
    set_all(node, mesh_keys(), mesh, folder);
    if (mesh.name.empty()) throw Wrong{node.Mark(), "a mesh without a name"};
    if (mesh.input.empty()) throw Wrong{node.Mark(), mesh.name + ": a mesh without an input"};
    if (!names.insert(mesh.name).second)
      throw Wrong{node.Mark(), in_quotes(mesh.name) + " names two meshes"};
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

}  // namespace

Result<std::vector<BatchMesh>> read_manifest(const std::filesystem::path& file) {
  const auto wrong = [&](const YAML::Mark& where, const std::string& what) {
    const std::string line = where.is_null() ? "" : ":" + std::to_string(where.line + 1);
    return fail(ExitCode::kUnreadableInput, file.string() + line + ": " + what);
  };
  try {
    return meshes_of(YAML::LoadFile(file.string()), file.parent_path());
  } catch (const Wrong& what) {
    return wrong(what.where, what.what);
  } catch (const YAML::BadFile&) {
    return fail(ExitCode::kUnreadableInput, file.string() + ": cannot be read");
  } catch (const YAML::Exception& error) {
    return wrong(error.mark, error.msg);
  }
}

}  // namespace weft::client
