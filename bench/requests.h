// SPDX-License-Identifier: GPL-3.0-or-later
// What the benchmarks of the service share: requests and connections.
#pragma once

#include <grpcpp/grpcpp.h>

#include <limits>
#include <memory>
#include <string>

#include "weft/pslg.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::bench {

// To be meshed anew each time.
inline v1::GenerateMeshRequest make_request(const Pslg& pslg, const std::string& size) {
  v1::GenerateMeshRequest request;
  request.set_no_cache(true);
  v1::Domain& domain = *request.mutable_domain();
  for (const Point p : pslg.points) {
    domain.add_points(p.x);
    domain.add_points(p.y);
  }
  for (const Segment& s : pslg.segments) {
    domain.add_segments(s.a);
    domain.add_segments(s.b);
  }
  for (const Point p : pslg.holes) {
    domain.add_holes(p.x);
    domain.add_holes(p.y);
  }
  request.mutable_size()->set_expression(size);
  return request;
}

// A connection that no other caller shares.
inline std::shared_ptr<grpc::Channel> connect(const std::string& address) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(std::numeric_limits<int>::max());
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  const auto channel =
      grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
  channel->WaitForConnected(std::chrono::system_clock::now() + std::chrono::seconds(10));
  return channel;
}

}  // namespace weft::bench
