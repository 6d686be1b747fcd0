# SPDX-License-Identifier: Apache-2.0
"""Which server to use and how."""

from __future__ import annotations

import dataclasses
import os
import pathlib
from typing import Any

import grpc

from ._address import is_local
from .errors import WeftError


@dataclasses.dataclass(frozen=True)
class TLS:
    """How a connection is encrypted. Certificates and keys are paths of PEM files."""

    ca: str | os.PathLike[str] | None = None
    """Whom to trust; default: whom the system trusts."""
    cert: str | os.PathLike[str] | None = None
    """Own certificate for the server."""
    key: str | os.PathLike[str] | None = None
    """Its private key."""
    server_name: str | None = None
    """Name in the server's certificate; default: the host of the target."""


@dataclasses.dataclass(frozen=True)
class Connection:
    """What a channel is opened with."""

    target: str
    credentials: grpc.ChannelCredentials | None
    """None: unencrypted."""
    options: list[tuple[str, Any]]
    metadata: tuple[tuple[str, str], ...]
    """Of every call. gRPC's own call credentials refuse to travel over unix sockets."""


def connection(target: str | None, token: str | None, tls: TLS | bool | None,
               insecure: bool) -> Connection:
    """Raises WeftError if no server is named, or the token would travel unencrypted."""
    target = target or os.environ.get("WEFT_SERVER")
    if not target:
        raise WeftError("no server is named: give a target, or WEFT_SERVER; weft.local() starts one")
    token = (token if token is not None else os.environ.get("WEFT_TOKEN", "")).strip()
    if not all("!" <= c <= "~" for c in token):
        raise WeftError("the token is not one word of visible ASCII characters")
    if token and not tls and not insecure and not is_local(target):
        raise WeftError(f"the token would travel unencrypted to {target}: give tls=True, or "
                        "insecure=True to send it anyway")
    options: list[tuple[str, Any]] = [
        # A server that vanished without a word is noticed.
        ("grpc.keepalive_time_ms", 30_000), ("grpc.keepalive_timeout_ms", 10_000),
        # One that starts again is found again.
        ("grpc.initial_reconnect_backoff_ms", 100), ("grpc.max_reconnect_backoff_ms", 1_000)]
    if is_local(target):
        options.append(("grpc.enable_http_proxy", 0))
    credentials = None
    if tls:
        tls = TLS() if tls is True else tls
        read = (None if path is None else pathlib.Path(path).read_bytes()
                for path in (tls.ca, tls.key, tls.cert))
        credentials = grpc.ssl_channel_credentials(*read)
        if tls.server_name:
            options.append(("grpc.ssl_target_name_override", tls.server_name))
    metadata = (("authorization", f"Bearer {token}"),) if token else ()
    return Connection(target, credentials, options, metadata)
