# SPDX-License-Identifier: Apache-2.0
"""A channel to a server, for the process that opened it.

gRPC does not survive a fork: both processes would read the one connection, and the child hangs.
"""

from __future__ import annotations

import os
from typing import Any

from . import _target
from .errors import WeftError


class OwnChannel:
    """`grpc`: the module whose channel it is, grpc or grpc.aio."""

    def __init__(self, grpc: Any, connection: _target.Connection) -> None:
        self._process = os.getpid()
        if connection.credentials is None:
            self._channel = grpc.insecure_channel(connection.target, connection.options)
        else:
            self._channel = grpc.secure_channel(connection.target, connection.credentials, connection.options)

    def is_own(self) -> bool:
        """Whether this process opened it."""
        return os.getpid() == self._process

    def get(self) -> Any:
        """The channel. Raises WeftError in another process."""
        if not self.is_own():
            raise WeftError(f"this client is that of process {self._process}, and does not work in a fork of it: "
                            "make a Client in each process")
        return self._channel
