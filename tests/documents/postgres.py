# SPDX-License-Identifier: Apache-2.0
"""A PostgreSQL server of one's own, on a socket in a folder. It ends with whoever started it."""

from __future__ import annotations

import os
import pathlib
import shutil
import signal
import subprocess
import time

PROGRAMS = max(pathlib.Path("/usr/lib/postgresql").glob("*/bin"), default=pathlib.Path("/usr/bin"))


class Postgres:
    """`folder` must be empty."""

    def __init__(self, folder: pathlib.Path):
        self.folder = folder
        self.as_its_user = ["setpriv", "--pdeathsig", "QUIT"]
        if os.geteuid() == 0:  # as which it refuses to run
            shutil.chown(folder, "postgres", "postgres")
            self.as_its_user += ["--reuid", "postgres", "--regid", "postgres", "--init-groups"]
        self._run("initdb", "--pgdata", folder / "data", "--username", "weft", "--auth", "trust",
                  "--no-sync", "--encoding", "UTF8", "--locale", "C").check_returncode()
        self.server = subprocess.Popen(
            [*self.as_its_user, "--", PROGRAMS / "postgres", "-D", folder / "data", "-k", folder,
             "-c", "listen_addresses=", "-c", "fsync=off", "-c", "shared_buffers=32MB"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd="/")
        end = time.monotonic() + 120
        while self._run("createdb", "-h", folder, "-U", "weft", "weft").returncode != 0:
            if time.monotonic() > end or self.server.poll() is not None:
                raise RuntimeError("PostgreSQL does not answer")
            time.sleep(0.05)

    def _run(self, program: str, *arguments: object) -> subprocess.CompletedProcess[bytes]:
        return subprocess.run([*self.as_its_user, "--", PROGRAMS / program, *map(str, arguments)],
                              capture_output=True, cwd="/")

    @property
    def uri(self) -> str:
        """Without characters that mean something to a shell."""
        return f"postgres://weft@{str(self.folder).replace('/', '%2F')}/weft"

    def close(self) -> None:
        self.server.send_signal(signal.SIGQUIT)
        self.server.wait()
