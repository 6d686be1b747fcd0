// SPDX-License-Identifier: Apache-2.0
// A size that depends on the distance d to the domain's border alone, limited to a gradation as by
// graded_size.h, but without a search. With h(d) the length of edges,
//   h_G(p) = min over t <= d(p) of h(t) + G (d(p) - t),
// because no q is nearer to p than |d(p) - d(q)|, and because the straight walk from p to the
// nearest point of the border stays in the domain, so it meets each t on its way, d(p) - t from p.
// What lies farther from the border than p may not be there at all, so it must not matter: if it
// may, because h falls away from the border, `make` gives no size.
//
// The distance may be that to a part of the border, such as a coast without the open sea, or to
// lines in the domain. Then the walk to the nearest point may leave the domain; but that point
// itself, t = 0, is in it. So if the limit grows from t = 0 alone, the formula holds, too.
//
// A coast of 9,370 segments with 500 + 0.3 d and G = 0.15 has 281,517 sources by source_tree.h,
// which with their limit_tree.h take 3.5 s, and one step here.
//
// Never above the exact limit, but for rounding, and at most kTolerance below it.
// Thread-safety: immutable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/context.h"
#include "engine/size/size_function.h"
#include "weft/error.h"

namespace weft {

class BorderGradedSize final : public SizeFunction {
 public:
  static constexpr double kTolerance = 1e-3;

  // What the distance is to.
  enum class Lines : std::uint8_t {
    kWholeBorder,  // and lines besides that do not leave the domain, but where parts of the plane
                   // are cut off by such lines
    kInDomain,     // any that do not leave the domain
  };

  // Null if the size depends on more than the distance, has no value or no positive one somewhere,
  // keeps to the gradation by itself, or falls away from the border; of kInDomain, if it limits
  // itself anywhere but on the lines. REQUIRES: `size` and `distance` outlive the result; `box`
  // holds the domain; gradation > 0 and finite. Errors: those of the context.
  static Result<std::unique_ptr<const BorderGradedSize>> make(const SizeFunction& size,
                                                              const Field& distance, Lines lines,
                                                              double gradation, const Box& box,
                                                              const ExecutionContext& context);

  void evaluate(std::size_t n, const double* x, const double* y,
                double* out) const noexcept override;
  Interval bounds(const Box& box) const noexcept override;
  // The gradation, unless there are steps, where it jumps by up to kTolerance.
  double edge_steepness(const Box& box) const noexcept override;
  Asked asked_at(Point p) const override { return size_->asked_at(p); }
  std::size_t bytes() const noexcept override { return steps_.capacity() * sizeof(Step); }
  std::size_t operations() const noexcept override {
    return distance_->operations() + profile_->operations() + kOperations;
  }

 private:
  friend class StepFinder;

  static constexpr std::size_t kOperations = 40;

  // From the distance `from` on, the length of edges is at most edge + G max(0, d - to). `edge` is
  // what the step before it grows to at `from`, but for rounding.
  struct Step {
    double from;
    double to;
    double edge;
  };

  BorderGradedSize(const SizeFunction& size, const Field& distance,
                   std::unique_ptr<const SizeFunction> profile, double gradation)
      : size_(&size), distance_(&distance), profile_(std::move(profile)), gradation_(gradation) {}

  bool grows_from_lines_alone() const;
  const Step* step_at(double distance) const noexcept;  // null before the first
  double grown(const Step& step, double distance) const noexcept;

  const SizeFunction* size_;
  const Field* distance_;
  std::unique_ptr<const SizeFunction> profile_;  // h, of x
  double gradation_;
  std::vector<Step> steps_;  // by `from`; one at least
};

}  // namespace weft
