# SPDX-License-Identifier: Apache-2.0
"""A way to a server that breaks."""

import contextlib
import socket
import threading


class CuttingProxy:
    """Listens on a unix socket in `folder` and passes everything on to a server's. The first
    connection is cut when `limit` bytes have come back through it; the rest are left alone."""

    def __init__(self, target, folder, limit):
        self._target = target.removeprefix("unix:")
        self._limit = limit
        self.cuts = 0
        self._listener = socket.socket(socket.AF_UNIX)
        self._listener.bind(f"{folder}/proxy")
        self._listener.listen()
        self.target = f"unix:{folder}/proxy"
        threading.Thread(target=self._accept, daemon=True).start()

    def close(self):
        self._listener.close()

    def _accept(self):
        with contextlib.suppress(OSError):
            while True:
                inside, _ = self._listener.accept()
                outside = socket.socket(socket.AF_UNIX)
                outside.connect(self._target)
                limit, self._limit = self._limit, None
                for pair in ((inside, outside, None), (outside, inside, limit)):
                    threading.Thread(target=self._pass_on, args=pair, daemon=True).start()

    def _pass_on(self, source, sink, limit):
        with contextlib.suppress(OSError):
            while got := source.recv(1 << 16):
                if limit is not None:
                    limit -= len(got)
                    if limit < 0:
                        self.cuts += 1
                        break
                sink.sendall(got)
        for end in (source, sink):
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
