# SPDX-License-Identifier: Apache-2.0
"""Rounded floor plans whose near features are merged, before the independent checker."""

import pytest
from floor_plans import floor_plan, write_poly

PLANS = [*range(500, 512), 520, 525, 535, 559, 599, 665]
"""In 506, 525 and 535, chains of segments are led beside each other; in 520, 559 and 599, a wall is led away from a
door that ends at it; in 665, towards a partition that ends beside it."""


@pytest.mark.parametrize("seed", PLANS)
def test_floor_plans_hold_with_a_snap(run_weft, tmp_path, seed):
    domain, mesh = tmp_path / "plan.poly", tmp_path / "plan.npz"
    write_poly(domain, floor_plan(seed))
    for angle in (20, 30):
        bounds = ["--snap", 0.005, "--size", 0.8, "--min-angle", angle]
        run_weft("mesh", domain, "-o", mesh, "--quiet", *bounds)
        run_weft("check", mesh, "--domain", domain, *bounds)
