// SPDX-License-Identifier: Apache-2.0
// Makes a SizeFunction of the size that a request gives: the one place that knows its kinds and
// those of the fields that it may name. What plans, refines or estimates sees a SizeFunction; a new
// kind is a type in weft/size.h, a file pair beside this one, and a case in size_spec.cpp.
//
//   Result<Size> size = make_size("0.01 + x^2", pslg, domain, context);
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "engine/base/context.h"
#include "engine/domain/domain.h"
#include "engine/size/field.h"
#include "engine/size/size_function.h"
#include "weft/error.h"
#include "weft/pslg.h"
#include "weft/size.h"

namespace weft {

// A size that can be evaluated, with all that it is made of.
class Size {
 public:
  explicit Size(std::unique_ptr<const SizeFunction> function) { add(std::move(function)); }

  const SizeFunction& function() const { return *layers_.back(); }
  // What the gradation limits, if distances across land may have made the limit lower than those
  // within the domain would; otherwise null.
  const SizeFunction* limited_across_land() const { return limited_; }
  std::size_t bytes() const;

  // Keeps what the function refers to.
  void keep(std::vector<std::unique_ptr<const Field>> fields) { fields_ = std::move(fields); }
  // `function` refers to what was the function until now.
  void add(std::unique_ptr<const SizeFunction> function) { layers_.push_back(std::move(function)); }
  // The same, for a limit across land to `size`.
  void limit(const SizeFunction& size, std::unique_ptr<const SizeFunction> function) {
    limited_ = &size;
    add(std::move(function));
  }

 private:
  std::vector<std::unique_ptr<const Field>> fields_;
  std::vector<std::unique_ptr<const SizeFunction>> layers_;
  const SizeFunction* limited_ = nullptr;
};

// Computes in the context's arena. REQUIRES: a raster satisfies its own requirements (raster.h),
// and `spec` outlives the result. Errors: those of check_size, those of the kinds for what is wrong
// in their arrays ("size.raster.values[i]", "size.fields[i].mesh.values[j]"), kBadOption for a
// marker that no segment has ("size.at[i].marker", "size.fields[i].distance.markers"),
// kBudgetExceeded, and those of the context.
Result<Size> make_size(const SizeSpec& spec, const Pslg& pslg, const Domain& domain,
                       const ExecutionContext& context);

// The same for a size that names no field and has no limit to its gradation: without the domain.
Result<Size> make_size(const SizeSpec::Value& value, Measure measure);

// Bytes of memory that make_size takes at most for `spec`, which itself is held already: for all
// but the width and the gradation, which ask the context themselves.
std::uint64_t bytes_to_make(const SizeSpec& spec, const Pslg& pslg);

}  // namespace weft
