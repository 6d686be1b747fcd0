# SPDX-License-Identifier: Apache-2.0
import asyncio
import inspect
import threading
import types

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


def raster_file(folder):
    gdal = pytest.importorskip("osgeo.gdal")
    data = gdal.GetDriverByName("GTiff").Create(str(folder / "h.tif"), 40, 40, 1, gdal.GDT_Float32)
    data.SetGeoTransform((-20, 1, 0, 20, 0, -1))
    data.GetRasterBand(1).Fill(70_000)
    del data
    return folder / "h.tif"


BOX = weft.Domain.rings([(0, 0), (4, 0), (4, 3), (0, 3)])


@pytest.mark.filterwarnings("ignore::weft.WeftWarning")
@pytest.mark.parametrize("lonlat", [False, True])
@pytest.mark.parametrize("method", ["mesh", "submit"])
def test_the_loop_goes_on_while_a_raster_is_read(job_server, tmp_path, monkeypatch, method, lonlat):
    file, ticked = raster_file(tmp_path), threading.Event()
    read = weft._raster_file.RasterFile.read

    async def made():
        loop, reading = asyncio.get_running_loop(), asyncio.Event()

        def wait_for_a_tick(self, *part):
            loop.call_soon_threadsafe(reading.set)
            ticked.wait()  # until the test times out, if the loop stands still
            return read(self, *part)
        monkeypatch.setattr(weft._raster_file.RasterFile, "read", wait_for_a_tick)

        async def tick():
            await reading.wait()
            ticked.set()
        async with aio.Client(job_server.target) as twin:
            return await asyncio.gather(tick(), getattr(twin, method)(
                BOX, edge="h", fields={"h": weft.raster(file)}, lonlat=lonlat, to_metres=lonlat))
    assert asyncio.run(made())[1]


@pytest.mark.filterwarnings("error::weft.WeftWarning")
def test_a_warning_does_not_replace_what_is_wrong_in_the_thread():
    def fails():
        weft._warning.warn("odd")
        raise weft.DomainError("wrong")

    with pytest.raises(weft.DomainError, match="^wrong$"):
        asyncio.run(weft._warning.in_thread(fails))
    with pytest.raises(weft.WeftWarning, match="^odd$"):
        asyncio.run(weft._warning.in_thread(weft._warning.warn, "odd"))


def test_a_mesh_is_brought_back_to_degrees_while_the_loop_goes_on(server, monkeypatch):
    ticked, back = threading.Event(), weft._projection.Projection.to_lonlat

    async def mesh():
        loop = asyncio.get_running_loop()

        def wait_for_a_tick(self, *points):
            loop.call_soon_threadsafe(ticked.set)
            ticked.wait()  # until the test times out, if the loop stands still
            return back(self, *points)
        monkeypatch.setattr(weft._projection.Projection, "to_lonlat", wait_for_a_tick)
        async with aio.Client(server.target) as twin:
            return await twin.mesh(BOX, edge=50_000, lonlat=True)
    assert asyncio.run(mesh()).points.max() == pytest.approx(4)


def test_what_is_wrong_with_a_file_has_its_type_and_its_line(server, tmp_path):
    file = raster_file(tmp_path)

    async def meshes():
        async with aio.Client(server.target) as twin:
            for path, kind in ((tmp_path / "none.poly", OSError), (tmp_path / "none.stl", weft.DomainError)):
                with pytest.raises(kind):
                    await twin.mesh(path)
            with pytest.raises(weft.DomainError, match="none.tif"):
                await twin.mesh(BOX, edge="h", fields={"h": weft.raster(tmp_path / "none.tif")})
            stream = twin.stream(BOX, edge="h", fields={"h": weft.raster(file, band=2)})
            with pytest.raises(weft.DomainError, match="has no band"):
                await anext(stream)
            with pytest.raises(TypeError, match="unknown option"):
                await twin.submit(BOX, egde=1)
            with pytest.warns(weft.WeftWarning, match="bounds nothing") as caught:
                await twin.mesh(BOX, edge="h", fields={"h": weft.raster(file)})
                await twin.mesh(BOX, edge=99)
            assert {warning.filename for warning in caught} == {__file__}
    asyncio.run(meshes())


def test_the_time_for_reading_is_not_that_of_the_call(server, monkeypatch):
    read, now, clock = weft.Domain.read, [0.0], weft._retry.time
    monkeypatch.setattr(weft._retry, "time", types.SimpleNamespace(monotonic=lambda: now[0] + clock.monotonic()))

    def slow(path):
        now[0] += 3600
        return read(path)
    monkeypatch.setattr(weft.Domain, "read", slow)

    async def mesh():
        async with aio.Client(server.target) as twin:
            return await twin.mesh(KEY, timeout=600)
    assert asyncio.run(mesh()).summary.triangles


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
