# SPDX-License-Identifier: Apache-2.0
import os
import pickle
import threading

import numpy as np
import pytest
import scipy.interpolate
import weft
from conftest import KEY, KEY_SIZE, MODELS
from cutting_proxy import CuttingProxy

CYLINDER = MODELS / "cylinder.poly"


def test_a_mesh_is_the_one_that_the_command_line_gets(client, digest_of):
    mesh = client.mesh(KEY, size=KEY_SIZE, min_angle=30)
    assert mesh.digest == digest_of(KEY, "--size", KEY_SIZE, "--min-angle", "30")
    assert mesh.quality().min_angle >= 30


def interpolated(raster, p):
    """A raster at points (n, 2), by scipy."""
    rows, columns = raster.values.shape
    axes = [raster.origin[k] + raster.spacing[k] * np.arange(n) for k, n in ((1, rows), (0, columns))]
    inside = [np.clip(p[:, k], axes[1 - k][0], axes[1 - k][-1]) for k in (1, 0)]
    return scipy.interpolate.RegularGridInterpolator(axes, raster.values)(np.stack(inside, axis=-1))


def test_a_raster_bounds_all_areas_at_their_centroids(client, run_weft, tmp_path):
    values = np.random.default_rng(5).uniform(0.02, 2, (7, 9))
    raster = weft.Raster(values, origin=(-20, 30), spacing=(14, 5))
    mesh = client.mesh(KEY, size=raster)
    bounds = interpolated(raster, mesh.points[mesh.triangles].mean(axis=1))
    assert (mesh.quality().areas <= bounds * (1 + 1e-9)).all()
    mesh.write(tmp_path / "key.vtu")
    assert "the mesh holds" in run_weft("check", tmp_path / "key.vtu", "--domain", KEY)


def test_a_function_is_almost_the_expression_that_it_spells(client):
    by_function = client.mesh(KEY, size=lambda x, y: 0.1 + 0.02 * np.abs(y - 46))
    by_expression = client.mesh(KEY, size=KEY_SIZE)
    assert by_function.summary.triangles == pytest.approx(by_expression.summary.triangles, rel=0.02)


def test_a_function_is_sampled_over_the_domain():
    box = (2, 10, 6, 11)
    raster = weft.Raster.sample(lambda x, y: x + 100 * y, box, samples=9)
    assert raster.values.shape == (3, 9)
    assert (raster.values[0, 0], raster.values[-1, -1]) == (1002, 1106)
    assert weft.Raster.sample(lambda x, y: 7, box).values.shape == (129, 513)


@pytest.mark.parametrize("function, words", [
    (lambda x, y: x - 1e9, r"the size at \(.*\) is -"),
    (lambda x, y: np.sqrt(-x - 1e9), "is nan"),
    (lambda x, y: x[:, :3], "does not give such an array"),
    (lambda x, y: "none", "does not give such an array"),
])
def test_a_function_that_gives_no_size_is_refused(client, function, words):
    with np.errstate(invalid="ignore"), pytest.raises(weft.DomainError, match=words):
        client.mesh(KEY, size=function)


@pytest.mark.parametrize("size", [0.1, "0.1", 1 / 10])
def test_a_number_as_size_bounds_all_areas(client, size):
    mesh = client.mesh(KEY, size=size)
    assert mesh.quality().areas.max() <= 0.1
    assert mesh.digest == client.mesh(KEY, size=0.1).digest


def test_options_reach_the_server(client):
    assert client.mesh(KEY, size=0.01, max_triangles=1000).summary.unrefined.budget > 0
    assert client.mesh(KEY, size=0.01, min_edge=5).summary.unrefined.edge_floor > 0
    assert client.mesh(KEY, size=0.01, keep="all").summary.unrefined.kept > 0
    assert client.mesh(KEY, size=0.001, quadtree=True).summary.leaf_boxes.shape[1:] == (4,)
    assert client.mesh(KEY, threads=1, no_cache=True).summary.threads == 1
    with pytest.raises(weft.DeadlineExceeded):
        client.mesh(CYLINDER, size=1e-4, max_seconds=1e-3)


def test_a_placement_reaches_the_server_and_the_summary_tells_what_it_gains(client):
    lattice = client.mesh(KEY, size=0.01).summary
    circumcentres = client.mesh(KEY, size=0.01, placement="circumcentre").summary
    assert lattice.lattice_share == 1 and circumcentres.lattice_share == 0
    assert lattice.ideal_ratio < 1.1 < circumcentres.ideal_ratio
    assert lattice.mean_quality > circumcentres.mean_quality
    assert lattice.min_angle_p1_deg > lattice.min_angle_deg
    with pytest.raises(ValueError, match="'hexagons'; there are lattice, circumcentre"):
        client.mesh(KEY, placement="hexagons")


def test_smoothing_reaches_the_server_and_raises_small_angles(client):
    rough, usual, smooth = (client.mesh(KEY, size=0.01, **options).summary
                            for options in ({"optimise": 0}, {}, {"optimise": 8}))
    assert rough.triangles == usual.triangles == smooth.triangles
    assert rough.min_angle_p1_deg < usual.min_angle_p1_deg < smooth.min_angle_p1_deg
    with pytest.raises(weft.InvalidRequest, match="quality.optimise is 17"):
        client.mesh(KEY, optimise=17)


def test_a_mesh_that_misses_its_bounds_is_an_error_unless_it_is_allowed(client):
    corner = 1e6 + np.array([(0, 0), (1, 0), (1, 1), (0, 1)])
    size = "min(1e-2, 1e-24 + 0.1*((x-1e6)^2 + (y-1e6)^2))"  # below the distance of doubles
    with pytest.raises(weft.BoundsNotMet, match="double precision ends; the first is at"):
        client.mesh(corner, size=size)
    summary = client.mesh(corner, size=size, allow_unrefined=True).summary
    assert summary.unrefined.precision > 0
    assert summary.unrefined.x == pytest.approx(1e6)


def test_two_segments_that_cost_many_triangles_are_told(client):
    box = [(0, 0), (10, 0), (10, 10), (0, 10)]
    domain = weft.Domain(points=[*box, (1, 5), (9, 5), (1, 5.002), (9, 5.002)],
                         segments=[(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (6, 7)])
    narrow = client.mesh(domain).summary.narrow
    assert {narrow.segment, narrow.other} == {4, 5}
    assert narrow.width == pytest.approx(0.002)
    assert narrow.triangles <= narrow.in_all and narrow.widest == pytest.approx(0.002)
    assert narrow.y == pytest.approx(5, abs=0.01)
    assert client.mesh(domain, snap=0.01).summary.narrow is None


def test_a_domain_is_simplified_to_a_share_of_its_size(client):
    saw = [(i / 10, 0.02 * (i % 2)) for i in range(101)]
    points = [*saw, (10, 10), (0, 10)]
    domain = weft.Domain(points=points, segments=[(i, (i + 1) % len(points)) for i in range(len(points))])
    mesh = client.mesh(domain, edge=2, simplify=0.5)
    made = mesh.summary.simplification
    assert made.points > 80 and 0 < made.farthest <= 1
    assert client.mesh(domain, edge=2).summary.simplification is None
    with pytest.raises(weft.InvalidRequest, match="simplify") as caught:
        client.mesh(domain, simplify=0.5)
    assert caught.value.violations[0].field == "simplify"


def test_a_snap_reaches_the_server_which_refuses_what_is_no_distance(client):
    assert client.mesh(KEY, snap=1e-9).summary.merging.points == 0
    with pytest.raises(weft.InvalidRequest) as caught:
        client.mesh(KEY, snap=-1)
    assert caught.value.violations[0].field == "domain.snap"


def test_an_option_that_is_none_is_refused(client):
    with pytest.raises(TypeError, match="'max_triangle'.*max_triangles"):
        client.mesh(KEY, max_triangle=5)


def test_chunks_come_in_order_and_make_the_mesh(client):
    with client.stream(CYLINDER, size=0.01) as stream:
        chunks = list(stream)
        assert stream.accepted.engine_version
        mesh = stream.mesh()
    assert [chunk.index for chunk in chunks] == list(range(stream.summary.chunks))
    assert np.array_equal(np.concatenate([chunk.triangles for chunk in chunks]), mesh.triangles)
    assert not chunks[0].points.flags.writeable
    for chunk in chunks:
        assert len(chunk.triangles) == 0 or chunk.triangles.max() < chunk.first_vertex + len(chunk.points)


def test_progress_never_falls(client):
    seen = []
    client.mesh(CYLINDER, size=4e-4, on_progress=seen.append)
    assert seen
    fractions = [progress.fraction for progress in seen]
    assert fractions == sorted(fractions)
    assert {progress.stage for progress in seen} <= {"queued", "triangulate", "size", "refine", "emit"}


def test_a_stream_that_is_left_ends_the_work(server):
    with weft.Client(server.target, retries=0) as client:
        with client.stream(CYLINDER, size=1e-4) as stream:
            next(stream)
        assert stream.summary is None


def test_an_error_carries_reason_and_field(client):
    with pytest.raises(weft.InvalidRequest) as caught:
        client.mesh(KEY, size="1/(x")
    error = caught.value
    assert (error.code, error.reason) == ("INVALID_ARGUMENT", "EXPRESSION_SYNTAX")
    assert [violation.field for violation in error.violations] == ["size.expression"]
    assert "expected ')'" in error.detail
    assert "size.expression" in str(error)
    assert pickle.loads(pickle.dumps(error)).violations == error.violations


def test_an_error_of_the_engine_names_the_offender(client):
    domain = weft.Domain([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2), (2, 0)], holes=[(5, 5)])
    with pytest.raises(weft.InvalidRequest) as caught:
        client.mesh(domain)
    assert caught.value.reason == "SEED_OUTSIDE_DOMAIN"
    assert caught.value.violations[0].field.startswith("domain.holes[0]")


def test_a_limit_is_an_error_of_its_own():
    with weft.local(arguments=["--max-points", "10"]) as client:
        with pytest.raises(weft.LimitExceeded, match="LIMIT_EXCEEDED"):
            client.mesh(KEY)


def test_a_timeout_ends_a_call(client):
    with pytest.raises(weft.DeadlineExceeded):
        client.mesh(CYLINDER, size=1e-4, timeout=0.05)


def test_a_size_that_is_no_size_is_refused(client):
    for size in (float("nan"), [1, 2], 10**400, 10**5000):
        with pytest.raises(weft.DomainError, match="^size is"):
            client.mesh(KEY, size=size)
        with pytest.raises(weft.DomainError, match="^edge is"):
            client.mesh(KEY, edge=size)


def test_a_size_may_be_a_number_of_numpy(client):
    assert client.mesh(KEY, edge=np.float32(2)).summary.digest == client.mesh(KEY, edge=2).summary.digest


def test_a_server_that_is_absent_is_unavailable(tmp_path):
    with weft.Client(f"unix:{tmp_path}/nobody", retries=1) as client:
        with pytest.raises(weft.Unavailable):
            client.mesh(KEY)


def test_a_stream_that_broke_goes_on_where_it_was(server, tmp_path):
    with weft.Client(server.target) as client:
        whole = client.mesh(CYLINDER, size=0.002)
    proxy = CuttingProxy(server.target, tmp_path, limit=5_000_000)
    with weft.Client(proxy.target) as client, client.stream(CYLINDER, size=0.002) as stream:
        indices = [chunk.index for chunk in stream]
        mesh = stream.mesh()
    proxy.close()
    assert proxy.cuts == 1
    assert indices == list(range(whole.summary.chunks))
    assert mesh.digest == whole.digest
    assert np.array_equal(mesh.points, whole.points)


def test_a_stream_that_broke_for_good_can_be_continued_by_hand(server, tmp_path):
    proxy = CuttingProxy(server.target, tmp_path, limit=5_000_000)
    with weft.Client(proxy.target, retries=0) as client:
        with client.stream(CYLINDER, size=0.002) as stream:
            with pytest.raises(weft.Unavailable):
                stream.mesh()
            mesh = stream.mesh()
    proxy.close()
    assert mesh.quality().areas.max() <= 0.002


def test_threads_may_share_a_client(client):
    digests = []
    threads = [threading.Thread(target=lambda: digests.append(client.mesh(KEY, size=0.05).digest))
               for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(digests) == 8 and len(set(digests)) == 1


def test_the_server_tells_what_it_is(client):
    info = client.server_info()
    assert info.limits.max_min_angle_deg == 36
    assert info.threads >= 1


def test_a_private_server_ends_with_its_context(tmp_path, monkeypatch):
    with weft.local() as client:
        folder = client.target.removeprefix("unix:").removesuffix("/socket")
        assert client.mesh(KEY).summary.triangles
        assert os.path.exists(folder)
    assert not os.path.exists(folder)


def test_a_private_server_that_does_not_start_says_why():
    with pytest.raises(weft.LocalServerError, match="--no-such-flag"):
        weft.LocalServer(arguments=["--no-such-flag"])
    with pytest.raises(weft.LocalServerError, match="/no/such/weftd: No such file"):
        weft.LocalServer("/no/such/weftd")


def test_a_server_of_ones_own_inherits_nothing_that_configures_others(monkeypatch):
    monkeypatch.setenv("WEFT_DATA", "/proc/no/such")
    monkeypatch.setenv("WEFT_MAX_POINTS", "nonsense")
    monkeypatch.setenv("WEFT_TOKEN", "not for it")
    with weft.local() as client:
        assert client.server_info().threads >= 1


def test_no_server_at_all_is_said(monkeypatch):
    monkeypatch.delenv("WEFT_SERVER", raising=False)
    with pytest.raises(weft.WeftError, match="no server is named"):
        weft.Client()
