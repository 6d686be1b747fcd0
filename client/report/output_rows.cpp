// SPDX-License-Identifier: Apache-2.0
#include "client/report/output_rows.h"

#include <array>
#include <cmath>
#include <sstream>
#include <string_view>
#include <utility>

#include "files/formats/derived/mesh_parts.h"

namespace weft::client {
namespace {

constexpr std::string_view kDeeper = "deeper:";

std::string not_a_box(const std::string& text) {
  return in_quotes(text) +
         " is not a box x,y,width,height with positive sides, up to 1e100, and at least 1e-12 of "
         "its place";
}

// Four finite numbers: the sides are positive, and none is larger than what can be drawn.
OptionValue<DrawOptions> zoom() {
  return {"X,Y,W,H", "", Arity::kOne,
          [](const auto& texts, const auto&, DrawOptions& options) -> std::string {
            std::istringstream text(texts.front());
            std::array<double, 4> numbers{};
            std::size_t count = 0;
            for (std::string part; std::getline(text, part, ','); ++count) {
              const auto number = value_of<double>(part);
              if (count == numbers.size() || !number) return not_a_box(texts.front());
              numbers[count] = *number;
            }
            constexpr double kMax = 1e100;
            constexpr double kMinOfThePlace = 1e-12;
            const auto [x, y, width, height] = numbers;
            const auto is_side = [](double side, double place) {
              return std::abs(place) <= kMax && side >= 1 / kMax && side <= kMax &&
                     side >= kMinOfThePlace * std::abs(place);
            };
            if (count != numbers.size() || !is_side(width, x) || !is_side(height, y))
              return not_a_box(texts.front());
            options.zoom = DrawnBox{x, y, width, height};
            return "";
          }};
}

OptionValue<MeshWriteOptions> nodal() {
  return {"NAME=SOURCE", "", Arity::kList,
          [](const auto& texts, const auto& folder, MeshWriteOptions& options) -> std::string {
            std::vector<NodalOption> all;
            for (const std::string& text : texts)
              if (auto fault = add_nodal(text, folder, all); !fault.empty()) return fault;
            options.nodal = std::move(all);
            return "";
          }};
}

}  // namespace

OptionValue<MeshWriteOptions> open_boundaries() {
  return {"MARKER|deeper:METRES", "", Arity::kList,
          [](const auto& texts, const auto&, MeshWriteOptions& options) -> std::string {
            options.open_boundaries.clear();
            options.open_boundary_names.clear();
            options.open_deeper.reset();
            for (const std::string& text : texts) {
              if (text.starts_with(kDeeper)) {
                const auto depth = value_of<double>(text.substr(kDeeper.size()));
                if (!depth || !std::isfinite(*depth))
                  return in_quotes(text) + " is not deeper:METRES, such as deeper:50";
                if (std::exchange(options.open_deeper, depth))
                  return "two depths are given; one says what is deep";
              } else if (const auto marker = value_of<std::int32_t>(text))
                options.open_boundaries.push_back(*marker);
              else if (name_fault(text).empty())
                options.open_boundary_names.push_back(text);
              else
                return in_quotes(text) + " is neither an integer nor a name nor deeper:METRES";
            }
            return "";
          }};
}

const OptionRows<MeshWriteOptions>& writing_rows() {
  using Writing = MeshWriteOptions;
  static const OptionRows<Writing> rows = {
      {"order", "WEFT_ORDER",
       "Order of the triangles written: 2 writes six-node triangles with straight sides, to .vtu, "
       ".msh, .node, .xdmf, .exo, .e and .inp",
       "1", one_of(&Writing::order, {{"1", 1}, {"2", 2}})},
      {"msh-version", "WEFT_MSH_VERSION",
       "Version of .msh files: 4.1, binary, or 2.2, text, for older programs", "4.1",
       one_of(&Writing::msh_version, {{"2.2", MshVersion::k22}, {"4.1", MshVersion::k41}})},
      {"open-boundary", "",
       "Marker of segments that the .14, .grd and .gr3 files of ADCIRC and SCHISM have as open "
       "boundary, by number or by name, or deeper:METRES: where the bed along the outer boundary "
       "is deeper than that; the others are land. May be repeated",
       "", open_boundaries()},
      {"nodal", "",
       "Values at the vertices: NAME=FILE of a raster, NAME=FILE:BAND, or NAME=NUMBER. They are "
       "written to .vtu, .msh, .npz, .nc, .slf, .xdmf and .exo; the bed, which is depth, positive "
       "down, or elevation, positive up, to .14, .grd, .gr3, .2dm and .disv, too. May be repeated: "
       "of several sources of a name, the first that has a value at a vertex counts there",
       "", nodal()},
      {"renumber", "",
       "Order of the vertices in files: rcm is reverse Cuthill-McKee, which brings the vertices of "
       "an edge close to each other; none is the order in which they arrive",
       "none",
       one_of(&Writing::renumbering,
              {{"none", Renumbering::kNone}, {"rcm", Renumbering::kReverseCuthillMcKee}})},
      {"parts", "",
       "Divide the triangles into N parts of the same size with few edges between them, for N "
       "processes; .vtu, .nc, .npz, .xdmf and .exo store the part of each triangle. Needs METIS",
       "", number("N", &Writing::parts, 1, kMaxParts)},
  };
  return rows;
}

const OptionRows<DrawOptions>& drawing_rows() {
  using Draw = DrawOptions;
  static const OptionRows<Draw> rows = {
      {"color", "WEFT_COLOR",
       "Colour of the triangles in drawings: by their smallest angle, by their area (size), by "
       "region, by their area over its bound, which --size or --edge gives, or none; auto is bound "
       "if one is given, size if they are too small to be seen one by one, otherwise none",
       "auto",
       one_of(&Draw::color, {{"angle", DrawColor::kAngle},
                             {"size", DrawColor::kSize},
                             {"region", DrawColor::kRegion},
                             {"bound", DrawColor::kBound},
                             {"none", DrawColor::kNone},
                             {"auto", DrawColor::kAuto}})},
      {"zoom", "",
       "Draw only what is in this box: its lower left corner, width and height, in the unit of the "
       "drawing",
       "", zoom()},
      {"worst", "", "Mark the N triangles with the smallest angles in drawings", "",
       number("N", &Draw::worst, 1, Draw::kMaxWorst)},
      {"labels", "",
       "Write the numbers of vertices and triangles, and the markers, into drawings if they fit",
       "", on_or_off(&Draw::labels)},
      {"no-legend", "", "Draw the mesh alone, without scale and legend", "",
       on_or_off(&Draw::no_legend)},
      {"draw-size", "WEFT_DRAW_SIZE",
       "Longer side of the mesh in drawings, in pixels; .svg and .pdf have half as many points",
       std::to_string(Draw::kDefaultPixels),
       number("PX", &Draw::pixels, Draw::kMinPixels, Draw::kMaxPixels)},
  };
  return rows;
}

const OptionRows<DrawOptions>& drawing_rows_of_new_mesh() {
  static const OptionRows<DrawOptions> rows = [] {
    OptionRows<DrawOptions> all = drawing_rows();
    OptionRow<DrawOptions>& color = all.front();
    color.about =
        "Colour of the triangles in drawings: by their smallest angle, by their area (size), by "
        "region or none; auto is size if they are too small to be seen one by one, otherwise none";
    color.value.unit = "angle|size|region|none|auto";
    return all;
  }();
  return rows;
}

const OptionRows<DrawOptions>& drawing_rows_of_domain() {
  static const OptionRows<DrawOptions> rows = [] {
    OptionRows<DrawOptions> some;
    for (const OptionRow<DrawOptions>& row : drawing_rows())
      if (row.name == "zoom" || row.name == "no-legend" || row.name == "draw-size")
        some.push_back(row);
    return some;
  }();
  return rows;
}

const OptionRows<MeshOutputOptions>& quadtree_rows() {
  using Output = MeshOutputOptions;
  static const OptionRows<Output> rows = {
      {"draw-quadtree", "WEFT_DRAW_QUADTREE",
       "Draw over the mesh the leaves of the quadtree that guided refinement", "",
       on_or_off(&Output::draw_quadtree)},
  };
  return rows;
}

}  // namespace weft::client
