# SPDX-License-Identifier: Apache-2.0
"""Meshes for functions that take no client: by the library, or, where it is not installed, from one private
server per process, which starts at the first call, serves all threads and ends with the process."""

from __future__ import annotations

import os
import threading
from typing import Unpack

from . import _in_process
from ._mesh import Mesh
from ._requests import MeshOptions
from .client import Client
from .domain import Domain
from .errors import MissingPackage
from .local import LocalServer
from .size import Size

_lock = threading.Lock()
# By process, because after a fork the parent's are here, too.
_started: dict[int, tuple[LocalServer, Client]] = {}


def mesh(domain: Domain, size: Size, min_angle: float, **options: Unpack[MeshOptions]) -> Mesh:
    """As Client.mesh. Thread-safe. Raises LocalServerError if there is no library and no server starts."""
    try:
        return _in_process.mesh(domain, size, min_angle, **options)
    except MissingPackage:
        pass
    with _lock:
        if os.getpid() not in _started:
            server = LocalServer()
            _started[os.getpid()] = server, Client(server.target, token="", retries=0)
        _, client = _started[os.getpid()]
    return client.mesh(domain, size, min_angle, **options)
