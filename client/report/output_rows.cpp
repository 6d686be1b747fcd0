// SPDX-License-Identifier: Apache-2.0
#include "client/report/output_rows.h"

#include <array>
#include <cmath>
#include <sstream>

namespace weft::client {
namespace {

std::string not_a_box(const std::string& text) {
  return in_quotes(text) +
         " is not a box x,y,width,height with positive sides, up to 1e100, and at least 1e-12 of "
         "its place";
}

// Four finite numbers, of which the sides are positive, none beyond what can be drawn.
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
            constexpr double kMost = 1e100;
            constexpr double kLeastOfThePlace = 1e-12;
            const auto [x, y, width, height] = numbers;
            const auto is_side = [](double side, double place) {
              return std::abs(place) <= kMost && side >= 1 / kMost && side <= kMost &&
                     side >= kLeastOfThePlace * std::abs(place);
            };
            if (count != numbers.size() || !is_side(width, x) || !is_side(height, y))
              return not_a_box(texts.front());
            options.zoom = DrawnBox{x, y, width, height};
            return "";
          }};
}

}  // namespace

const OptionRows<MeshWriteOptions>& writing_rows() {
  using Writing = MeshWriteOptions;
  static const OptionRows<Writing> rows = {
      {"order", "WEFT_ORDER",
       "Order of the triangles written: 2 writes six-node triangles with straight sides, to .vtu, "
       ".msh and .node",
       "1", one_of(&Writing::order, {{"1", 1}, {"2", 2}})},
      {"msh-version", "WEFT_MSH_VERSION",
       "Version of .msh files: 4.1, binary, or 2.2, text, for older programs", "4.1",
       one_of(&Writing::msh_version, {{"2.2", MshVersion::k22}, {"4.1", MshVersion::k41}})},
      {"open-boundary", "",
       "Marker of segments that ADCIRC's .14 and .grd files have as open boundary; the others are "
       "land. May be repeated",
       "", integers("MARKER", &Writing::open_boundaries)},
  };
  return rows;
}

const OptionRows<DrawOptions>& drawing_rows() {
  using Draw = DrawOptions;
  static const OptionRows<Draw> rows = {
      {"color", "WEFT_COLOR",
       "Colour of the triangles in drawings: by their smallest angle, by their area, by region or "
       "none; auto is size if they are too small to be seen one by one, otherwise none",
       "auto",
       one_of(&Draw::color, {{"angle", DrawColor::kAngle},
                             {"size", DrawColor::kSize},
                             {"region", DrawColor::kRegion},
                             {"none", DrawColor::kNone},
                             {"auto", DrawColor::kAuto}})},
      {"zoom", "",
       "Draw only what is in this box: its lower left corner, width and height, in the unit of the "
       "drawing",
       "", zoom()},
      {"worst", "", "Mark so many triangles of the smallest angles in drawings", "",
       number("N", &Draw::worst, 1, Draw::kMostWorst)},
      {"labels", "",
       "Write the numbers of vertices and triangles and the markers into drawings, where they fit",
       "", on_or_off(&Draw::labels)},
      {"no-legend", "", "Draw the mesh alone, without scale and legend", "",
       on_or_off(&Draw::no_legend)},
      {"draw-size", "WEFT_DRAW_SIZE",
       "Longer side of the mesh in drawings, in pixels; .svg and .pdf have half as many points",
       std::to_string(Draw::kDefaultPixels),
       number("PX", &Draw::pixels, Draw::kLeastPixels, Draw::kMostPixels)},
  };
  return rows;
}

const OptionRows<MeshOutputOptions>& quadtree_rows() {
  using Output = MeshOutputOptions;
  static const OptionRows<Output> rows = {
      {"draw-quadtree", "WEFT_DRAW_QUADTREE",
       "Draw the leaves of the quadtree that guided refinement over the mesh", "",
       on_or_off(&Output::draw_quadtree)},
  };
  return rows;
}

}  // namespace weft::client
