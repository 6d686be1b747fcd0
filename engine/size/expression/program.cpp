// SPDX-License-Identifier: Apache-2.0
#include "engine/size/expression/program.h"

#include <algorithm>
#include <span>
#include <string>

#include "engine/base/geometry.h"

namespace weft::expr {

namespace {

constexpr const char* kField = "size.expression";

std::span<const NodeId> args_of(const Node& node) {
  return {node.args.data(), static_cast<std::size_t>(arity(node.op))};
}

// Children by registers needed, most first.
std::vector<NodeId> evaluation_order(const Node& node, const std::vector<std::uint32_t>& need) {
  std::vector<NodeId> children(args_of(node).begin(), args_of(node).end());
  std::stable_sort(children.begin(), children.end(),
                   [&](NodeId a, NodeId b) { return need[a] > need[b]; });
  return children;
}

// The Sethi-Ullman numbers: leaves cost nothing, they are operands of any instruction.
std::vector<std::uint32_t> registers_needed(const Graph& graph) {
  std::vector<std::uint32_t> need(graph.size(), 0);
  for (NodeId id = 0; id < graph.size(); ++id) {
    std::uint32_t held = 0;
    for (NodeId child : evaluation_order(graph[id], need)) {
      need[id] = std::max({need[id], need[child] + held, 1u});
      ++held;
    }
  }
  return need;
}

// The operations that the root depends on, each after its arguments. Iterative: a sum of
// thousands of terms is thousands deep.
std::vector<NodeId> schedule(const Graph& graph, NodeId root) {
  struct Visit {
    NodeId id;
    std::vector<NodeId> children;
    std::size_t next = 0;
  };
  const std::vector<std::uint32_t> need = registers_needed(graph);
  std::vector<bool> seen(graph.size(), false);
  std::vector<NodeId> order;
  std::vector<Visit> path;
  const auto enter = [&](NodeId id) {
    if (seen[id] || arity(graph[id].op) == 0) return;
    seen[id] = true;
    path.push_back({id, evaluation_order(graph[id], need)});
  };
  enter(root);
  while (!path.empty()) {
    Visit& visit = path.back();
    if (visit.next < visit.children.size()) {
      enter(visit.children[visit.next++]);
    } else {
      order.push_back(visit.id);
      path.pop_back();
    }
  }
  return order;
}

// Where a node's value is computed and how long it is wanted.
struct Lifetime {
  std::uint32_t computed = kNone;
  std::uint32_t last_use = 0;
  bool used_later = false;  // by an instruction after the next one
  std::uint16_t reg = 0;
};

class Allocator {
 public:
  Allocator(const Graph& graph, const std::vector<NodeId>& order, std::size_t inputs)
      : graph_(graph), order_(order), lives_(graph.size()), registers_(inputs) {
    for (std::uint32_t at = 0; at < order_.size(); ++at) {
      lives_[order_[at]].computed = at;
      for (NodeId arg : args_of(graph_[order_[at]])) {
        Lifetime& life = lives_[arg];
        life.last_use = at;
        life.used_later |= at != life.computed + 1;
      }
    }
  }

  Result<Program> run(std::size_t max_registers) {
    Program program;
    program.reserve(order_.size());
    for (std::uint32_t at = 0; at < order_.size(); ++at) {
      const Node& node = graph_[order_[at]];
      Instruction instruction{.op = node.op, .exponent = node.exponent};
      for (int i = 0; i < arity(node.op); ++i) instruction.operands[i] = operand(node.args[i], at);
      // An operand's register may take the result: lanes are read before they are written.
      release(node, at);
      Lifetime& life = lives_[order_[at]];
      if (life.used_later) {
        life.reg = take();
        instruction.store = life.reg;
      }
      program.push_back(instruction);
    }
    if (registers_ > max_registers) {
      return fail(ErrorCode::kExpressionTooComplex, kField,
                  "the size expression needs " + std::to_string(registers_) +
                      " values at once; the limit is " + std::to_string(max_registers));
    }
    return program;
  }

 private:
  Operand operand(NodeId id, std::uint32_t at) const {
    using From = Operand::From;
    const Node& node = graph_[id];
    if (node.op == Op::kConstant) return {.from = From::kConstant, .value = node.value};
    if (node.op == Op::kInput) return {.from = From::kRegister, .reg = node.input};
    if (lives_[id].computed + 1 == at) return {.from = From::kAccumulator};
    return {.from = From::kRegister, .reg = lives_[id].reg};
  }

  void release(const Node& node, std::uint32_t at) {
    for (NodeId arg : args_of(node)) {
      Lifetime& life = lives_[arg];
      if (arity(graph_[arg].op) == 0 || !life.used_later || life.last_use != at) continue;
      free_.push_back(life.reg);
      life.used_later = false;  // released once, even if it is two operands of this node
    }
  }

  std::uint16_t take() {
    if (free_.empty()) return static_cast<std::uint16_t>(registers_++);
    const std::uint16_t reg = free_.back();
    free_.pop_back();
    return reg;
  }

  const Graph& graph_;
  const std::vector<NodeId>& order_;
  std::vector<Lifetime> lives_;
  std::vector<std::uint16_t> free_;
  std::size_t registers_;
};

}  // namespace

Result<Program> compile(const Graph& graph, NodeId root, std::size_t inputs,
                        std::size_t max_operations, std::size_t max_registers) {
  const std::vector<NodeId> order = schedule(graph, root);
  if (order.size() > max_operations) {
    return fail(ErrorCode::kExpressionTooComplex, kField,
                "the size expression has " + std::to_string(order.size()) +
                    " operations; the limit is " + std::to_string(max_operations));
  }
  if (!order.empty()) return Allocator(graph, order, inputs).run(max_registers);
  // A bare input or constant.
  const Node& leaf = graph[root];
  Instruction copy{.op = Op::kCopy};
  copy.operands[0] = {
      .from = leaf.op == Op::kConstant ? Operand::From::kConstant : Operand::From::kRegister,
      .reg = leaf.input,
      .value = leaf.value};
  return Program{copy};
}

}  // namespace weft::expr
