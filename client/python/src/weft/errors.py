# SPDX-License-Identifier: Apache-2.0
"""What can go wrong. Everything that weft raises on purpose is a `WeftError`.

    try:
        mesh = client.mesh(domain, size="1/x")
    except weft.InvalidRequest as error:
        print(error.reason, error.violations)
"""

from __future__ import annotations

import dataclasses
from typing import Any

from . import _protocol
from ._address import proxy_of
from ._arguments import argument_of

_Status = _protocol.message("google.rpc.Status")
_DETAILS = {name: _protocol.message(f"google.rpc.{name}")
            for name in ("ErrorInfo", "BadRequest", "RetryInfo")}
_CODES = _protocol.enum("google.rpc.Code").values_by_number


class WeftError(Exception):
    """The base of all."""


class DomainError(WeftError, ValueError):
    """A domain, a size or a file of them makes no sense; no server was asked."""


class MeshFileError(WeftError, ValueError):
    """A file is not a mesh, or its format can be neither read nor written."""


class SwitchError(WeftError, ValueError):
    """A switch of weft.triangulate is unknown or malformed, or asks for what weft cannot do."""

    def __init__(self, switch: str, why: str) -> None:
        super().__init__(f"the switch {switch!r}: {why}")
        self.switch = switch
        """The letter, with the number that follows it."""


class WeftWarning(UserWarning):
    """The result is not quite what was asked for, or what was asked for is hardly meant: a file does
    not hold all of the mesh, a size was sampled too coarsely, bounds nothing or names no field."""


class DamagedStream(WeftError):
    """What a server sent is not a mesh, or not the one that its digests name."""


class LocalServerError(WeftError):
    """A private weftd could not be found or started."""


class MissingPackage(WeftError, ImportError):
    """An optional package is needed; the message names it."""


@dataclasses.dataclass(frozen=True)
class FieldViolation:
    """A field of the request that is at fault."""

    field: str
    """Its path, such as `domain.segments[17].b`."""
    description: str
    """What is wrong with it."""
    argument: str = ""
    """What Client.mesh calls it, such as `fields['coast']`; empty if it has no other name."""


class ServerError(WeftError):
    """A call to a server, or a job, failed. The subclass follows from the gRPC code."""

    def __init__(self, message: str, *, code: str = "UNKNOWN", reason: str = "", detail: str = "",
                 violations: tuple[FieldViolation, ...] = (), retry_after: float | None = None,
                 job_id: str = "") -> None:
        super().__init__(message)
        self.code = code
        """Name of the gRPC status code, such as `INVALID_ARGUMENT`."""
        self.reason = reason
        """From the table in wire/errors.h, such as `BAD_OPTION`; empty if weft did not say."""
        self.detail = detail
        """What the server says in words."""
        self.violations = violations
        """The fields of the request that are at fault."""
        self.retry_after = retry_after
        """Seconds after which the same call may succeed; None if it will not."""
        self.job_id = job_id
        """Names the job in the server's log; may be empty."""


class InvalidRequest(ServerError):
    """INVALID_ARGUMENT, OUT_OF_RANGE: the request is wrong; `violations` say where."""


class LimitExceeded(ServerError):
    """RESOURCE_EXHAUSTED: over a limit or a budget, or, with `retry_after`, a full queue or
    a machine without memory left."""


class DeadlineExceeded(ServerError):
    """DEADLINE_EXCEEDED: the time-out passed, or the work took longer than it may."""


class Cancelled(ServerError):
    """CANCELLED: the call or the job was cancelled."""


class Unauthenticated(ServerError):
    """UNAUTHENTICATED: the token is missing or wrong."""


class NotFound(ServerError):
    """NOT_FOUND: there is no such job, or its mesh is no longer kept."""


class AlreadyExists(ServerError):
    """ALREADY_EXISTS: the request id belongs to another mesh."""


class FailedPrecondition(ServerError):
    """FAILED_PRECONDITION: the job has not ended, or did not succeed; or BoundsNotMet."""


class BoundsNotMet(FailedPrecondition):
    """BOUNDS_NOT_MET: triangles of the mesh miss a bound although nothing exempts them; the message says
    how many, why and where. `allow_unrefined=True` gives the mesh all the same."""


class Unavailable(ServerError):
    """UNAVAILABLE: the server is absent, stopping, or went away."""


_CLASSES: dict[str, type[ServerError]] = {
    "INVALID_ARGUMENT": InvalidRequest,
    "OUT_OF_RANGE": InvalidRequest,
    "RESOURCE_EXHAUSTED": LimitExceeded,
    "DEADLINE_EXCEEDED": DeadlineExceeded,
    "CANCELLED": Cancelled,
    "UNAUTHENTICATED": Unauthenticated,
    "NOT_FOUND": NotFound,
    "ALREADY_EXISTS": AlreadyExists,
    "FAILED_PRECONDITION": FailedPrecondition,
    "UNAVAILABLE": Unavailable,
}


# Reasons that have a class of their own.
_REASONS: dict[str, type[ServerError]] = {"BOUNDS_NOT_MET": BoundsNotMet}


def of_status(status: Any, subject: str, request: Any = None) -> ServerError:
    """The exception for a google.rpc.Status; `subject` begins its message. `request`: the
    GenerateMeshRequest that it is about, if it is known."""
    found = {name: kind() for name, kind in _DETAILS.items()}
    for detail in status.details:
        name = detail.type_url.rpartition(".")[2]
        if name in found:
            try:
                found[name].ParseFromString(detail.value)
            except Exception:  # details that are garbage say nothing
                found[name].Clear()
    info, bad, retry = found["ErrorInfo"], found["BadRequest"], found["RetryInfo"]
    known = _CODES.get(status.code)
    code = known.name if known else f"status {status.code}"
    text = f"{subject} {code}" + (f" ({info.reason})" if info.reason else "")
    violations = tuple(FieldViolation(v.field, v.description, argument_of(v.field, request))
                       for v in bad.field_violations)
    for violation in violations:
        argument = f"argument {violation.argument}, " if violation.argument else ""
        text += f"\n  {argument}field {violation.field}"
    if status.message:
        text += "\n  " + status.message.replace("\n", "\n  ")
    delay = None
    if retry.HasField("retry_delay"):
        delay = max(0.0, retry.retry_delay.seconds + retry.retry_delay.nanos * 1e-9)
    kind = _REASONS.get(info.reason, _CLASSES.get(code, ServerError))
    return kind(
        text, code=code, reason=info.reason, detail=status.message, violations=violations,
        retry_after=delay, job_id=info.metadata.get("job_id", ""))


def of_call(call: Any, target: str, request: Any = None) -> ServerError:
    """The exception for a grpc.RpcError. `request`: as above."""
    status = _Status()
    for key, value in call.trailing_metadata() or ():
        if key == "grpc-status-details-bin":
            try:
                status.ParseFromString(value)
            except Exception:  # as above
                status.Clear()
    status.code = call.code().value[0]
    status.message = call.details() or ""
    if call.code().name == "UNAVAILABLE" and (proxy := proxy_of(target)):
        status.message += f"\nit was called through {proxy}"
    return of_status(status, f"the server {target} answers", request)
