// SPDX-License-Identifier: Apache-2.0
// A request without a body that is one unary call within the process, answered with its message as
// JSON.
#pragma once

#include <google/protobuf/message.h>

#include <memory>
#include <string>

#include "server/console/bridge_call.h"
#include "server/console/exchange.h"
#include "server/http/exchange_parts.h"

namespace weft::server {

class CallExchange final : public Exchange,
                           private BridgeCall::Listener,
                           public std::enable_shared_from_this<CallExchange> {
 public:
  // `method` is that of the call, `request` its message, `response` an empty one of its type.
  CallExchange(ExchangeParts& parts, std::string method, std::string request,
               std::unique_ptr<google::protobuf::Message> response, Visit& visit);

  bool wants_body() const override { return false; }
  bool take(std::string_view) override { return false; }
  void body_ended() override;
  void body_late() override {}
  void drop() override;

 private:
  void wrote(bool ok) override;
  void received(grpc::ByteBuffer message) override;
  void ended(const grpc::Status& status, const Metadata& trailers) override;

  ExchangeParts& parts_;
  const std::string method_;
  const std::string request_;
  const std::unique_ptr<google::protobuf::Message> response_;
  const Metadata metadata_;
  std::shared_ptr<Client> answers_to_;
  std::shared_ptr<BridgeCall> call_;
};

}  // namespace weft::server
