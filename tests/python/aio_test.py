# SPDX-License-Identifier: Apache-2.0
import asyncio
import inspect

import numpy as np
import pytest
import weft
from conftest import KEY, KEY_SIZE, MODELS
from cutting_proxy import CuttingProxy
from weft import JobState, aio

CYLINDER = MODELS / "cylinder.poly"


def test_a_mesh_is_that_of_the_client_that_blocks(server, client):
    async def mesh():
        async with aio.Client(server.target) as twin:
            return await twin.mesh(KEY, size=KEY_SIZE)
    assert asyncio.run(mesh()).digest == client.mesh(KEY, size=KEY_SIZE).digest


def test_meshes_are_made_at_the_same_time(server):
    async def meshes():
        async with aio.Client(server.target) as twin:
            return await asyncio.gather(*(twin.mesh(KEY, size=0.1 + i) for i in range(6)))
    assert len({mesh.digest for mesh in asyncio.run(meshes())}) == 6


def test_chunks_come_in_order(server):
    async def chunks():
        seen = []
        async with aio.Client(server.target) as twin:
            async with twin.stream(CYLINDER, size=0.01, on_progress=seen.append) as stream:
                return [chunk.index async for chunk in stream], stream.summary
    indices, summary = asyncio.run(chunks())
    assert indices == list(range(summary.chunks))


def test_a_stream_that_broke_goes_on_where_it_was(server, client, tmp_path):
    proxy = CuttingProxy(server.target, tmp_path, limit=5_000_000)

    async def mesh():
        async with aio.Client(proxy.target) as twin:
            return await twin.mesh(CYLINDER, size=0.002)
    mesh = asyncio.run(mesh())
    proxy.close()
    assert proxy.cuts == 1
    assert np.array_equal(mesh.points, client.mesh(CYLINDER, size=0.002).points)


def test_errors_are_the_same(server):
    async def mesh():
        async with aio.Client(server.target) as twin:
            await twin.mesh(KEY, size="1/(x")
    with pytest.raises(weft.InvalidRequest, match="EXPRESSION_SYNTAX"):
        asyncio.run(mesh())


def test_a_task_that_is_cancelled_ends_the_call(server):
    async def cancelled():
        async with aio.Client(server.target) as twin:
            started = asyncio.Event()
            task = asyncio.create_task(twin.mesh(CYLINDER, size=1e-4,
                                                 on_progress=lambda _: started.set()))
            await asyncio.wait_for(started.wait(), 60)
            task.cancel()
            with pytest.raises(asyncio.CancelledError):
                await task
    asyncio.run(cancelled())


def test_jobs_are_submitted_watched_fetched_listed_cancelled_and_deleted(job_server):
    async def jobs():
        async with aio.Client(job_server.target) as twin:
            job = await twin.submit(KEY, size=0.17)
            states = [seen.state async for seen in twin.watch(job)]
            assert states[-1] is JobState.SUCCEEDED
            mesh = await twin.fetch(await twin.wait(job))
            assert (await twin.get_job(job)).summary.digest == mesh.digest
            assert job.id in [each.id for each in await twin.list_jobs()]
            await twin.delete(job)
            with pytest.raises(weft.NotFound):
                await twin.get_job(job)
            long = await twin.submit(CYLINDER, size=1e-4)
            assert (await twin.cancel(long)).state is JobState.CANCELLED
    asyncio.run(jobs())


def test_a_private_server_ends_with_its_context():
    async def mesh():
        async with aio.local() as twin:
            await twin.mesh(KEY)
            return twin.target.removeprefix("unix:")
    with pytest.raises(FileNotFoundError):
        open(asyncio.run(mesh()))


@pytest.mark.parametrize("ours, theirs", [(weft.Client, aio.Client), (weft.MeshStream, aio.MeshStream)])
def test_it_has_every_method_with_the_same_arguments(ours, theirs):
    def public(kind):
        return {name: [(p.name, p.default, p.kind) for p in inspect.signature(member).parameters.values()]
                for name, member in inspect.getmembers(kind, inspect.isfunction)
                if not name.startswith("_")}
    assert public(ours) == public(theirs)
