// SPDX-License-Identifier: Apache-2.0
// Runs the commands on jobs as a user does, against a JobService in this process.
#pragma once

#include <string>

#include "tests/client/support/fake_jobs.h"
#include "tests/client/support/weft_process.h"

namespace weft::client {

class JobCommands : public WeftProcess {
 protected:
  // With the server named.
  int ask(const Words& words) { return run(words, {"WEFT_SERVER=" + fake_.address()}); }
  Words submit(const Words& more = {}) const {
    Words words = {"submit", folder_ / "in.poly"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  void plan(v1::JobState end) {
    jobs_.plan({sample_job("", v1::JOB_STATE_QUEUED), sample_job("", v1::JOB_STATE_RUNNING),
                sample_job("", end)});
  }

  JobsServer fake_{"unix:" + (folder_ / "s").string()};
  FakeJobs& jobs_ = fake_.jobs();
};

}  // namespace weft::client
