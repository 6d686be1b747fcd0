// SPDX-License-Identifier: Apache-2.0
// Floods of HTTP/2 by a caller without a token, each on one thread, over many connections, which
// are opened again as the server closes them.
//
//   const Flooded done = kFloods[0].run({"127.0.0.1:7421"}, [&] { return over.load(); });
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

namespace weft::e2e {

struct Target {
  std::string address;  // TCP
  bool encrypted = false;
};

struct Flooded {
  std::uint64_t connections = 0;           // that were opened
  std::uint64_t closed = 0;                // by the server
  std::map<std::uint32_t, int> goaways{};  // by their errors
};

struct Flood {
  const char* name;
  // Floods until `is_over`.
  Flooded (*run)(const Target& target, const std::function<bool()>& is_over);
};

// Of bare connections; of connections that have only said that they speak HTTP/2; of header blocks
// that never end; of health checks without an end; of resets; of unknown frames; of window updates;
// of settings; of pings.
extern const Flood kFloods[9];

}  // namespace weft::e2e
