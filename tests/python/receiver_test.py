# SPDX-License-Identifier: Apache-2.0
"""What the receiver of a stream refuses; the messages are a real server's."""

import numpy as np
import pytest
import weft
from weft import _protocol
from weft._receiver import MeshReceiver

Message = _protocol.GENERATE_MESH.response


def receive(messages, **limits):
    receiver = MeshReceiver(**limits)
    for message in messages:
        receiver.receive(message)
    return receiver.mesh()


def chunks_of(messages):
    return [i for i, message in enumerate(messages) if Message.FromString(message).HasField("chunk")]


def changed(messages, at, change):
    """The messages, of which one was changed."""
    message = Message.FromString(messages[at])
    change(message)
    return [*messages[:at], message.SerializeToString(), *messages[at + 1:]]


def test_arrays_are_those_that_protobuf_reads(messages):
    mesh = receive(messages)
    chunks = [Message.FromString(messages[i]).chunk for i in chunks_of(messages)]
    assert len(chunks) > 2
    for name, array in (("coordinates", mesh.points), ("triangles", mesh.triangles),
                        ("edges", mesh.edges), ("edge_segments", mesh.edge_segments),
                        ("input_points", mesh.input_points)):
        expected = np.concatenate([np.array(getattr(chunk, name)) for chunk in chunks])
        assert np.array_equal(array.ravel(), expected), name


def test_a_changed_number_is_seen(messages):
    def move(message):
        message.chunk.coordinates[0] += 1e-9
    with pytest.raises(weft.DamagedStream, match="chunk 0 does not match its SHA-256"):
        receive(changed(messages, chunks_of(messages)[0], move))


def test_a_chunk_of_another_mesh_is_seen_by_the_digest_of_all(messages):
    def other(message):
        message.summary.sha256 = b"x" * 32
    with pytest.raises(weft.DamagedStream, match="SHA-256 of the summary"):
        receive(changed(messages, len(messages) - 1, other))


def test_a_missing_chunk_is_seen(messages):
    second = chunks_of(messages)[1]
    with pytest.raises(weft.DamagedStream, match="chunk 1 has the index 2, expected 1"):
        receive(messages[:second] + messages[second + 1:])


def test_a_stream_without_a_summary_is_no_mesh(messages):
    with pytest.raises(weft.DamagedStream, match="without a summary"):
        receive(messages[:-1])


def test_a_stream_begins_with_accepted(messages):
    with pytest.raises(weft.DamagedStream, match="first message is not `accepted`"):
        receive(messages[1:])


@pytest.mark.parametrize("name, what", [("triangles", "vertex"), ("edges", "vertex")])
def test_a_vertex_that_is_not_there_is_seen(messages, name, what):
    def beyond(message):
        getattr(message.chunk, name)[0] = 2**32 - 1
    at = next(i for i in chunks_of(messages) if len(getattr(Message.FromString(messages[i]).chunk, name)))
    with pytest.raises(weft.DamagedStream, match=f"names {what} 4294967295 of"):
        receive(changed(messages, at, beyond))


def test_a_segment_that_the_domain_does_not_have_is_seen(messages):
    with pytest.raises(weft.DamagedStream, match="names segment .* of 1"):
        receive(messages, points=10**6, segments=1)


def test_arrays_of_odd_lengths_are_seen(messages):
    def cut(message):
        del message.chunk.triangles[-1]
    at = next(i for i in chunks_of(messages) if Message.FromString(messages[i]).chunk.triangles)
    with pytest.raises(weft.DamagedStream, match="chunk"):
        receive(changed(messages, at, cut))


def test_a_message_cut_anywhere_is_seen(messages):
    whole = messages[chunks_of(messages)[0]]
    for length in [*range(40), len(whole) // 2, len(whole) - 1]:
        with pytest.raises(weft.DamagedStream):
            receive([messages[0], whole[:length]])


def test_an_engine_of_another_version_does_not_go_on(messages):
    def newer(message):
        message.accepted.engine_version = "1000"
    receiver = MeshReceiver()
    receiver.receive(messages[0])
    receiver.resume()
    with pytest.raises(weft.DamagedStream, match="resumed by engine 1000"):
        receiver.receive(changed(messages, 0, newer)[0])


def test_a_stream_that_was_resumed_gives_the_same_mesh(messages):
    receiver = MeshReceiver()
    cut = chunks_of(messages)[1] + 1
    for message in messages[:cut]:
        receiver.receive(message)
    receiver.resume()
    for message in [messages[0], *messages[cut:]]:
        receiver.receive(message)
    assert np.array_equal(receiver.mesh().triangles, receive(messages).triangles)
