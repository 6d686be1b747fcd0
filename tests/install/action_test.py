# SPDX-License-Identifier: Apache-2.0
"""The action for GitHub: where several jobs of a run use it, each keeps its reports under a name of its own."""
import pathlib
import re

import yaml

ACTION = yaml.safe_load((pathlib.Path(__file__).resolve().parents[2] / "deploy/ci/action.yml").read_text())


def name_of(inputs, job, index):
    """What GitHub makes of the name of the artifact: a || b, and format()."""
    upload, = (step for step in ACTION["runs"]["steps"] if "upload-artifact" in step.get("uses", ""))
    template, = re.fullmatch(r"\$\{\{ inputs.artifact \|\| format\('([^']+)', github.job, strategy.job-index\) \}\}",
                             upload["with"]["name"]).groups()
    return inputs.get("artifact", ACTION["inputs"]["artifact"]["default"]) or template.format(job, index)


def test_the_jobs_of_a_run_keep_their_reports_apart():
    assert len({name_of({}, job, index) for job in ("coast", "plates") for index in range(3)}) == 6


def test_a_name_that_is_given_is_taken():
    assert name_of({"artifact": "coast"}, "job", 0) == "coast"


def test_every_input_is_used():
    text = str(ACTION["runs"])
    assert all(f"inputs.{name}" in text for name in ACTION["inputs"])
