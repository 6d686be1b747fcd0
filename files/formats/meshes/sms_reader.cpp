// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/line_scanner.h"
#include "files/bytes/number_text.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/meshes/sms.h"
#include "files/formats/triangle/triangle_points.h"

namespace weft::files {
namespace {

constexpr std::int64_t kMaxNodes = std::numeric_limits<std::uint32_t>::max();

class Reader {
 public:
  // Names may hold any character but a quotation mark: there are no comments.
  Reader(const std::filesystem::path& path, std::string_view text)
      : path_(path),
        scanner_(path.string(), text, {.blanks = " \t\r\f\v", .comment = '\0'}),
        names_(path.string()) {}

  Result<Mesh> read() {
    bool first = true;
    while (scanner_.try_next_line()) {
      const auto card = scanner_.word("a card");
      if (!card) return tl::unexpected(card.error());
      if (first && *card != "MESH2D") return scanner_.error("the first line is not MESH2D");
      first = false;
      if (auto done = read_card(*card); !done) return tl::unexpected(done.error());
    }
    if (first) return refuse("is empty");
    for (std::vector<std::uint32_t>* numbers :
         {&mesh_.triangles, &mesh_.faces.corners, &mesh_.edges}) {
      for (std::uint32_t& number : *numbers) {
        const auto found = vertex_of_node_.find(number);
        if (found == vertex_of_node_.end()) return refuse("has no node " + std::to_string(number));
        number = found->second;
      }
    }
    mesh_.warnings = names_.warnings();
    mesh_.names = names_.take();
    return validated(path_, std::move(mesh_));
  }
  std::vector<double> elevations() { return std::move(elevations_); }

 private:
  tl::unexpected<Error> refuse(const std::string& why) const {
    return fail(ExitCode::kUnreadableInput, path_.string() + ": " + why);
  }

  Result<void> read_card(std::string_view card) {
    if (card == "ND") return node();
    if (card == "E3T") return element(3);
    if (card == "E4Q") return element(4);
    if (card == "NS") return node_string();
    if (card == "MAT") return material();
    const bool is_element = card.size() == 3 && card[0] == 'E' && card[1] >= '0' && card[1] <= '9';
    if (is_element)
      return scanner_.error("the element is of the kind " + in_quotes(card) +
                            ", only E3T and E4Q are read");
    return {};
  }

  // The number of a node: from 1, in 32 bits.
  Result<std::uint32_t> node_number() {
    const auto number = scanner_.integer("a node");
    if (!number) return tl::unexpected(number.error());
    if (*number < 1 || *number > kMaxNodes)
      return scanner_.error("the node is " + std::to_string(*number) + ", numbers begin at 1");
    return static_cast<std::uint32_t>(*number);
  }

  Result<void> node() {
    const auto number = node_number();
    if (!number) return tl::unexpected(number.error());
    const auto vertex = static_cast<std::uint32_t>(vertex_of_node_.size());
    if (!vertex_of_node_.try_emplace(*number, vertex).second)
      return scanner_.error("the node " + std::to_string(*number) + " comes twice");
    for (const char* what : {"the x coordinate", "the y coordinate"}) {
      const auto value = scanner_.real(what);
      if (!value) return tl::unexpected(value.error());
      mesh_.coordinates.push_back(*value);
    }
    const auto z =
        scanner_.at_line_end() ? Result<std::string_view>("0") : scanner_.word("the elevation");
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    elevations_.push_back(z ? real_of(*z).value_or(kNone) : kNone);
    return {};
  }

  Result<void> element(int corners) {
    if (auto number = scanner_.integer("the element's number"); !number)
      return tl::unexpected(number.error());
    std::vector<std::uint32_t> nodes;
    for (int corner = 0; corner < corners; ++corner) {
      const auto node = node_number();
      if (!node) return tl::unexpected(node.error());
      nodes.push_back(*node);
    }
    std::int32_t region = 0;
    if (!scanner_.at_line_end()) {
      const auto material = scanner_.marker("the material");
      if (!material) return tl::unexpected(material.error());
      region = *material;
    }
    if (nodes.size() > 3) return mesh_.faces.add(nodes, region), Result<void>{};
    mesh_.triangles.insert(mesh_.triangles.end(), nodes.begin(), nodes.end());
    mesh_.regions.push_back(region);
    return {};
  }

  // Reads a node string: nodes up to one that is negative, then perhaps a marker and a name. A node
  // string without a number is numbered by its place in the file.
  Result<void> node_string() {
    while (!scanner_.at_line_end()) {
      const auto value = scanner_.integer("a node");
      if (!value) return tl::unexpected(value.error());
      const std::int64_t node = *value < 0 ? -std::max(*value, -kMaxNodes - 1) : *value;
      if (node < 1 || node > kMaxNodes)
        return scanner_.error("the node is " + std::to_string(*value) + ", numbers begin at 1");
      string_.push_back(static_cast<std::uint32_t>(node));
      if (*value < 0) return end_node_string();
    }
    return {};
  }

  Result<void> end_node_string() {
    std::int32_t marker = ++strings_;
    if (!scanner_.at_line_end() && !scanner_.rest_of_line().starts_with('"')) {
      const auto value = scanner_.marker("the node string's number");
      if (!value) return tl::unexpected(value.error());
      marker = *value;
    }
    const std::string_view name = quoted();
    if (!name.empty()) names_.add(NameKind::kMarker, marker, name);
    for (std::size_t i = 1; i < string_.size(); ++i) {
      mesh_.edges.insert(mesh_.edges.end(), {string_[i - 1], string_[i]});
      mesh_.edge_markers.push_back(marker);
    }
    string_.clear();
    return {};
  }

  Result<void> material() {
    const auto number = scanner_.marker("the material");
    if (!number) return tl::unexpected(number.error());
    if (const std::string_view name = quoted(); !name.empty())
      names_.add(NameKind::kRegion, *number, name);
    return {};
  }

  // What stands between quotation marks in the rest of the line; empty if there are none.
  std::string_view quoted() const {
    std::string_view rest = scanner_.rest_of_line();
    if (!rest.starts_with('"')) return {};
    rest.remove_prefix(1);
    return rest.substr(0, rest.find('"'));
  }

  const std::filesystem::path& path_;
  LineScanner scanner_;
  std::unordered_map<std::uint32_t, std::uint32_t> vertex_of_node_;
  std::vector<std::uint32_t> string_;  // the nodes of a node string that goes on in the next line
  std::int32_t strings_ = 0;
  NameReader names_;
  std::vector<double> elevations_;
  Mesh mesh_;  // corners by the numbers of nodes, until all nodes are read
};

}  // namespace

Result<Mesh> read_2dm(const std::filesystem::path& path) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  return Reader(path, contents->text()).read();
}

Result<MeshWithArrays> read_2dm_values(const std::filesystem::path& path,
                                       const std::optional<std::string>& wanted) {
  const auto chosen = chosen_arrays(path, {"elevation"}, wanted);
  if (!chosen) return tl::unexpected(chosen.error());
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  Reader reader(path, contents->text());
  auto mesh = reader.read();
  if (!mesh) return tl::unexpected(mesh.error());
  return with_bed_column(std::move(*mesh), chosen->front(), reader.elevations(), wanted);
}

}  // namespace weft::files
