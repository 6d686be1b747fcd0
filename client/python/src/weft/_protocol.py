# SPDX-License-Identifier: Apache-2.0
"""The messages and methods of weft.v1.

They are made from protocol.binpb, which protoc compiles from proto/ when the package is built, in a
pool of their own: no other package's google.rpc can be in their way, and no version of generated
code has to fit that of protobuf.
"""

from __future__ import annotations

import dataclasses
import functools
import importlib.resources
from typing import Any

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from google.protobuf.message import DecodeError as DecodeError


def _load() -> Any:
    file = importlib.resources.files(__package__) / "protocol.binpb"
    try:
        contents = file.read_bytes()
    except FileNotFoundError:
        raise ImportError(f"{file} is missing: build the package, see client/python/README.md") from None
    pool = descriptor_pool.DescriptorPool()
    for proto in descriptor_pb2.FileDescriptorSet.FromString(contents).file:
        pool.AddSerializedFile(proto.SerializeToString())
    return pool


_pool = _load()


def _class_of(descriptor: Any) -> Any:
    if hasattr(message_factory, "GetMessageClass"):  # from protobuf 4.22 on
        return message_factory.GetMessageClass(descriptor)
    return message_factory.MessageFactory(_pool).GetPrototype(descriptor)


@functools.cache  # it takes half a millisecond
def message(name: str) -> Any:
    """The class of a message, such as `message("weft.v1.Domain")`."""
    return _class_of(_pool.FindMessageTypeByName(name))


def annotation(field: Any) -> Any:
    """The weft.v1.Option of a field; None if it is no option."""
    # The class of the field's options is not of our pool, which alone knows the extension.
    options = message("google.protobuf.FieldOptions").FromString(field.GetOptions().SerializeToString())
    extension = _pool.FindExtensionByName("weft.v1.option")
    return options.Extensions[extension] if options.HasExtension(extension) else None


def enum(name: str) -> Any:
    """The descriptor of an enum: `values_by_name`, `values_by_number`."""
    return _pool.FindEnumTypeByName(name)


@dataclasses.dataclass(frozen=True)
class Method:
    """How a method is called."""

    path: str
    request: Any
    """Class of its request."""
    response: Any
    """Class of its response, or of each message of its stream."""


def _method(service: str, name: str) -> Method:
    found = _pool.FindServiceByName(f"weft.v1.{service}").methods_by_name[name]
    return Method(f"/weft.v1.{service}/{name}", _class_of(found.input_type),
                  _class_of(found.output_type))


GENERATE_MESH = _method("MeshService", "GenerateMesh")
GET_SERVER_INFO = _method("MeshService", "GetServerInfo")
SUBMIT_JOB = _method("JobService", "SubmitJob")
GET_JOB = _method("JobService", "GetJob")
LIST_JOBS = _method("JobService", "ListJobs")
WATCH_JOB = _method("JobService", "WatchJob")
CANCEL_JOB = _method("JobService", "CancelJob")
DELETE_JOB = _method("JobService", "DeleteJob")
FETCH_MESH = _method("JobService", "FetchMesh")
HEALTH = "/grpc.health.v1.Health/Check"
"""Path of the method by which any server tells that it is there; an empty request is one."""
