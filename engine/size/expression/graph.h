// SPDX-License-Identifier: Apache-2.0
// A size expression as a directed acyclic graph: equal subexpressions are one node, and those that
// depend on no input are folded while the graph is built.
//
// Folding and rewriting keep every bit of the value: constants are computed by the operations of
// lanes.h, and only truth values are simplified algebraically. An argument is converted between
// number and truth value if the operation needs the other kind (a number is true unless it is 0; a
// truth value is 1 or 0).
//
//   Graph graph;
//   NodeId r2 = graph.binary(Op::kAdd, graph.power(graph.input(0), graph.constant(2)), ...);
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "engine/size/expression/operation.h"

namespace weft::expr {

using NodeId = std::uint32_t;

struct Node {
  Op op = Op::kConstant;
  int exponent = 0;              // of kPowN
  std::uint16_t input = 0;       // of kInput: its number
  std::array<NodeId, 3> args{};  // the first arity(op) count; each is less than the node's own id
  double value = 0;              // of kConstant
};

class Graph {
 public:
  NodeId constant(double value);
  NodeId input(std::uint16_t number);
  NodeId unary(Op op, NodeId a);
  NodeId binary(Op op, NodeId a, NodeId b);
  NodeId select(NodeId condition, NodeId a, NodeId b);
  // a^b. A product if b is a constant integer from -16 to 16, sqrt if it is 0.5, exp if a is e.
  NodeId power(NodeId a, NodeId b);
  // `a` as a number.
  NodeId number(NodeId a);

  const Node& operator[](NodeId id) const { return nodes_[id]; }
  std::size_t size() const { return nodes_.size(); }

 private:
  using Key = std::tuple<Op, int, std::uint16_t, NodeId, NodeId, NodeId, std::uint64_t>;

  NodeId truth(NodeId a);
  NodeId truth_constant(bool value);
  NodeId logical(Op op, NodeId a, NodeId b);
  NodeId intern(const Node& node);
  bool is_constant(NodeId id) const { return nodes_[id].op == Op::kConstant; }

  std::vector<Node> nodes_;
  std::map<Key, NodeId> ids_;
};

}  // namespace weft::expr
