# SPDX-License-Identifier: Apache-2.0
"""The twin of weft.Client for asyncio: the same methods with `await`, the same errors.

    async with weft.aio.local() as client:
        mesh = await client.mesh("key.poly", size=0.1)
        async with client.stream("key.poly", size=0.01) as stream:
            async for chunk in stream: ...

Files of fields are read, and functions called that give sizes, in a thread of asyncio.to_thread. A call
that is cancelled ends at once, its thread once it has read the file or called the function.
"""

from __future__ import annotations

import asyncio
import contextlib
import functools
import os
from collections.abc import AsyncIterator, Callable, Iterable, Sequence
from types import TracebackType
from typing import Any, Self, Unpack

import grpc

from . import _jobs, _protocol, errors, results
from ._channel import ClientBase, StreamBase
from ._receiver import MeshReceiver
from ._requests import MeshOptions, job_request, stream_request
from ._warning import in_thread
from ._wire import Chunk
from .domain import DomainLike
from .local import LocalServer
from ._mesh import Mesh
from .results import Job, JobState, Progress, ServerInfo
from .size import Size


class Client(ClientBase):
    """See weft.Client. For one event loop, in which it must be made."""

    _grpc = grpc.aio

    async def close(self) -> None:
        """See weft.Client.close."""
        if self._own_channel.is_own():
            await self._channel.close()

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, *exception: object) -> None:
        await self.close()

    async def mesh(self, domain: DomainLike, size: Size = None, min_angle: float = 20, *,
                   on_progress: Callable[[Progress], object] | None = None,
                   timeout: float | None = None, **options: Unpack[MeshOptions]) -> Mesh:
        """See weft.Client.mesh, which explains every option; help(client.mesh) shows it."""
        async with self.stream(domain, size, min_angle, on_progress=on_progress, timeout=timeout,
                               **options) as stream:
            return await stream.mesh()

    def stream(self, domain: DomainLike, size: Size = None, min_angle: float = 20, *,
               on_progress: Callable[[Progress], object] | None = None,
               timeout: float | None = None, **options: Unpack[MeshOptions]) -> MeshStream:
        """See weft.Client.stream."""
        make = functools.partial(stream_request, domain, size, min_angle, options)
        return MeshStream(self, _protocol.GENERATE_MESH, make, timeout, on_progress)

    async def server_info(self) -> ServerInfo:
        """See weft.Client.server_info."""
        return results.server_info(await self._call(_protocol.GET_SERVER_INFO))

    async def submit(self, domain: DomainLike, size: Size = None, min_angle: float = 20, *,
                     request_id: str | None = None, notify: str | None = None,
                     timeout: float | None = None, **options: Unpack[MeshOptions]) -> Job:
        """See weft.Client.submit."""
        mesh = await in_thread(job_request, domain, size, min_angle, options)
        answer = await self._call(_protocol.SUBMIT_JOB, timeout, mesh=mesh, no_cache=mesh.no_cache,
                                  request_id=_jobs.request_id(request_id), notify=notify or "")
        return results.job(answer.job)

    async def get_job(self, job: Job | str) -> Job:
        """See weft.Client.get_job."""
        return results.job((await self._call(_protocol.GET_JOB, id=_jobs.id_of(job))).job)

    async def list_jobs(self, states: Iterable[JobState] = (),
                        limit: int | None = None) -> list[Job]:
        """See weft.Client.list_jobs."""
        pages = _jobs.Pages(states, limit)
        while pages.wanted():
            pages.take(await self._call(_protocol.LIST_JOBS, **pages.request()))
        return pages.jobs

    async def watch(self, job: Job | str, timeout: float | None = None) -> AsyncIterator[Job]:
        """See weft.Client.watch."""
        watch = _jobs.Watch()
        retry = self._retry(timeout)
        while True:
            call = self._stream(_protocol.WATCH_JOB, retry, id=_jobs.id_of(job))
            try:
                async for message in call:
                    if (seen := watch.take(message.job)) is not None:
                        retry.restart()
                        yield seen
                if watch.ended:
                    return
                error: errors.ServerError = errors.Unavailable(
                    f"the server {self.target} ended the watch before the job", code="UNAVAILABLE")
            except grpc.RpcError as broken:
                if watch.ended:
                    return
                error = errors.of_call(broken, self.target)
            finally:
                call.cancel()
            await self._wait(retry.wait_after(error))

    async def wait(self, job: Job | str, *, on_progress: Callable[[Progress], object] | None = None,
                   timeout: float | None = None) -> Job:
        """See weft.Client.wait."""
        async for seen in self.watch(job, timeout):
            if on_progress and seen.progress:
                on_progress(seen.progress)
        if seen.error:
            raise seen.error
        return seen

    async def cancel(self, job: Job | str) -> Job:
        """See weft.Client.cancel."""
        return results.job((await self._call(_protocol.CANCEL_JOB, id=_jobs.id_of(job))).job)

    async def delete(self, job: Job | str) -> None:
        """See weft.Client.delete."""
        await self._call(_protocol.DELETE_JOB, id=_jobs.id_of(job))

    async def fetch(self, job: Job | str, timeout: float | None = None) -> Mesh:
        """See weft.Client.fetch."""
        async with self.stream_job(job, timeout) as stream:
            return await stream.mesh()

    def stream_job(self, job: Job | str, timeout: float | None = None) -> MeshStream:
        """See weft.Client.stream_job."""
        request = _protocol.FETCH_MESH.request(id=_jobs.id_of(job))
        return MeshStream(self, _protocol.FETCH_MESH, lambda: (request, MeshReceiver()), timeout, None)

    async def _wait(self, seconds: float) -> None:
        async def keep_connecting() -> None:
            # A connection comes back only while someone waits for it.
            while True:
                await self._channel.wait_for_state_change(self._channel.get_state(True))
        with contextlib.suppress(asyncio.TimeoutError):
            await asyncio.wait_for(keep_connecting(), seconds)

    async def _call(self, method: _protocol.Method, timeout: float | None = None,
                    **fields: Any) -> Any:
        call = self._channel.unary_unary(method.path, method.request.SerializeToString,
                                         method.response.FromString)
        retry = self._retry(timeout)
        repeated = False
        while True:
            try:
                return await call(method.request(**fields), timeout=retry.time_left(),
                                  metadata=self._metadata)
            except grpc.RpcError as broken:
                error = errors.of_call(broken, self.target, fields.get("mesh"))
            # Where the answer to the first attempt was lost, the job may be gone already.
            if repeated and method is _protocol.DELETE_JOB and isinstance(error, errors.NotFound):
                return method.response()
            await self._wait(retry.wait_after(error))
            repeated = True


class MeshStream(StreamBase, AsyncIterator[Chunk]):
    """See weft.MeshStream. The request is made once its context is entered, or its first chunk is
    awaited, in a thread: that is where errors of files come, and where a function of x and y is
    called."""

    def __init__(self, client: Client, method: _protocol.Method,
                 make: Callable[[], tuple[Any, MeshReceiver]], timeout: float | None,
                 on_progress: Callable[[Progress], object] | None) -> None:
        super().__init__(client, method, None, MeshReceiver(), on_progress)
        self._client: Client = client
        self._make = make
        self._timeout = timeout

    async def mesh(self) -> Mesh:
        """Receives what is left and gives the whole mesh, also the chunks iterated over before."""
        async for _ in self:
            pass
        return await in_thread(self._receiver.mesh)

    async def __aenter__(self) -> Self:
        await self._prepare()
        return self

    async def __aexit__(self, kind: type[BaseException] | None, value: BaseException | None,
                        traceback: TracebackType | None) -> None:
        self.close()

    def __aiter__(self) -> Self:
        return self

    async def _prepare(self) -> None:
        if self._request is None:
            self._request, self._receiver = await in_thread(self._make)
            self._retry = self._client._retry(self._timeout)

    async def __anext__(self) -> Chunk:
        await self._prepare()
        while self._receiver.summary is None:
            try:
                message = await self._open().read()
            except grpc.RpcError as broken:
                await self._client._wait(self._wait_after(broken))
                continue
            if message is grpc.aio.EOF:
                raise errors.DamagedStream("the stream is damaged: it ended without a summary")
            if (chunk := self._receive(message)) is not None:
                return chunk
        await self._finish()
        raise StopAsyncIteration

    async def _finish(self) -> None:
        """Lets the call end by itself. What follows the summary does not matter: the mesh is whole."""
        call, self._call = self._call, None
        if call is not None:
            with contextlib.suppress(grpc.RpcError):
                while await call.read() is not grpc.aio.EOF:
                    pass


@contextlib.asynccontextmanager
async def local(weftd: str | os.PathLike[str] | None = None,
                arguments: Sequence[str] = ()) -> AsyncIterator[Client]:
    """See weft.local."""
    server = await asyncio.to_thread(LocalServer, weftd, arguments)
    try:
        async with Client(server.target, token="", retries=0) as client:
            yield client
    finally:
        await asyncio.to_thread(server.close)
