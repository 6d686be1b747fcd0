// SPDX-License-Identifier: Apache-2.0
// The options of a request that say something of segments by their markers, numbers or names:
// --layers wall:first=1e-5,rows=20. They become fields once the names of the domain are known.
//
//   MarkerOptions options;
//   for (const MarkerOption& option : marker_options())
//     if (option.name == "keep") option.read("inlet,4", options);  // ""
//   fill(options, domain.names.markers, request);  // request.quality().keep().markers() is {4, 2}
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "files/base/error.h"
#include "files/formats/edge_at.h"
#include "files/formats/marker_list.h"
#include "files/formats/marker_pairs.h"
#include "files/formats/names.h"
#include "files/formats/wall_layers.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::wire {

struct MarkerOptions {
  std::vector<files::EdgeAt> edge_at{};       // lengths of edges
  std::optional<files::MarkerList> keep{};    // as they are; none in the list: all segments
  std::vector<files::MarkerPair> periodic{};  // sides that repeat each other
  std::vector<files::WallLayers> layers{};    // along walls
};

struct MarkerOption {
  std::string name;
  std::string variable;  // of the environment; empty: none
  std::string unit;      // the form of a text
  std::string about;
  std::string path;  // the field, as errors call it
  bool repeats = false;
  // Reads one text, and adds it if the option repeats; returns what is wrong with it, or "".
  std::string (*read)(const std::string& text, MarkerOptions& options) = nullptr;
  void (*clear)(MarkerOptions& options) = nullptr;
  // What was given for an entry of the field, such as "left:right"; "" if it has no entries.
  std::string (*entry)(const MarkerOptions& options, std::size_t index) = nullptr;
};

const std::vector<MarkerOption>& marker_options();

struct MarkerFault {
  std::string field;  // such as "quality.layers[0]"
  files::Error error;
};

// Sets the fields, and returns what is wrong: a name that no marker has.
std::optional<MarkerFault> fill(const MarkerOptions& options, const files::NameTable& markers,
                                v1::GenerateMeshRequest& request);

// The sides that a request asks to repeat each other, by markers.
std::vector<std::array<std::int32_t, 2>> periodic_sides(const v1::Quality& quality);

}  // namespace weft::wire
