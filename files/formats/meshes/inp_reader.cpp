// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/malformed.h"
#include "files/bytes/node_numbers.h"
#include "files/bytes/number_text.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/meshes/inp.h"
#include "files/formats/meshes/inp_elements.h"
#include "files/formats/meshes/inp_lines.h"
#include "files/formats/meshes/inp_sets.h"
#include "files/formats/triangle/triangle_points.h"

namespace weft::files {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMaxSides = 4;

// Keywords that make nodes and elements, or move them, or have them elsewhere.
constexpr std::string_view kNotRead[] = {"*include", "*ngen",  "*nfill",  "*ncopy",
                                         "*nmap",    "*elgen", "*elcopy", "*system"};

bool begins_with_digit(std::string_view text) {
  return !text.empty() && text.front() >= '0' && text.front() <= '9';
}

// The numbers of regions or markers by their names in the file: "region_7" is 7.
class Numbering {
 public:
  explicit Numbering(NameKind kind) : kind_(kind) {}

  std::uint32_t of(const std::string& name) {
    const std::string lower = lower_case(name);
    const std::string prefix = std::string(word_of(kind_)) + "_";
    std::int32_t number = 0;
    const char* const end = lower.data() + lower.size();
    if (lower.starts_with(prefix) &&
        std::from_chars(lower.data() + prefix.size(), end, number).ptr == end)
      return labels_.of(number);
    return labels_.of(spelling_.try_emplace(lower, name).first->second);
  }
  std::vector<std::int32_t> numbers() const { return labels_.numbers(); }
  void name_all(NameReader& names) const { labels_.name_all(kind_, names); }

 private:
  NameKind kind_;
  Labels labels_;
  std::map<std::string, std::string> spelling_;  // the first of each name in lower case
};

class Reader {
 public:
  Reader(const std::filesystem::path& path, std::string_view text)
      : path_(path), lines_(path.string(), text), names_(path.string()) {}

  Result<Mesh> read() {
    try {
      read_lines();
    } catch (const Malformed& malformed) {
      return tl::unexpected(malformed.error);
    }
    if (!has_nodes_) return fail(ExitCode::kUnreadableInput, path_.string() + ": has no *NODE");
    number_elements();
    warn();
    return validated(path_, std::move(mesh_));
  }

 private:
  struct Element {
    std::size_t place;  // among the triangles, faces or edges
    std::size_t corners;
    bool is_shell;
  };
  struct SurfaceLine {
    std::uint32_t marker;  // of markers_
    std::optional<std::size_t> set;
    std::int64_t element;  // its number, if there is no set
    std::size_t side;      // from 0
    bool of_shell;
  };

  [[noreturn]] void refuse(const std::string& why) {
    throw Malformed{lines_.scanner().error(why).value()};
  }

  void read_lines() {
    while (lines_.next()) {
      if (lines_.is_keyword()) {
        end_section();
        begin(lines_.keyword());
      } else if (section_ != nullptr) {
        (this->*section_)();
      } else if (!has_keyword_) {
        refuse("expected a keyword such as *NODE, found " +
               in_quotes(must(lines_.scanner().word("a keyword"))));
      }
    }
    end_section();
  }

  void begin(const InpKeyword& keyword) {
    has_keyword_ = true;
    if (std::ranges::find(kNotRead, keyword.name) != std::end(kNotRead))
      refuse(in_quotes(keyword.name) + " is not read: a mesh is what the file itself lists");
    if (keyword.name == "*part" && ++parts_ > 1) refuse("there is a second part, one is read");
    if (keyword.name == "*instance" && ++instances_ > 1)
      refuse("there is a second instance of a part, one is read");
    in_assembly_ |= keyword.name == "*assembly";
    in_instance_ = keyword.name == "*instance" || (in_instance_ && keyword.name != "*endinstance");
    if (keyword.name.ends_with("section") && keyword.has("elset"))
      sections_.push_back(sets_.of(keyword.value("elset")));
    if (keyword.name == "*node") begin_nodes(keyword);
    if (keyword.name == "*element") begin_elements(keyword);
    if (keyword.name == "*elset") begin_set(keyword);
    if (keyword.name == "*surface") begin_surface(keyword);
    if (section_ != nullptr && keyword.has("input"))
      refuse("the data are in another file, " + in_quotes(keyword.value("input")) +
             ": a mesh is what the file itself lists");
  }
  // An assembly has reference points of its own beside the nodes of its instances.
  bool of_assembly() const { return in_assembly_ && !in_instance_; }

  void begin_nodes(const InpKeyword& keyword) {
    if (of_assembly()) return;
    const std::string system = keyword.value("system");
    if (!system.empty() && lower_case(system) != "r")
      refuse("the coordinates are of the system " + in_quotes(system) + ", only R is read");
    has_nodes_ = true;
    section_ = &Reader::node;
  }
  void node() {
    if (lines_.has_empty_field()) refuse("there is nothing between two commas");
    must(nodes_.add(lines_.scanner(), "the node number"));
    for (const char* what : {"the x coordinate", "the y coordinate"})
      mesh_.coordinates.push_back(coordinate(what));
  }
  // Those at the end of a line may be missing.
  double coordinate(const std::string& what) {
    if (lines_.scanner().at_line_end()) return 0;
    const std::string_view text = must(lines_.scanner().word(what));
    const auto value = real_of(text);
    if (!value) refuse("expected " + what + ", a finite number, found " + in_quotes(text));
    return *value;
  }

  void begin_elements(const InpKeyword& keyword) {
    type_name_ = keyword.value("type");
    if (type_name_.empty()) refuse("the elements have no TYPE");
    type_ = of_assembly() ? InpElementType{} : inp_element_type(type_name_);
    first_element_ = elements_.size();
    if (keyword.has("elset")) block_ = sets_.of(keyword.value("elset"));
    section_ = type_.corners == 0 ? &Reader::other_element : &Reader::element;
    goes_on_ = false;
  }
  void other_element() {
    if (!std::exchange(goes_on_, lines_.goes_on())) ++left_out_[type_name_];
  }
  void element() {
    LineScanner& scanner = lines_.scanner();
    must(element_numbers_.add(scanner, "the element number"));
    std::array<std::uint32_t, 2 * kMaxSides> nodes;
    for (std::size_t k = 0; k < type_.nodes(); ++k) {
      must(scanner.to_field("a node of the element"));
      nodes[k] = must(nodes_.read(scanner, "a node of the element"));
    }
    if (!scanner.at_line_end())
      refuse("the element has more than the " + std::to_string(type_.nodes()) +
             " nodes of its type " + in_quotes(type_name_));
    if (type_.corners == 2) return add_line(nodes[0], nodes[type_.nodes() - 1], nodes[1]);
    const std::span corners = std::span(nodes).first(type_.corners);
    for (std::size_t k = 0; type_.second_order && k < corners.size(); ++k)
      mesh_.middles.push_back(
          {corners[k], corners[(k + 1) % corners.size()], nodes[corners.size() + k]});
    const bool is_triangle = corners.size() == 3;
    elements_.push_back({is_triangle ? mesh_.triangles.size() / 3 : mesh_.faces.size(),
                         corners.size(), type_.is_shell});
    if (is_triangle)
      mesh_.triangles.insert(mesh_.triangles.end(), corners.begin(), corners.end());
    else
      mesh_.faces.add(corners, 0);
  }
  void add_line(std::uint32_t from, std::uint32_t to, std::uint32_t middle) {
    if (type_.second_order) mesh_.middles.push_back({from, to, middle});
    elements_.push_back({mesh_.edges.size() / 2, 2, false});
    mesh_.edges.insert(mesh_.edges.end(), {from, to});
  }
  void end_section() {
    if (block_) {
      sets_.add_indices(*block_, static_cast<std::uint32_t>(first_element_),
                        static_cast<std::uint32_t>(elements_.size()));
      blocks_.push_back(*block_);
    }
    block_.reset();
    section_ = nullptr;
  }

  void begin_set(const InpKeyword& keyword) {
    if (keyword.value("elset").empty()) refuse("the set has no name: ELSET is missing");
    set_ = sets_.of(keyword.value("elset"));
    if (!keyword.has("internal")) listed_.push_back(set_);
    section_ = keyword.has("generate") ? &Reader::set_of_range : &Reader::set_of_members;
  }
  std::int64_t integer(const std::string& text, const char* what) {
    const auto number = integer_of(text);
    if (!number) refuse("expected " + std::string(what) + ", found " + in_quotes(text));
    return *number;
  }
  void set_of_members() {
    for (const std::string& field : lines_.fields()) {
      if (!begins_with_digit(field) && !field.empty()) {
        sets_.add_set(set_, sets_.of(field));
        continue;
      }
      const std::int64_t number = integer(field, "an element or a set");
      sets_.add(set_, {number, number, 1});
    }
  }
  void set_of_range() {
    const std::vector<std::string> fields = lines_.fields();
    if (fields.size() < 2 || fields.size() > 3)
      refuse("expected the first element, the last one and the step");
    const std::int64_t step = fields.size() == 3 ? integer(fields[2], "the step") : 1;
    if (step < 1) refuse("the step is " + std::to_string(step) + ", it must be at least 1");
    sets_.add(set_, {integer(fields[0], "the first element"),
                     integer(fields[1], "the last element"), step});
  }

  void begin_surface(const InpKeyword& keyword) {
    const std::string type = lower_case(keyword.value("type"));
    if (!type.empty() && type != "element") return;
    if (keyword.value("name").empty()) refuse("the surface has no NAME");
    surface_ = keyword.value("name");
    section_ = &Reader::surface_line;
  }
  // "7, S1" or "fluid, S1".
  void surface_line() {
    const std::vector<std::string> fields = lines_.fields();
    const std::string side = fields.size() < 2 ? "" : lower_case(fields[1]);
    if (side.size() != 2 || (side[0] != 's' && side[0] != 'e') || side[1] < '1' || side[1] > '4') {
      ++sides_left_out_;
      return;
    }
    SurfaceLine line{
        markers_.of(surface_), {}, 0, static_cast<std::size_t>(side[1] - '1'), side[0] == 'e'};
    if (begins_with_digit(fields[0]))
      line.element = integer(fields[0], "an element or a set");
    else
      line.set = sets_.of(fields[0]);
    surfaces_.push_back(line);
  }

  // Of each element, the set whose name is that of its region, or of its marker if it is a line.
  std::vector<std::size_t> sets_of_elements() const {
    std::vector<std::size_t> set_of(elements_.size(), kNone);
    std::vector<bool> done(sets_.size());
    for (const std::vector<std::size_t>* sets : {&sections_, &listed_, &blocks_})
      for (const std::size_t set : *sets) {
        if (done[set]) continue;
        done[set] = true;
        sets_.each_of(set, element_numbers_, [&](std::uint32_t i) {
          if (set_of[i] == kNone) set_of[i] = set;
        });
      }
    return set_of;
  }

  void number_elements() {
    const std::vector<std::size_t> set_of = sets_of_elements();
    Numbering regions(NameKind::kRegion);
    std::vector<std::uint32_t> label(elements_.size(), kNone);
    for (std::size_t i = 0; i < elements_.size(); ++i)
      if (set_of[i] != kNone)
        label[i] = (elements_[i].corners == 2 ? markers_ : regions).of(sets_.name(set_of[i]));
    const std::vector<std::int32_t> of_region = regions.numbers();
    const std::vector<std::int32_t> of_marker = markers_.numbers();
    mesh_.regions.resize(mesh_.triangles.size() / 3);
    mesh_.edge_markers.resize(mesh_.edges.size() / 2);
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const auto& [place, corners, is_shell] = elements_[i];
      if (label[i] == kNone) continue;
      if (corners == 2) mesh_.edge_markers[place] = of_marker[label[i]];
      if (corners == 3) mesh_.regions[place] = of_region[label[i]];
      if (corners == 4) mesh_.faces.regions[place] = of_region[label[i]];
    }
    add_sides(of_marker);
    regions.name_all(names_);
    markers_.name_all(names_);
  }

  // The sides of elements that are on surfaces become edges.
  void add_sides(const std::vector<std::int32_t>& of_marker) {
    if (surfaces_.empty()) return;
    std::vector<std::uint32_t> label(kMaxSides * elements_.size(), kNone);
    for (const SurfaceLine& line : surfaces_) {
      const auto mark = [&](std::uint32_t i) {
        std::uint32_t& at = label[kMaxSides * i + line.side];
        if (at == kNone && elements_[i].is_shell == line.of_shell) at = line.marker;
      };
      if (line.set)
        sets_.each_of(*line.set, element_numbers_, mark);
      else if (const auto i = element_numbers_.find(line.element))
        mark(*i);
    }
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const auto& [place, count, is_shell] = elements_[i];
      if (count == 2) continue;
      const std::span<const std::uint32_t> corners =
          count == 3 ? std::span<const std::uint32_t>(mesh_.triangles).subspan(3 * place, 3)
                     : mesh_.faces.of(place);
      for (std::size_t side = 0; side < count; ++side) {
        const std::uint32_t marker = label[kMaxSides * i + side];
        if (marker == kNone) continue;
        mesh_.edges.insert(mesh_.edges.end(), {corners[side], corners[(side + 1) % count]});
        mesh_.edge_markers.push_back(of_marker[marker]);
      }
    }
  }

  void leave_out(std::uint64_t count, const std::string& what, const std::string& why) {
    mesh_.warnings.push_back({.kind = WarningKind::kLeftOut,
                              .file = path_.string(),
                              .count = count,
                              .text = "left out: " + with_separators(count) + " " + what +
                                      (count == 1 ? "" : "s") + " " + why});
  }
  void warn() {
    mesh_.warnings = names_.warnings();
    mesh_.names = names_.take();
    for (const auto& [type, count] : left_out_)
      leave_out(
          count, "element",
          "of the type " + in_quotes(type) + ", only triangles, quadrilaterals and lines are read");
    if (sides_left_out_ > 0)
      leave_out(sides_left_out_, "line", "of surfaces without a side in the plane");
  }

  const std::filesystem::path& path_;
  InpLines lines_;
  void (Reader::*section_)() = nullptr;  // reads a line of data; null: it is passed over
  bool has_keyword_ = false;
  bool has_nodes_ = false;
  int parts_ = 0;
  int instances_ = 0;
  bool in_assembly_ = false;
  bool in_instance_ = false;

  NodeNumbers nodes_;
  NodeNumbers element_numbers_;
  std::vector<Element> elements_;
  std::string type_name_;  // of the elements that are read
  InpElementType type_;
  bool goes_on_ = false;
  std::size_t first_element_ = 0;                  // of the section
  std::optional<std::size_t> block_;               // its set
  std::map<std::string, std::uint64_t> left_out_;  // elements by their type

  InpSets sets_;
  std::size_t set_ = 0;                // that is read
  std::vector<std::size_t> sections_;  // the sets that sections name
  std::vector<std::size_t> listed_;    // those of *ELSET
  std::vector<std::size_t> blocks_;    // those of *ELEMENT

  std::string surface_;  // that is read
  Numbering markers_{NameKind::kMarker};
  std::vector<SurfaceLine> surfaces_;
  std::uint64_t sides_left_out_ = 0;
  NameReader names_;
  Mesh mesh_;
};

}  // namespace

Result<Mesh> read_inp(const std::filesystem::path& path) {
  const auto contents = read_text_file(path, kMaxTextBytes);
  if (!contents) return tl::unexpected(contents.error());
  return Reader(path, contents->text()).read();
}

}  // namespace weft::files
