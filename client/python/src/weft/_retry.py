# SPDX-License-Identifier: Apache-2.0
"""When a call is made again, as client/call/retry.h has it: if the server was away (UNAVAILABLE),
or if it says itself that the same call may succeed later, as when its queue is full. Each wait
is twice as long as the one before, as long as nothing new comes, and at least as long as the server
asks for; a quarter more or less by chance.
"""

from __future__ import annotations

import logging
import random
import time

from .errors import DeadlineExceeded, ServerError, Unavailable

_FIRST, _LONGEST, _LONGEST_ASKED = 0.1, 5.0, 60.0
_log = logging.getLogger("weft")


class Retry:
    """Of one call; not thread-safe. `timeout`: seconds of all attempts together."""

    def __init__(self, attempts: int, timeout: float | None, target: str) -> None:
        self._attempts = attempts
        self._deadline = None if timeout is None else time.monotonic() + timeout
        self._target = target
        self._failures = 0

    def time_left(self) -> float | None:
        """Seconds that the next attempt may take. Raises DeadlineExceeded if there are none."""
        if self._deadline is None:
            return None
        left = self._deadline - time.monotonic()
        if left <= 0:
            raise DeadlineExceeded(f"the call to {self._target} took longer than its time-out",
                                   code="DEADLINE_EXCEEDED")
        return left

    def wait_after(self, error: ServerError) -> float:
        """Seconds to wait before the next attempt; raises the error if it was the last."""
        asked = error.retry_after
        if self._failures >= self._attempts or (asked is None and not isinstance(error, Unavailable)):
            raise error
        wait = max(min(_FIRST * 2.0 ** min(self._failures, 20), _LONGEST), min(asked or 0, _LONGEST_ASKED))
        wait *= random.uniform(0.75 if asked is None else 1.0, 1.25)
        if self._deadline is not None and time.monotonic() + wait >= self._deadline:
            raise error
        if self._failures == 0:
            _log.warning("%s; trying again", str(error).splitlines()[0])
        self._failures += 1
        return wait

    def restart(self) -> None:
        """A call brought something: the attempts count from 0 again."""
        self._failures = 0
