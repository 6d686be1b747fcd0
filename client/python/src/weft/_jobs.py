# SPDX-License-Identifier: Apache-2.0
"""What is the same about jobs for both clients."""

from __future__ import annotations

import uuid
from collections.abc import Iterable
from typing import Any

from . import results
from .errors import DamagedStream
from .results import Job, JobState

# Of jobs whose errors are as long as they get, a page stays below what gRPC takes in a message.
_LARGEST_PAGE = 500


def id_of(job: Job | str) -> str:
    return job if isinstance(job, str) else job.id


def request_id(given: str | None) -> str:
    """With one a submission whose answer was lost can be sent again."""
    return given or f"weft-{uuid.uuid4().hex}"


class Watch:
    """What a watch has shown; another watch begins with what the last one ended with."""

    def __init__(self) -> None:
        self._said = b""
        self.ended = False

    def take(self, message: Any) -> Job | None:
        """The job, unless it is as it was."""
        said = message.SerializeToString(deterministic=True)
        if said == self._said:
            return None
        self._said = said
        job = results.job(message)
        self.ended = job.state.is_final
        return job


class Pages:
    """A list of jobs, page by page."""

    def __init__(self, states: Iterable[JobState], limit: int | None) -> None:
        self._states = [state.number for state in states]
        self._limit = limit
        self._token: str | None = ""
        self.jobs: list[Job] = []

    def _left(self) -> int:
        return _LARGEST_PAGE if self._limit is None else self._limit - len(self.jobs)

    def wanted(self) -> bool:
        """Whether another page is."""
        return self._token is not None and self._left() > 0

    def request(self) -> dict[str, Any]:
        """The fields of the next ListJobsRequest."""
        return {"states": self._states, "page_size": min(self._left(), _LARGEST_PAGE),
                "page_token": self._token}

    def take(self, answer: Any) -> None:
        """Takes a page."""
        self.jobs += [results.job(job) for job in answer.jobs[:self._left()]]
        if answer.next_page_token and answer.next_page_token == self._token:
            raise DamagedStream("the server sends one page of jobs again and again")
        self._token = answer.next_page_token or None
