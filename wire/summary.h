// SPDX-License-Identifier: Apache-2.0
// A summary of a mesh as the protocol spells it: the bytes of a weft.v1.Summary, and its figures by
// name. The server and libweft write it by this.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "weft/mesh.h"

namespace weft::wire {

// Leaves of a quadtree whose boxes are sent, at most: 2 MiB, half of what a client of gRPC takes in
// a message by default.
inline constexpr std::size_t kMaxLeafBoxes = 65'536;

// The summary of a run on so many threads, without the boxes of the quadtree's leaves.
std::string write_summary(const Summary& summary, std::uint32_t threads);
// A Summary that has these boxes alone, to be merged with the other; empty if there are more than
// kMaxLeafBoxes.
std::string write_leaf_boxes(const Summary& summary);

// The number that the message has at a path, such as "min_angle_deg" or "timings.engine_seconds";
// nullopt if it has none there.
std::optional<double> figure(const Summary& summary, std::uint32_t threads, std::string_view path);

}  // namespace weft::wire
