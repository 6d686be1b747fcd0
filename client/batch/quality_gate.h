// SPDX-License-Identifier: Apache-2.0
// What a pipeline wants of a mesh before it goes on: a bound on one of its figures.
//
//   auto gate = QualityGate::parse("min-angle=20");
//   if (auto why = gate->violation(summary)) ...   // "min-angle is 19.2, less than 20"
//
// Figures: min-angle and max-angle of all triangles, in degrees; min-triangles and max-triangles;
// max-vertices; max-unrefined, the triangles that miss a bound though no angle of the input forces
// them to.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "client/base/files.h"
#include "files/base/error.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

class QualityGate {
 public:
  // An error (kUsage) names what is wrong: the figure or the number.
  static Result<QualityGate> parse(std::string_view text);
  static Result<QualityGate> make(std::string_view figure, std::string_view bound);

  const std::string& figure() const { return figure_; }
  // What is wrong with a mesh; nullopt if it passes.
  std::optional<std::string> violation(const v1::Summary& summary) const;

 private:
  QualityGate(std::string figure, double bound) : figure_(std::move(figure)), bound_(bound) {}

  std::string figure_;
  double bound_;
};

}  // namespace weft::client
