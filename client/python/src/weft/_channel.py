# SPDX-License-Identifier: Apache-2.0
"""What the client that blocks and the one for asyncio have in common: all that does not wait."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any, ClassVar

import grpc

from . import _protocol, _target, errors, results
from ._receiver import MeshReceiver
from ._retry import Retry
from ._wire import Chunk
from .errors import WeftError
from .results import Progress


class OwnChannel:
    """A channel to a server, for the process that opened it. gRPC does not survive a fork: both processes
    would read the one connection, and the child hangs. `grpc`: the module whose channel it is, grpc or
    grpc.aio."""

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


class ClientBase:
    _grpc: ClassVar[Any]  # grpc or grpc.aio

    def __init__(self, target: str | None = None, *, token: str | None = None,
                 tls: _target.TLS | bool | None = None, insecure: bool = False,
                 retries: int = 8) -> None:
        connection = _target.connection(target, token, tls, insecure)
        self.target = connection.target
        self._metadata = connection.metadata
        self._retries = retries
        self._own_channel = OwnChannel(self._grpc, connection)

    @property
    def _channel(self) -> Any:
        return self._own_channel.get()

    def _retry(self, timeout: float | None) -> Retry:
        return Retry(self._retries, timeout, self.target)

    def _stream(self, method: _protocol.Method, retry: Retry, **fields: Any) -> Any:
        call = self._channel.unary_stream(method.path, method.request.SerializeToString,
                                          method.response.FromString)
        return call(method.request(**fields), timeout=retry.time_left(), metadata=self._metadata)

    def _raw_stream(self, method: _protocol.Method, request: Any, retry: Retry) -> Any:
        call = self._channel.unary_stream(method.path, method.request.SerializeToString)
        return call(request, timeout=retry.time_left(), metadata=self._metadata)


class StreamBase:
    """The state of a MeshStream. A request that is None is made, with its receiver and its retry, before the
    first call."""

    _retry: Retry

    def __init__(self, client: ClientBase, method: _protocol.Method, request: Any, receiver: MeshReceiver,
                 on_progress: Callable[[Progress], object] | None) -> None:
        self._method = method
        self._request = request
        self._receiver = receiver
        self._on_progress = on_progress
        self._client = client
        self._call: Any = None

    @property
    def accepted(self) -> results.Accepted | None:
        """Which job it is, once the server admitted it."""
        return self._receiver.accepted

    @property
    def summary(self) -> results.Summary | None:
        """What the mesh is like, once all chunks are there."""
        return self._receiver.summary

    def close(self) -> None:
        """Ends the call; does nothing to a stream that has ended."""
        if self._call is not None:
            self._call.cancel()
            self._call = None

    def _open(self) -> Any:
        if self._call is None:
            self._request.first_chunk = self._receiver.chunks
            self._receiver.resume()
            self._call = self._client._raw_stream(self._method, self._request, self._retry)
        return self._call

    def _receive(self, message: bytes) -> Chunk | None:
        """The chunk of the message, if it is one."""
        try:
            came = self._receiver.receive(message)
        except BaseException:
            self.close()
            raise
        if isinstance(came, Chunk):
            self._retry.restart()
            return came
        if came and self._on_progress:
            self._on_progress(came)
        return None

    def _wait_after(self, broken: grpc.RpcError) -> float:
        """Seconds before the next call; raises the error if there is none."""
        self._call = None
        return self._retry.wait_after(errors.of_call(broken, self._client.target, self._request))
