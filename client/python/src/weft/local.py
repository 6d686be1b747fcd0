# SPDX-License-Identifier: Apache-2.0
"""A server of one's own."""

from __future__ import annotations

import contextlib
import os
import pathlib
import select
import shutil
import subprocess
import tempfile
import weakref
from collections.abc import Iterator, Sequence
from types import TracebackType
from typing import Self

from . import _carried
from .client import Client
from .errors import LocalServerError

_START_SECONDS = 30.0
_STOP_SECONDS = 5.0
_MOST_BYTES = 65536  # of addresses, as many as a pipe holds


class LocalServer:
    """A weftd on a unix socket in a temporary folder; ends with its context, or with this process.

    `weftd`: the program; default: $WEFT_WEFTD, or that which the package carries, or weftd in the
    PATH. `arguments`: more flags, such as ["--threads", "2", "--data", folder]. Raises
    LocalServerError if it does not start.

        with weft.LocalServer() as server, weft.Client(server.target) as client: ...
    """

    def __init__(self, weftd: str | os.PathLike[str] | None = None,
                 arguments: Sequence[str] = ()) -> None:
        program = os.fspath(weftd or os.environ.get("WEFT_WEFTD") or _carried.program("weftd") or "")
        if not program:
            raise LocalServerError("no private weftd: the package carries none, and it is not in the "
                                   "PATH; give its path, or WEFT_WEFTD")
        with contextlib.ExitStack() as stack:
            self.folder = _make_folder()
            stack.callback(shutil.rmtree, self.folder, ignore_errors=True)
            """Holds the socket and the log; is removed at the end."""
            self.target = f"unix:{self.folder}/socket"
            """What a Client takes."""
            self.addresses: list[str] = []
            """All at which it listens: `target`, those of --listen, metrics=HOST:PORT, console=HOST:PORT."""
            self._process = self._spawn(program, arguments)
            stack.callback(_end, self._process)
            self._wait_until_ready(program)
            self._finalizer = weakref.finalize(self, _close, stack.pop_all(), os.getpid())

    def close(self) -> None:
        """Stops the server; calls in it are cancelled. In a fork of the process that started it, does
        nothing."""
        self._finalizer()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, value: BaseException | None,
                 traceback: TracebackType | None) -> None:
        self.close()

    def _spawn(self, program: str, arguments: Sequence[str]) -> subprocess.Popen[bytes]:
        # Nothing that configures servers that others use, too: this one has its own limits, keeps no
        # jobs and has no certificate. A token is for a server that is named.
        environment = {k: v for k, v in os.environ.items()
                       if not k.startswith("WEFT_")}
        with open(self.folder / "log", "wb") as log:
            try:
                # A group of its own, so that Ctrl-C reaches us alone.
                return subprocess.Popen(
                    [program, "--listen", self.target, "--port-file", "-", "--exit-with-stdin",
                     "--drain", "1", *arguments], bufsize=0,
                    stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=log, env=environment,
                    process_group=0)
            except OSError as error:
                raise LocalServerError(f"no private weftd: {program}: {error.strerror}") from None

    def _wait_until_ready(self, program: str) -> None:
        assert self._process.stdout
        poll = select.poll()
        poll.register(self._process.stdout, select.POLLIN)
        # It writes them at once when it listens, and nothing before.
        heard = poll.poll(1000 * _START_SECONDS)
        if heard and (said := os.read(self._process.stdout.fileno(), _MOST_BYTES)):
            self.addresses = said.decode().split()
            return
        log = (self.folder / "log").read_text(errors="replace").splitlines()[-10:]
        what = "ended at start" if heard else f"is not ready after {_START_SECONDS:g} s"
        raise LocalServerError("\n  ".join([f"no private weftd: {program} {what}; it said:", *log]))


def _end(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    try:
        process.wait(_STOP_SECONDS)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
    assert process.stdin and process.stdout
    process.stdin.close()
    process.stdout.close()


def _close(cleanup: contextlib.ExitStack, owner: int) -> None:
    if os.getpid() == owner:
        cleanup.close()


def _make_folder() -> pathlib.Path:
    # A socket's path is short.
    base = tempfile.gettempdir()
    return pathlib.Path(tempfile.mkdtemp(prefix="weft-", dir=base if len(base) < 80 else "/tmp"))


@contextlib.contextmanager
def local(weftd: str | os.PathLike[str] | None = None,
          arguments: Sequence[str] = ()) -> Iterator[Client]:
    """A Client of a LocalServer, which takes the arguments; both end with the context.

        with weft.local() as client:
            mesh = client.mesh("key.poly", size="0.02*abs(y-46) + 0.1")
    """
    with LocalServer(weftd, arguments) as server, Client(server.target, token="", retries=0) as client:
        yield client
