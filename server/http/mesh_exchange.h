// SPDX-License-Identifier: Apache-2.0
// PUT or POST /v1/mesh: the body is the file of a domain, the answer that of its mesh.
//
// The body is read into memory, bounded as a message of gRPC is, and becomes the request of a
// GenerateMesh call within the process, which is admitted as every other. The chunks go to nameless
// files, and from there, once all are there, into the file that is sent. What takes long is done by
// the workers.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "server/console/bridge_call.h"
#include "server/console/exchange.h"
#include "server/http/domain_file.h"
#include "server/http/exchange_parts.h"
#include "server/http/mesh_file.h"
#include "server/http/mesh_wish.h"
#include "server/http/target.h"

namespace weft::server {

class MeshExchange final : public Exchange,
                           private BridgeCall::Listener,
                           public std::enable_shared_from_this<MeshExchange> {
 public:
  // Problems: those of read_wish; 406 for an Accept of nothing that is written; 413 and 429 before
  // the body. `target`: its path may end in the name of the file.
  static Outcome<std::shared_ptr<MeshExchange>> open(ExchangeParts& parts, const Target& target,
                                                     Visit& visit);

  bool wants_body() const override { return true; }
  bool take(std::string_view bytes) override;
  void body_ended() override;
  void body_late() override;
  void drop() override;

 private:
  MeshExchange(ExchangeParts& parts, MeshWish wish, Query query, Visit& visit,
               std::unique_ptr<Meshes::Place> place);

  template <class Task, class Then>
  void work(bool is_long, Task task, Then then);
  // Whether work on the whole mesh takes long.
  bool is_large() const;
  void begin_call(SentDomain sent, std::shared_ptr<files::MeshSpool> spool);
  void wrote(bool ok) override;
  void received(grpc::ByteBuffer message) override;
  void ended(const grpc::Status& status, const Metadata& trailers) override;
  void write_file();
  void answer(MeshFile file);
  // Ends the call, if there is one.
  void refuse(const Problem& problem);
  Problem too_large() const;

  ExchangeParts& parts_;
  MeshWish wish_;
  const Query query_;
  const std::string client_;
  const Metadata metadata_;
  const std::unique_ptr<Meshes::Place> place_;
  std::shared_ptr<Client> answers_to_;  // null once it has its answer, or is gone
  std::string content_type_;
  std::string stem_ = "mesh";  // of the name of the file that is sent
  HeldBytes held_;
  DomainFile file_;
  std::stop_source stop_;

  std::shared_ptr<const SentDomain> sent_;
  std::shared_ptr<files::MeshSpool> spool_;
  std::optional<v1::Summary> summary_;
  std::shared_ptr<BridgeCall> call_;
};

}  // namespace weft::server
