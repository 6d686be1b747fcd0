// SPDX-License-Identifier: Apache-2.0
#include "client/batch/manifest.h"

#include <yaml-cpp/yaml.h>

#include <functional>
#include <map>
#include <set>

#include "client/call/layer_rows.h"
#include "client/call/projection_rows.h"
#include "client/call/request_rows.h"
#include "client/drawing/draw.h"
#include "client/report/output_rows.h"
#include "files/base/did_you_mean.h"
#include "files/base/text.h"
#include "files/formats/domain_formats.h"
#include "files/formats/mesh_formats.h"

namespace weft::client {
namespace {

// What is wrong, and where; caught in `read_manifest` only.
struct Wrong {
  YAML::Mark where;
  std::string what;
};

std::string text_of(const YAML::Node& node, const std::string& key) {
  if (!node.IsScalar()) throw Wrong{node.Mark(), key + ": not a single value"};
  return node.Scalar();
}

// One text, or a list of them.
std::vector<std::string> texts_of(const YAML::Node& node, const std::string& key) {
  if (!node.IsSequence()) return {text_of(node, key)};
  std::vector<std::string> texts;
  for (const YAML::Node& one : node) texts.push_back(text_of(one, key));
  return texts;
}

std::vector<std::filesystem::path> paths_of(const YAML::Node& node, const std::string& key,
                                            const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  for (const std::string& text : texts_of(node, key)) paths.push_back(folder / text);
  return paths;
}

void require(const YAML::Node& node, std::vector<QualityGate>& gates) {
  if (!node.IsMap()) throw Wrong{node.Mark(), "require: not a map of figures to bounds"};
  for (const auto& entry : node) {
    auto gate =
        QualityGate::make(text_of(entry.first, "require"), text_of(entry.second, "require"));
    if (!gate) throw Wrong{entry.first.Mark(), "require: " + gate.error().message};
    // A bound of the mesh replaces that of the defaults.
    std::erase_if(gates, [&](const QualityGate& g) { return g.figure() == gate->figure(); });
    gates.push_back(std::move(*gate));
  }
}

// Of `names`, as a list of texts, or as tables: {marker: {2: inlet}, region: {1: fluid}}.
std::vector<std::string> names_in(const YAML::Node& node) {
  if (!node.IsMap()) return texts_of(node, "names");
  std::vector<std::string> texts;
  for (const auto& kind : node) {
    if (!kind.second.IsMap()) throw Wrong{kind.first.Mark(), "names: not a table of ids to names"};
    for (const auto& entry : kind.second)
      texts.push_back(text_of(kind.first, "names") + "=" + text_of(entry.first, "names") + ":" +
                      text_of(entry.second, "names"));
  }
  return texts;
}

using Setter =
    std::function<void(const YAML::Node&, BatchMesh&, const std::filesystem::path& folder)>;

// One key for each row; `part` points to those options of a mesh that the rows set.
template <class Options, class Part>
void add_rows(std::map<std::string, Setter>& keys, const OptionRows<Options>& rows, Part part) {
  for (const OptionRow<Options>& row : rows)
    keys[row.name] = [&row, part](const auto& node, auto& mesh, const auto& folder) {
      const auto texts = row.name == "names"               ? names_in(node)
                         : row.value.arity == Arity::kList ? texts_of(node, row.name)
                                                           : std::vector{text_of(node, row.name)};
      const std::string fault = row.value.read(texts, folder, *part(mesh));
      if (!fault.empty()) throw Wrong{node.Mark(), row.name + ": " + fault};
    };
}

// The keys that defaults may have, too.
const std::map<std::string, Setter>& common_keys() {
  static const std::map<std::string, Setter> keys = [] {
    std::map<std::string, Setter> all;
    add_rows(all, request_rows(), [](BatchMesh& m) { return &m.request_options; });
    add_rows(all, writing_rows(), [](BatchMesh& m) { return &m.output.writing; });
    add_rows(all, drawing_rows_of_new_mesh(), [](BatchMesh& m) { return &m.output.drawing; });
    add_rows(all, quadtree_rows(), [](BatchMesh& m) { return &m.output; });
    add_rows(all, layer_rows(), [](BatchMesh& m) { return &m.layers; });
    add_rows(all, projection_rows(), [](BatchMesh& m) { return &m.output.projection; });
    all["require"] = [](const auto& n, auto& m, const auto&) { require(n, m.gates); };
    return all;
  }();
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
      const auto files = paths_of(n, "output", folder);
      m.output.files.assign(files.begin(), files.end());
      for (const auto& file : m.output.files)
        if (const auto ok = check_writable(file, {}); !ok)
          throw Wrong{n.Mark(), "output: " + ok.error().message};
    };
    all["draw"] = [](const auto& n, auto& m, const auto& folder) {
      m.output.drawings = paths_of(n, "draw", folder);
      for (const auto& file : m.output.drawings)
        if (!draw_format(file))
          throw Wrong{n.Mark(),
                      "draw: " + in_quotes(file.string()) + " is not a .png, .svg or .pdf"};
    };
    return all;
  }();
  return keys;
}

std::vector<std::string> names_of(const std::map<std::string, Setter>& keys) {
  std::vector<std::string> names;
  for (const auto& [name, setter] : keys) names.push_back(name);
  return names;
}

void set_all(const YAML::Node& node, const std::map<std::string, Setter>& keys, BatchMesh& mesh,
             const std::filesystem::path& folder) {
  if (!node.IsMap()) throw Wrong{node.Mark(), "not a map of keys to values"};
  for (const auto& entry : node) {
    const std::string name = text_of(entry.first, "a key");
    const auto found = keys.find(name);
    if (found == keys.end()) {
      const std::string meant = did_you_mean(name, names_of(keys));
      throw Wrong{entry.first.Mark(),
                  in_quotes(name) + " is not a key here" + (meant.empty() ? "" : ": " + meant)};
    }
    found->second(entry.second, mesh, folder);
  }
}

std::vector<BatchMesh> meshes_of(const YAML::Node& root, const std::filesystem::path& folder) {
  if (!root.IsMap()) throw Wrong{root.Mark(), "not a map with a key 'meshes'"};
  for (const auto& entry : root) {
    const std::string name = text_of(entry.first, "a key");
    if (name != "defaults" && name != "meshes")
      throw Wrong{entry.first.Mark(),
                  in_quotes(name) + " is not a key here; the keys are defaults and meshes"};
  }
  BatchMesh defaults;
  defaults.request_options.from_manifest = true;
  if (root["defaults"]) set_all(root["defaults"], common_keys(), defaults, folder);
  const YAML::Node list = root["meshes"];
  if (!list || !list.IsSequence() || list.size() == 0)
    throw Wrong{root.Mark(), "meshes: not a list of at least one mesh"};
  std::vector<BatchMesh> meshes;
  std::set<std::string> names;
  for (const YAML::Node& node : list) {
    BatchMesh mesh = defaults;
    set_all(node, mesh_keys(), mesh, folder);
    // A default, as `color` is, which a mesh without a drawing does not use.
    if (mesh.output.drawings.empty()) mesh.output.draw_quadtree = false;
    if (mesh.name.empty()) throw Wrong{node.Mark(), "a mesh without a name"};
    if (mesh.input.empty()) throw Wrong{node.Mark(), mesh.name + ": a mesh without an input"};
    if (!names.insert(mesh.name).second)
      throw Wrong{node.Mark(), in_quotes(mesh.name) + " names two meshes"};
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

}  // namespace

std::vector<std::string> manifest_keys() {
  return names_of(common_keys());
}

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
