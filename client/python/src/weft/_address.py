# SPDX-License-Identifier: Apache-2.0
"""What an address of a server says about the way to it, as client/call/address.h has it."""

from __future__ import annotations

import ipaddress
import os


def _host(target: str) -> str:
    return target.rpartition(":")[0].strip("[]")


def is_local(target: str) -> bool:
    """Whether what is sent there stays on this machine. A name other than localhost is not looked
    up."""
    if target.startswith(("unix:", "unix-abstract:")):
        return True
    try:
        return ipaddress.ip_address(_host(target)).is_loopback
    except ValueError:
        return _host(target) == "localhost"


def proxy_of(target: str) -> str:
    """The proxy through which gRPC reaches the target, and the variable that names it, as in
    "the proxy gate:3128, which http_proxy names"; empty if there is none, as for all local targets."""
    set_ = [name for name in ("grpc_proxy", "https_proxy", "http_proxy") if name in os.environ]
    if is_local(target) or not set_ or not os.environ[set_[0]]:
        return ""
    excepted = os.environ.get("no_grpc_proxy", os.environ.get("no_proxy", ""))
    if any(_host(target).endswith(part.strip()) for part in excepted.split(",") if part.strip()):
        return ""
    name = os.environ[set_[0]].rpartition("://")[2].partition("/")[0].rpartition("@")[2]
    return f"the proxy {name}, which {set_[0]} names"
