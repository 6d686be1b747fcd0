// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/domain/edge_constraints.h"

#include <algorithm>

namespace weft {
namespace {

void merge(Arrangement::Constraint& into, const Arrangement::Constraint& other) {
  into.segment = std::min(into.segment, other.segment);
  if (other.marker_segment < into.marker_segment) {
    into.marker_segment = other.marker_segment;
    into.marker = other.marker;
  }
  into.odd = into.odd != other.odd;
}

}  // namespace

void EdgeConstraints::add(std::uint32_t a, std::uint32_t b, const Constraint& constraint) {
  const std::uint64_t k = key(a, b);
  Shard& table = shards_[shard(k)];
  if (4 * table.used >= 3 * table.slots.size()) table.grow();
  Slot& slot = table.slots[table.find(k)];
  if (slot.key == k) {
    merge(slot.constraint, constraint);
    return;
  }
  slot = {k, constraint};
  ++table.used;
  ++size_;
}

const EdgeConstraints::Constraint& EdgeConstraints::at(std::uint32_t a, std::uint32_t b) const {
  const std::uint64_t k = key(a, b);
  const Shard& table = shards_[shard(k)];
  return table.slots[table.find(k)].constraint;
}

EdgeConstraints::Constraint EdgeConstraints::take(std::uint32_t a, std::uint32_t b) {
  const std::uint64_t k = key(a, b);
  Shard& table = shards_[shard(k)];
  const std::size_t slot = table.find(k);
  const Constraint constraint = table.slots[slot].constraint;
  table.erase(slot);
  --size_;
  return constraint;
}

std::uint64_t EdgeConstraints::key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

// The finaliser of S. Vigna's splitmix64.
std::uint64_t EdgeConstraints::hash(std::uint64_t key) {
  key = (key ^ key >> 30) * 0xbf58476d1ce4e5b9u;
  key = (key ^ key >> 27) * 0x94d049bb133111ebu;
  return key ^ key >> 31;
}

std::size_t EdgeConstraints::Shard::home(std::uint64_t key) const {
  return hash(key) & (slots.size() - 1);
}

std::size_t EdgeConstraints::Shard::find(std::uint64_t key) const {
  std::size_t slot = home(key);
  while (slots[slot].key != key && slots[slot].key != kFree) slot = (slot + 1) & (slots.size() - 1);
  return slot;
}

void EdgeConstraints::Shard::grow() {
  std::vector<Slot> old(std::max<std::size_t>(8, 2 * slots.size()));
  old.swap(slots);
  for (const Slot& slot : old)
    if (slot.key != kFree) slots[find(slot.key)] = slot;
}

// Moves the edges behind the gap into it, as far as that brings them no further than their homes.
void EdgeConstraints::Shard::erase(std::size_t gap) {
  const std::size_t mask = slots.size() - 1;
  for (std::size_t next = (gap + 1) & mask; slots[next].key != kFree; next = (next + 1) & mask) {
    if (((next - home(slots[next].key)) & mask) < ((next - gap) & mask)) continue;
    slots[gap] = slots[next];
    gap = next;
  }
  slots[gap].key = kFree;
  --used;
}

}  // namespace weft
