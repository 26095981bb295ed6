"""The stock's meshes: closed, outward, sharp where the stock is, and as large as it; heights and three bundles."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest
from pytest import approx

from leaning_tools import leaning_section
from trunnion.findings import BadInput
from trunnion.geometry.frame import WORLD
from trunnion.model.blank import Box
from trunnion.verify.kernels.stock.meshing import mesh_zmap
from trunnion.verify.motion import moves_of
from trunnion.verify.stock import Stock, run_stock
from trunnion.verify.stock.bundles import cycle
from trunnion.verify.stock.mesh import mesh_of
from verify_tools import bull

PITCH = 0.5
LEAN = np.array([[0.8, -0.6, 0.0], [0.48, 0.64, -0.6], [0.36, 0.48, 0.8]])


def blank(*high):
    return Box(frame=WORLD, low=(0.0, 0.0, 0.0), high=high, material="test", density=2.8)


def of_heights(top):
    """Return the mesh of heights over a floor at 0."""
    stock = Stock.of(blank(top.shape[1] * PITCH, top.shape[0] * PITCH, 100.0), PITCH)
    stock.field.top[:] = top
    return stock, mesh_of(stock)


def of_solid(depth, size=20.0, bundles=("x", "y", "z")):
    """Return a stock whose rays hold what has a positive depth (n, 3) -> (n,), ends found by bisection between samples a tenth apart."""
    stock = Stock.of(blank(size, size, size), PITCH, bundles)
    stock.open_field()
    for bundle in stock.rays.values():
        u, v, w = cycle(bundle.axis)
        samples = np.concatenate([[0.0], np.linspace(0.0, size, 201), [size]])
        points = np.zeros((bundle.rows, bundle.columns, len(samples), 3))
        points[..., u] = ((np.arange(bundle.columns) + 0.5) * PITCH)[:, None]
        points[..., v] = ((np.arange(bundle.rows) + 0.5) * PITCH)[:, None, None]
        points[..., w] = samples
        points = points.reshape(-1, len(samples), 3)
        inside = (depth(points.reshape(-1, 3)) > 0.0).reshape(points.shape[:2])
        inside[:, [0, -1]] = False
        ray, at = np.nonzero(inside[:, 1:] != inside[:, :-1])
        low, high, upwards = points[ray, at].copy(), points[ray, at + 1].copy(), inside[ray, at + 1]
        for _ in range(30):
            middle = 0.5 * (low + high)
            found = (depth(middle) > 0.0) == upwards
            low, high = (
                np.where(found[:, None], low, middle),
                np.where(found[:, None], middle, high),
            )
        ends = high[:, w]
        parts = []
        for first, last in np.array(bundle.tiles()) * bundle.columns:
            own = (ray >= first) & (ray < last)
            count = np.bincount(ray[own & upwards] - first, minlength=last - first)
            parts.append((count, ends[own & upwards], ends[own & ~upwards]))
        bundle.put(parts)
    return stock


def is_closed(mesh):
    """Say whether every edge of a triangle is the reverse of as many others'."""
    t = mesh.triangles
    edges = np.vstack([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]])
    there, back = (
        edges[:, 0] * len(mesh.points) + edges[:, 1],
        edges[:, 1] * len(mesh.points) + edges[:, 0],
    )
    return np.array_equal(np.sort(there), np.sort(back))


def volume(mesh):
    a, b, c = np.moveaxis(mesh.corners(), 1, 0)
    return float((a * np.cross(b, c)).sum() / 6.0)


def leaning_box(points):
    return (np.array([6.0, 5.0, 4.0]) - np.abs((points - 10.0) @ LEAN.T)).min(axis=1)


def test_a_whole_blank_is_a_box_of_twelve_triangles():
    stock, mesh = of_heights(np.full((20, 30), 7.0))
    assert len(mesh.triangles) == 12 and is_closed(mesh)
    assert volume(mesh) == approx(stock.volume)


def test_a_pocket_has_upright_walls_and_a_level_floor():
    top = np.full((80, 100), 20.0)
    top[20:60, 30:70] = 5.0
    stock, mesh = of_heights(top)
    assert is_closed(mesh) and volume(mesh) == approx(stock.volume)
    assert np.isin(np.abs(mesh.normals()).max(axis=1), 1.0).all()
    assert set(mesh.points[:, 2]) == {0.0, 5.0, 20.0}


def test_a_rounded_surface_is_smooth_and_a_step_in_it_upright():
    y, x = np.indices((120, 160)) * PITCH
    top = 20.0 + 3.0 * np.sin(x / 9.0) * np.cos(y / 7.0) + 8.0 * (x > 40.0)
    stock, mesh = of_heights(top)
    assert is_closed(mesh) and volume(mesh) == approx(stock.volume, rel=1e-3)
    up = np.abs(mesh.normals()[:, 2])
    assert not ((up > 1e-9) & (up < 0.85)).any()


def test_columns_cut_through_are_holes_in_top_and_bottom():
    top = np.full((60, 60), 10.0)
    top[20:40, 20:40] = 0.0
    stock, mesh = of_heights(top)
    assert is_closed(mesh) and volume(mesh) == approx(stock.volume)
    inside = (
        (mesh.corners().mean(axis=1)[:, :2] > 10.5) & (mesh.corners().mean(axis=1)[:, :2] < 19.5)
    ).all(axis=1)
    assert not inside.any()


@pytest.mark.parametrize("seed", range(4))
def test_any_heights_make_a_closed_mesh_as_large_as_they_are(seed):
    rng = np.random.default_rng(seed)
    top = rng.integers(0, 5, (25, 31)).astype(float)
    if seed % 2:
        top = np.round(rng.random(top.shape) * 10.0, 1) * (rng.random(top.shape) > 0.2)
    stock, mesh = of_heights(top)
    assert is_closed(mesh) and volume(mesh) == approx(stock.volume, rel=5e-3)


def test_a_part_400_cells_long_is_quick_and_light():
    y, x = np.indices((300, 400)) * PITCH
    top = np.full((300, 400), 40.0)
    for k in range(4):
        for m in range(3):
            inside = np.maximum(np.abs(x - 25.0 - 50.0 * k), np.abs(y - 25.0 - 50.0 * m))
            top[inside < 20.0] = 5.0 + np.clip(inside[inside < 20.0] - 14.0, 0.0, None) ** 2 / 4.0
    mesh_zmap(top, 0.0, 0.0, 0.0, PITCH, 0.02)
    seconds = []
    for _ in range(3):
        began = time.process_time()
        points, triangles = mesh_zmap(top, 0.0, 0.0, 0.0, PITCH, 0.02)
        seconds.append(time.process_time() - began)
    assert min(seconds) < 0.1
    assert len(triangles) < 200_000 and len(points) < 100_000


def test_rough_heights_are_merged_until_there_are_few_enough_triangles():
    rng = np.random.default_rng(1)
    stock = Stock.of(blank(100.0, 100.0, 100.0), PITCH)
    stock.field.top[:] = 20.0 + 0.05 * rng.random(stock.field.top.shape)
    assert len(mesh_of(stock, most=200_000).triangles) > 20_000
    few = mesh_of(stock, most=20_000)
    assert (
        len(few.triangles) <= 20_000
        and is_closed(few)
        and volume(few) == approx(stock.volume, rel=5e-3)
    )


def test_a_leaning_box_in_three_bundles_keeps_its_edges():
    stock = of_solid(leaning_box)
    mesh = mesh_of(stock)
    assert is_closed(mesh) and volume(mesh) == approx(stock.volume, rel=5e-3)
    off = np.abs(leaning_box(mesh.points))
    assert off.max() < 0.3 * PITCH and np.quantile(off, 0.9) < 0.02
    # Twelve edges: points within a twentieth of a cell of two faces at once, all along.
    depths = np.array([6.0, 5.0, 4.0]) - np.abs((mesh.points - 10.0) @ LEAN.T)
    assert (np.sort(np.abs(depths), axis=1)[:, 1] < 0.3 * PITCH).sum() > 12 * 10


def test_a_ball_in_three_bundles_is_as_large_as_a_ball():
    mesh = mesh_of(of_solid(lambda points: 64.0 - ((points - 10.0) ** 2).sum(axis=1)))
    assert is_closed(mesh) and volume(mesh) == approx(4.0 / 3.0 * math.pi * 512.0, rel=5e-3)
    outward = (mesh.normals() * (mesh.corners().mean(axis=1) - 10.0)).sum(axis=1)
    # Slivers, where a node is nearly on the ball, may lean any way.
    assert mesh.areas()[outward < 7.5].sum() < 0.01 * mesh.areas().sum()


def test_the_blanks_own_faces_are_where_they_are():
    mesh = mesh_of(
        of_solid(
            lambda points: np.where(
                (np.abs(points[:, 0] - 9.7) < 4.6) & (points[:, 2] > 7.7), -1.0, 1.0
            )
        )
    )
    low, high = mesh.box()
    assert (low, high) == (approx(np.zeros(3), abs=1e-9), approx(np.full(3, 20.0), abs=1e-9))
    assert volume(mesh) == approx(20.0**3 - 9.2 * 20.0 * 12.3, rel=1e-3)


def test_three_bundles_are_seen_coarser_when_they_would_make_too_many_triangles():
    stock = of_solid(leaning_box)
    few = mesh_of(stock, most=1500)
    assert (
        len(few.triangles) <= 1500
        and is_closed(few)
        and volume(few) == approx(stock.volume, rel=0.02)
    )


def test_what_moves_have_cut_is_meshed_at_any_moment():
    ball = bull(10.0, 5.0)()
    stock, before = Stock.of(blank(60.0, 40.0, 20.0), 1.0, ("x", "y", "z")), math.inf
    for lean in (0.0, 0.4, -0.7):
        axes = [(0.0, lean, 1.0)] * 3
        run_stock(
            stock,
            moves_of([leaning_section(ball, [(10, 20, 30), (10, 20, 12), (50, 22, 10)], axes)]),
            WORLD,
        )
        mesh = mesh_of(stock)
        assert is_closed(mesh) and volume(mesh) == approx(stock.volume, rel=5e-3)
        assert volume(mesh) < before
        before = volume(mesh)


def test_rays_along_z_alone_make_a_closed_mesh_too():
    stock = of_solid(leaning_box, bundles=("z",))
    mesh = mesh_of(stock)
    assert is_closed(mesh) and volume(mesh) == approx(stock.volume, rel=5e-3)


def test_a_stock_without_rays_along_z_has_no_mesh():
    stock = of_solid(leaning_box, bundles=("x",))
    with pytest.raises(BadInput, match="rays along z"):
        mesh_of(stock)
