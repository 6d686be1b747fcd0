// SPDX-License-Identifier: Apache-2.0
#include "engine/size/gradation/border_graded_size.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace weft {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// More than the few operations of a comparison round.
constexpr double kSlack = 1e-12;

}  // namespace

// Halves pieces of the range of distances until the size over each piece is
//   - gentle: it grows by at most G everywhere;
//   - dropped: all of it is above what grows from an earlier step;
//   - or a step: G times the piece is at most kTolerance times its least edge.
class StepFinder {
 public:
  using Step = BorderGradedSize::Step;

  StepFinder(const SizeFunction& profile, double gradation, const ExecutionContext& context)
      : profile_(profile), gradation_(gradation), context_(context) {}

  // The steps, by `from`; empty if they cannot describe the limit.
  Result<std::vector<Step>> run(double farthest);

 private:
  static constexpr std::size_t kMaxPieces = std::size_t{1} << 14;
  static constexpr int kMaxDepth = 48;

  struct Open {
    double from;
    double to;
    int depth;
  };
  // `limit` is no lower than the limited size at any distance of the piece.
  struct Piece {
    double from;
    double to;
    double least;
    double limit;
  };

  // Whether the piece need not be divided.
  bool settle(const Open& open);
  bool looks_ahead() const;

  const SizeFunction& profile_;
  const double gradation_;
  const ExecutionContext& context_;
  std::vector<Piece> pieces_;
  std::vector<Step> steps_;
};

bool StepFinder::settle(const Open& open) {
  const Box at{open.from, 0, open.to, 0};
  const Interval areas = profile_.bounds(at);
  if (areas.may_be_nan || !(areas.lo > 0) || !(areas.hi < kInfinity)) return false;
  const double lo = SizeFunction::edge_of_area(areas.lo);
  const double hi = SizeFunction::edge_of_area(areas.hi);
  const Step* const last = steps_.empty() ? nullptr : &steps_.back();
  const auto grown = [&](double d) {
    return last ? last->edge + gradation_ * std::max(0.0, d - last->to) : kInfinity;
  };
  const double length = open.to - open.from;
  double limit = grown(open.to);
  if (!(lo >= limit)) {
    if (hi == lo || profile_.edge_steepness(at) <= gradation_ * (1 + kSlack)) {
      limit = std::min(limit, hi);
    } else if (gradation_ * length <= BorderGradedSize::kTolerance * lo) {
      limit = std::min(lo, grown(open.from));
      steps_.push_back({open.from, open.to, limit});
    } else {
      return false;
    }
  }
  pieces_.push_back({open.from, open.to, lo, limit});
  return true;
}

// Whether a piece may limit another one that is nearer to the border.
bool StepFinder::looks_ahead() const {
  double limit = kInfinity;  // at the end of the piece, from all pieces beyond it
  for (std::size_t i = pieces_.size(); i-- > 0;) {
    const Piece& piece = pieces_[i];
    if (piece.limit > limit * (1 + kSlack)) return true;
    limit = std::min(piece.least, limit + gradation_ * (piece.to - piece.from));
  }
  return false;
}

Result<std::vector<BorderGradedSize::Step>> StepFinder::run(double farthest) {
  std::vector<Open> open{{0, farthest, 0}};  // the nearest to the border last
  while (!open.empty()) {
    if (auto error = context_.poll()) return tl::unexpected(*error);
    const Open at = open.back();
    open.pop_back();
    if (settle(at)) continue;
    if (at.depth == kMaxDepth || pieces_.size() + open.size() > kMaxPieces)
      return std::vector<Step>();
    const double middle = at.from + 0.5 * (at.to - at.from);
    open.push_back({middle, at.to, at.depth + 1});
    open.push_back({at.from, middle, at.depth + 1});
  }
  if (looks_ahead()) return std::vector<Step>();
  steps_.shrink_to_fit();
  return std::move(steps_);
}

Result<std::unique_ptr<const BorderGradedSize>> BorderGradedSize::make(
    const SizeFunction& size, const Field& distance, Lines lines, double gradation, const Box& box,
    const ExecutionContext& context) {
  auto profile = size.along(distance);
  if (!profile) return nullptr;
  const double farthest = distance.bounds(box).hi;
  if (!(farthest > 0 && farthest < kInfinity)) return nullptr;
  auto steps = StepFinder(*profile, gradation, context).run(farthest);
  if (!steps) return tl::unexpected(std::move(steps).error());
  if (steps->empty()) return nullptr;
  std::unique_ptr<BorderGradedSize> made(
      new BorderGradedSize(size, distance, std::move(profile), gradation));
  made->steps_ = std::move(*steps);
  if (lines == Lines::kInDomain && !made->grows_from_lines_alone()) return nullptr;
  return made;
}

// The step must not be lower than the size on the lines, as one that falls first is.
bool BorderGradedSize::grows_from_lines_alone() const {
  const double on_lines = edge_of_area((*profile_)({0, 0}));
  return steps_.size() == 1 && steps_[0].from == 0 && on_lines <= steps_[0].edge * (1 + kTolerance);
}

const BorderGradedSize::Step* BorderGradedSize::step_at(double distance) const noexcept {
  const auto after = std::upper_bound(steps_.begin(), steps_.end(), distance,
                                      [](double d, const Step& step) { return d < step.from; });
  return after == steps_.begin() ? nullptr : &*(after - 1);
}

double BorderGradedSize::grown(const Step& step, double distance) const noexcept {
  return step.edge + gradation_ * std::max(0.0, distance - step.to);
}

void BorderGradedSize::evaluate(std::size_t n, const double* x, const double* y,
                                double* out) const noexcept {
  alignas(64) std::array<double, kLanes> distance;
  alignas(64) const std::array<double, kLanes> zero{};
  for (std::size_t i = 0; i < n; i += kLanes) {
    distance_->evaluate(kLanes, x + i, y + i, distance.data());
    profile_->evaluate(kLanes, distance.data(), zero.data(), out + i);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const Step* const step = step_at(distance[lane]);
      if (step != nullptr) out[i + lane] = least(out[i + lane], grown(*step, distance[lane]));
    }
  }
}

// The limited size does not fall as the distance grows, except by what `make` rounds.
double BorderGradedSize::edge_steepness(const Box&) const noexcept {
  return steps_.size() == 1 && steps_[0].from == 0 ? gradation_ : kInfinity;
}

Interval BorderGradedSize::bounds(const Box& box) const noexcept {
  constexpr double kRounding = 1e-11;
  const Interval distance = distance_->bounds(box);
  const Interval size = profile_->bounds({distance.lo, 0, distance.hi, 0});
  if (size.lo > size.hi || distance.hi < steps_.front().from) return size;
  const Step* const step = step_at(distance.lo);
  const double lo = step != nullptr ? area_of_edge(grown(*step, distance.lo)) : size.lo;
  const double hi = step != nullptr ? area_of_edge(grown(*step, distance.hi)) : kInfinity;
  if (lo * (1 - kRounding) > size.hi) return size;
  const double lowest = std::min(size.lo, lo);
  return {lowest - kRounding * std::fabs(lowest), std::min(size.hi, hi * (1 + kRounding)),
          size.may_be_nan};
}

}  // namespace weft
