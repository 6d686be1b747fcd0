// SPDX-License-Identifier: Apache-2.0
#include "client/report/watch_job.h"

#include <utility>

#include "client/report/job_text.h"

namespace weft::client {

Result<v1::Job> watch_job(JobServer& server, const std::string& id,
                          const std::function<void(const v1::Job&)>& on_job) {
  v1::WatchJobRequest request;
  request.set_id(id);
  Retry retry = server.retry();
  v1::Job job;
  std::string said;  // the bytes of the last `job`
  for (;;) {
    JobServer::Attempt attempt(server);
    const auto stream = server.stub().WatchJob(&attempt.context(), request);
    v1::WatchJobResponse message;
    while (stream->Read(&message)) {
      // A new watch begins with the state that the last one ended with.
      std::string bytes = message.job().SerializeAsString();
      if (bytes == said) continue;
      said = std::move(bytes);
      job = std::move(*message.mutable_job());
      retry.restart();
      if (on_job) on_job(job);
    }
    grpc::Status status = stream->Finish();
    if (is_final(job.state())) return job;
    if (status.ok()) status = {grpc::StatusCode::UNAVAILABLE, "the watch ended before the job"};
    if (!retry.again(status)) return tl::unexpected(server.error_of(status));
  }
}

}  // namespace weft::client
