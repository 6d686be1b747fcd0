// SPDX-License-Identifier: Apache-2.0
#include "server/front/arrival.h"

#include <array>
#include <string_view>
#include <utility>

#include "server/front/frames.h"

namespace weft::server {

using boost::system::error_code;
using Outcome = ClientSocket::Outcome;

Arrival::Arrival(ClientSocket client, List& list, const Ready& ready)
    : client_(std::move(client)), list_(list), ready_(ready) {}

void Arrival::start(std::shared_ptr<ConnectionTable::Connection> connection) {
  connection_ = std::move(connection);
  place_ = list_.insert(list_.end(), shared_from_this());
  step();
}

void Arrival::close() {
  if (connection_ == nullptr) return;
  connection_.reset();
  client_.close();
  leave_list();
}

void Arrival::step() {
  if (connection_ == nullptr) return;
  if (!encrypted_) {
    const Outcome outcome = client_.handshake();
    if (outcome == Outcome::kClosed) return close();
    if (outcome != Outcome::kDone) return wait(outcome);
    encrypted_ = true;
  }
  while (got_ < kClientPreface.size()) {
    std::array<char, kClientPreface.size()> bytes;
    const auto read = client_.read(bytes.data(), kClientPreface.size() - got_);
    if (read.outcome == Outcome::kClosed) return close();
    if (read.outcome != Outcome::kDone) return wait(read.outcome);
    if (kClientPreface.substr(got_, read.bytes) != std::string_view(bytes.data(), read.bytes))
      return close();
    got_ += read.bytes;
  }
  const auto self = leave_list();
  ready_(std::move(client_), std::exchange(connection_, nullptr));
}

void Arrival::wait(Outcome outcome) {
  const auto what = outcome == Outcome::kReads ? boost::asio::socket_base::wait_read
                                               : boost::asio::socket_base::wait_write;
  client_.socket().async_wait(what, [self = shared_from_this()](error_code error) {
    if (!error) self->step();
  });
}

std::shared_ptr<Arrival> Arrival::leave_list() {
  const auto self = std::move(*place_);
  list_.erase(place_);
  return self;
}

}  // namespace weft::server
