// SPDX-License-Identifier: Apache-2.0
// A request that is one unary call within the process, or some one after the other, answered with
// the message of the last as JSON.
#pragma once

#include <google/protobuf/message.h>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/console/bridge_call.h"
#include "server/console/exchange.h"
#include "server/console/problem.h"
#include "server/http/exchange_parts.h"

namespace weft::server {

struct UnaryCall {
  const char* method;  // "/weft.v1.JobService/GetJob"
  std::string request;
  std::unique_ptr<google::protobuf::Message> response;  // an empty one of its type
};

// Each may be empty. `dress` gets the answer to the last call, `explain` the problem of a call.
struct CallWords {
  std::function<void(Response&, const google::protobuf::Message&)> dress{};
  std::function<Problem(Problem)> explain{};
};

class CallExchange final : public Exchange,
                           private BridgeCall::Listener,
                           public std::enable_shared_from_this<CallExchange> {
 public:
  CallExchange(ExchangeParts& parts, std::vector<UnaryCall> calls, Metadata metadata,
               std::shared_ptr<Client> answers_to, CallWords words = {});

  bool wants_body() const override { return false; }
  bool take(std::string_view) override { return false; }
  // Begins.
  void body_ended() override;
  void body_late() override {}
  void drop() override;

 private:
  void begin_next();
  void wrote(bool ok) override;
  void received(grpc::ByteBuffer message) override;
  void ended(const grpc::Status& status, const Metadata& trailers) override;

  ExchangeParts& parts_;
  const std::vector<UnaryCall> calls_;
  std::size_t next_ = 0;
  const Metadata metadata_;
  const CallWords words_;
  std::shared_ptr<Client> answers_to_;
  std::shared_ptr<BridgeCall> call_;
};

}  // namespace weft::server
