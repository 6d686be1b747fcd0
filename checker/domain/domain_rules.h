// SPDX-License-Identifier: Apache-2.0
// Checks that a domain is well formed, so that a mesh of it can be judged at all.
#pragma once

#include "checker/domain.h"
#include "checker/report.h"

namespace weft::check {

// Coordinates that the checker computes with: 0, or of a magnitude in this range.
inline constexpr double kMinMagnitude = 1e-150;
inline constexpr double kMaxMagnitude = 1e150;
bool is_usable(double coordinate);

// Of an arc: 0 for a straight segment, and of a magnitude of 1e6 at most.
bool is_bulge(double bulge);

// Adds a violation of kDomain for every offender; returns false if there is one.
bool judge_domain(const Domain& domain, Findings& findings);

}  // namespace weft::check
