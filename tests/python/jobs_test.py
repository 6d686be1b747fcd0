# SPDX-License-Identifier: Apache-2.0
import uuid

import numpy as np
import pytest
import weft
from conftest import KEY, KEY_SIZE, MODELS
from cutting_proxy import CuttingProxy
from weft import JobState

CYLINDER = MODELS / "cylinder.poly"


@pytest.fixture(scope="module")
def client(job_server):
    with weft.Client(job_server.target) as client:
        yield client


def test_a_job_is_submitted_watched_and_fetched(client):
    job = client.submit(KEY, size=KEY_SIZE, no_cache=True)
    states = [seen.state for seen in client.watch(job)]
    assert states[-1] is JobState.SUCCEEDED
    done = client.wait(job)
    assert (done.id, done.attempts, done.client) == (job.id, 1, "")
    assert done.create_time <= done.start_time <= done.end_time
    mesh = client.fetch(job)
    assert mesh.digest == done.summary.digest
    assert mesh.digest == client.mesh(KEY, size=KEY_SIZE).digest


def test_the_same_request_id_finds_the_same_job(client):
    name = f"test-{uuid.uuid4()}"
    assert client.submit(KEY, request_id=name).id == client.submit(KEY, request_id=name).id
    with pytest.raises(weft.AlreadyExists, match="REQUEST_ID_REUSED"):
        client.submit(KEY, size=1, request_id=name)


def test_what_is_kept_is_not_made_again(client):
    client.wait(client.submit(KEY, size=0.3))
    again = client.submit(KEY, size=0.3)
    assert again.from_store and again.state is JobState.SUCCEEDED


def test_a_mesh_has_the_names_of_its_domain(client):
    domain = weft.Domain([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2), (2, 0)], markers=[2, 3, 4],
                         marker_names={2: "inlet", 3: "Wänd"}, region_names={0: "fluid"})
    for mesh in (client.mesh(domain), client.fetch(client.wait(client.submit(domain)))):
        assert mesh.marker_names == {2: "inlet", 3: "Wänd"}
        assert mesh.region_names == {0: "fluid"}
    plain = client.mesh(weft.Domain(domain.points, domain.segments, domain.markers))
    assert plain.digest == mesh.digest
    assert plain.marker_names == {}


def test_a_job_that_failed_raises_what_the_mesh_would_have_raised(client):
    job = client.submit(KEY, size="x - 1e9")
    with pytest.raises(weft.InvalidRequest) as caught:
        client.wait(job)
    assert caught.value.reason == "BAD_SIZE_VALUE"
    assert client.get_job(job).state is JobState.FAILED
    with pytest.raises(weft.FailedPrecondition):
        client.fetch(job)


def test_a_job_that_was_cancelled_says_so(client):
    job = client.submit(CYLINDER, size=1e-4)
    assert client.cancel(job).state is JobState.CANCELLED
    with pytest.raises(weft.Cancelled, match=job.id):
        client.wait(job.id)


def test_progress_is_told_while_it_waits(client):
    seen = []
    client.wait(client.submit(CYLINDER, size=4e-4), on_progress=seen.append)
    assert seen
    assert all(0 <= progress.fraction <= 1 for progress in seen)


def test_jobs_are_listed_youngest_first_by_state(client):
    ids = [client.submit(KEY, size=1 + i).id for i in range(3)]
    for id in ids:
        client.wait(id)
    listed = client.list_jobs([JobState.SUCCEEDED], limit=3)
    assert [job.id for job in listed] == ids[::-1]
    assert set(ids) <= {job.id for job in client.list_jobs()}


def test_a_deleted_job_is_gone(client):
    job = client.wait(client.submit(KEY))
    client.delete(job)
    with pytest.raises(weft.NotFound, match="NO_SUCH_JOB"):
        client.get_job(job)


def test_a_fetch_that_broke_goes_on_where_it_was(client, job_server, tmp_path):
    job = client.wait(client.submit(CYLINDER, size=0.002))
    proxy = CuttingProxy(job_server.target, tmp_path, limit=5_000_000)
    with weft.Client(proxy.target) as other:
        mesh = other.fetch(job)
    proxy.close()
    assert proxy.cuts == 1
    assert mesh.digest == job.summary.digest
    assert len(np.unique(mesh.triangles)) == len(mesh.points)


def test_a_server_without_a_store_keeps_no_jobs(server):
    with weft.Client(server.target) as client, pytest.raises(weft.ServerError) as caught:
        client.submit(KEY)
    assert caught.value.code == "UNIMPLEMENTED"


def test_a_callback_needs_a_secret_on_the_server(client):
    with pytest.raises(weft.InvalidRequest, match="the server sends no callbacks") as caught:
        client.submit(KEY, size=KEY_SIZE, notify="https://example.org/hook")
    assert [violation.field for violation in caught.value.violations] == ["notify"]
    assert client.submit(KEY, size=KEY_SIZE).callback is None
