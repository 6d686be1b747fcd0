// SPDX-License-Identifier: Apache-2.0
#include "engine/size/expression/graph.h"

#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/size/expression/lanes.h"

namespace weft::expr {

namespace {

// Whether the operands may be swapped without a change of a bit, so that a+b and b+a are one node.
// Not kMin and kMax: of two zeros they give the second.
bool commutes(Op op) {
  return op == Op::kAdd || op == Op::kMultiply || op == Op::kEqual || op == Op::kNotEqual ||
         op == Op::kAnd || op == Op::kOr;
}

}  // namespace

NodeId Graph::constant(double value) {
  return intern({.op = Op::kConstant, .value = value});
}
NodeId Graph::input(std::uint16_t number) {
  return intern({.op = Op::kInput, .input = number});
}

NodeId Graph::truth_constant(bool value) {
  return intern({.op = value ? Op::kTrue : Op::kFalse});
}

NodeId Graph::number(NodeId a) {
  const Op op = nodes_[a].op;
  if (!is_truth(op)) return a;
  if (op == Op::kFalse || op == Op::kTrue) return constant(op == Op::kTrue ? 1 : 0);
  return intern({.op = Op::kToNumber, .args = {a}});
}

NodeId Graph::truth(NodeId a) {
  const Node& node = nodes_[a];
  if (is_truth(node.op)) return a;
  if (node.op == Op::kToNumber) return node.args[0];
  return binary(Op::kNotEqual, a, constant(0));
}

NodeId Graph::unary(Op op, NodeId a) {
  if (op == Op::kNot) {
    a = truth(a);
    const Op inner = nodes_[a].op;
    if (inner == Op::kFalse || inner == Op::kTrue) return truth_constant(inner == Op::kFalse);
    return intern({.op = op, .args = {a}});
  }
  a = number(a);
  if (is_constant(a)) {
    const double value = apply(op, 0, nodes_[a].value);
    return is_truth(op) ? truth_constant(value != 0) : constant(value);
  }
  return intern({.op = op, .args = {a}});
}

NodeId Graph::binary(Op op, NodeId a, NodeId b) {
  if (op == Op::kAnd || op == Op::kOr) return logical(op, a, b);
  a = number(a);
  b = number(b);
  if (is_constant(a) && is_constant(b)) {
    const double value = apply(op, nodes_[a].value, nodes_[b].value);
    return is_truth(op) ? truth_constant(value != 0) : constant(value);
  }
  // The bounds of a square are not negative; those of a product may be.
  if (op == Op::kMultiply && a == b) return intern({.op = Op::kPowN, .exponent = 2, .args = {a}});
  if (commutes(op) && b < a) std::swap(a, b);
  return intern({.op = op, .args = {a, b}});
}

NodeId Graph::logical(Op op, NodeId a, NodeId b) {
  a = truth(a);
  b = truth(b);
  const Op decisive = op == Op::kAnd ? Op::kFalse : Op::kTrue;
  const Op neutral = op == Op::kAnd ? Op::kTrue : Op::kFalse;
  if (nodes_[a].op == decisive || nodes_[b].op == neutral || a == b) return a;
  if (nodes_[b].op == decisive || nodes_[a].op == neutral) return b;
  if (b < a) std::swap(a, b);
  return intern({.op = op, .args = {a, b}});
}

NodeId Graph::select(NodeId condition, NodeId a, NodeId b) {
  condition = truth(condition);
  a = number(a);
  b = number(b);
  const Op op = nodes_[condition].op;
  if (op == Op::kTrue || a == b) return a;
  if (op == Op::kFalse) return b;
  if (op == Op::kNot) return select(nodes_[condition].args[0], b, a);
  return intern({.op = Op::kSelect, .args = {condition, a, b}});
}

NodeId Graph::power(NodeId a, NodeId b) {
  a = number(a);
  b = number(b);
  if (is_constant(b)) {
    const double exponent = nodes_[b].value;
    if (exponent == 0.5) return unary(Op::kSqrt, a);
    if (std::floor(exponent) == exponent && std::abs(exponent) <= kMaxPowN) {
      const int n = static_cast<int>(std::abs(exponent));
      if (n == 0) return constant(1);
      NodeId product = a;
      if (n > 1 && is_constant(a)) {
        product = constant(apply(Op::kPowN, n, nodes_[a].value));
      } else if (n > 1) {
        product = intern({.op = Op::kPowN, .exponent = n, .args = {a}});
      }
      return exponent > 0 ? product : binary(Op::kDivide, constant(1), product);
    }
  }
  if (is_constant(a) && nodes_[a].value == std::numbers::e) return unary(Op::kExp, b);
  return binary(Op::kPow, a, b);
}

NodeId Graph::intern(const Node& node) {
  const Key key{node.op,
                node.exponent,
                node.input,
                node.args[0],
                node.args[1],
                node.args[2],
                std::bit_cast<std::uint64_t>(node.value)};
  const auto [entry, is_new] = ids_.try_emplace(key, static_cast<NodeId>(nodes_.size()));
  if (is_new) nodes_.push_back(node);
  return entry->second;
}

}  // namespace weft::expr
