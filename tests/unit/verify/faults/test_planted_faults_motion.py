"""Gouges planted for every cutter form and motion: upright, leaning, and turning on the way; each with its clean twin.

All are operations of one program on the block whose pocket was cut before: the verdict judges each by itself.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from pytest import approx

from leaning import (
    FIVE_AXES,
    RIGHT,
    SMALL,
    UP,
    block_facets,
    depth_in_plane,
    lean,
    long_reaching,
    poses_between,
    section_through,
    standing_out,
)
from trunnion import tolerance
from trunnion.model.verdict import Outcome
from verify_tools import FILLET, FLOOR, TAGS, TOP, clean_plan, proof, tool_of

DEPTHS = {"clean": 0.0, "5 um": 0.005, "50 um": 0.05}
PLANES = {"floor": ((0.0, 0.0, 1.0), FLOOR), "wall": ((-1.0, 0.0, 0.0), -RIGHT)}
"""Normal of a plane of the pocket, and how far along it the plane lies."""
AXES = {
    "floor": {
        "upright": (UP, UP),
        "leaning": (lean(15.0),) * 2,
        "turning": (lean(5.0), lean(25.0, 175.0)),
    },
    "wall": {
        "upright": (UP, UP),
        "leaning": (lean(15.0),) * 2,
        "turning": (lean(10.0), lean(25.0, 160.0)),
    },
}
WAYS = {
    "floor": ((2.0, 0.0, 0.0), (5.0, 1.0, 0.0)),
    "wall": ((0.0, -1.5, FLOOR + 2.5), (0.0, 1.5, FLOOR + 3.0)),
}
SHARES = np.linspace(0.0, 1.0, 401)
BALL = long_reaching(tool_of("ball", diameter=3.0, corner_radius=1.5, flute_length=12.0))


@dataclass(frozen=True)
class Fault:
    """A planted fault: its operation, the kind of face, how deep it is by plain measure, and whether the axis turns."""

    operation: str
    kind: str
    depth: float
    turning: bool


def named():
    """Return the operations of the faults, each with the cutter (None: the ball in a fillet or on an edge), kind of face, motion, depth."""
    flat = [
        (f"{form} {kind} {motion} {name}", (tool, kind, motion, name))
        for form, tool in SMALL.items()
        for kind, motions in AXES.items()
        for motion in motions
        # The flank of a taper leans out: upright it meets the wall's edge first.
        if (form, kind, motion) != ("taper", "wall", "upright")
        for name in DEPTHS
    ]
    return dict(flat) | {
        f"ball {kind} {motion} {name}": (None, kind, motion, name)
        for kind in ("fillet", "edge")
        for motion in AXES["wall"]
        for name in DEPTHS
    }


NAMED = named()


def planted(operation):
    """Return the fault of an operation and the section that commits it."""
    tool, kind, motion, name = NAMED[operation]
    axes, depth = AXES.get(kind, AXES["wall"])[motion], DEPTHS[name]
    if tool is None:
        poses = (in_fillet if kind == "fillet" else on_edge)(axes, depth)
    else:
        poses = touching(tool, kind, axes, depth)
        depth = plain(tool, kind, poses)
    fault = Fault(operation, kind, depth, motion == "turning")
    return fault, section_through(tool or BALL, operation, poses)


def touching(tool, kind, axes, depth):
    """Return two poses between which a cutter reaches just `depth` beyond a plane at its deepest."""
    normal, at = np.array(PLANES[kind][0]), PLANES[kind][1]
    ends = [
        np.array(tip)
        + normal * (at + standing_out(tool, np.array([axis]), normal)[0] - np.array(tip) @ normal)
        for tip, axis in zip(WAYS[kind], axes, strict=True)
    ]
    poses = list(zip(ends, axes, strict=True))
    beyond = float(reaching(tool, kind, poses).max())
    return [(tip + normal * (beyond - depth), axis) for tip, axis in poses]


def reaching(tool, kind, poses):
    """Return how far beyond a plane a cutter reaches along a move (k,)."""
    normal, at = np.array(PLANES[kind][0]), PLANES[kind][1]
    tips, axes = poses_between(*poses, SHARES)
    return at + standing_out(tool, axes, normal) - tips @ normal


def plain(tool, kind, poses):
    """Return how deep the plane is in the cutter at the deepest, by brute force where it reaches furthest beyond it."""
    beyond, (_, axes) = reaching(tool, kind, poses), poses_between(*poses, SHARES)
    if beyond.max() <= 1e-9:
        return 0.0
    # A cutter that keeps its axis is deepest where it reaches furthest.
    keeps = np.array_equal(poses[0][1], poses[1][1])
    furthest = np.argsort(-beyond)
    tried = furthest[:1] if keeps else np.unique([0, len(SHARES) - 1, *furthest[:5]])
    return max(
        depth_in_plane(tool, axes[k], PLANES[kind][0], beyond[k]) for k in tried if beyond[k] > 0.0
    )


def ball_along(axes, centre):
    """Return two poses whose ball's centre, mid between them at the latest, is at a place (x, z), and passes it in y."""
    tips = [
        np.array([centre[0], y, centre[1]]) - BALL.radius * np.array(axis)
        for y, axis in zip((-1.5, 1.5), axes, strict=True)
    ]
    return list(zip(tips, axes, strict=True))


def shifted(axes, centre, depth_at, depth, way):
    """Return poses of the ball moved along a direction in (x, z) until its deepest point along the move is `depth`."""
    low, high = -0.5, 0.5
    for _ in range(60):
        middle = 0.5 * (low + high)
        poses = ball_along(axes, centre + middle * way)
        tips, turned = poses_between(*poses, SHARES)
        deepest = depth_at(tips + BALL.radius * turned).max()
        low, high = (middle, high) if deepest < depth else (low, middle)
    return ball_along(axes, centre + low * way)


def in_fillet(axes, depth):
    """The fillet between floor and right wall: its axis is 2 mm from both."""
    middle, way = np.array([RIGHT - FILLET, FLOOR + FILLET]), np.array([0.8, -0.6])
    return shifted(
        axes,
        middle + 0.5 * way,
        lambda c: np.hypot(c[:, 0] - middle[0], c[:, 2] - middle[1]) + BALL.radius - FILLET,
        depth,
        way,
    )


def on_edge(axes, depth):
    """The pocket's upper rim at the right."""
    edge, way = np.array([RIGHT, TOP]), np.array([0.6, -0.8])
    return shifted(
        axes,
        edge - BALL.radius * way,
        lambda c: BALL.radius - np.hypot(c[:, 0] - edge[0], c[:, 2] - edge[1]),
        depth,
        way,
    )


@pytest.fixture(scope="module")
def judged():
    """The faults by operation, what the verdict says of every operation, and its errors by operation."""
    faults, sections = zip(*map(planted, NAMED), strict=True)
    verdict = proof(
        *clean_plan(), *sections, machine=FIVE_AXES, facets=block_facets(), bundles="z", cell=1.0
    )
    errors = {}
    for f in verdict.findings:
        if f.severity == "error":
            errors.setdefault(f.where[0], set()).add(f.code)
    return {f.operation: f for f in faults}, {o.operation: o for o in verdict.operations}, errors


@pytest.mark.parametrize("operation", NAMED)
def test_contact_measures_a_gouge_of_every_form_and_motion_within_its_bound(judged, operation):
    faults, operations, errors = judged
    fault = faults[operation]
    found = operations[fault.operation]
    bound = (tolerance.TURNING_BOUND if fault.turning else tolerance.CONTACT_BOUND) + 1e-3
    assert found.gouge == approx(fault.depth, abs=bound)
    if fault.depth > 0.02:
        faces = {
            TAGS["floor"],
            *range(TAGS["wall"], TAGS["wall"] + 4),
            *range(TAGS["fillet"], TAGS["fillet"] + 4),
            TAGS["top"],
        }
        assert found.outcome is Outcome.FAILED
        assert "verify.gouge" in errors[fault.operation]
        assert found.gouges[0][0] in faces
    else:
        assert found.outcome is Outcome.PASSED
        assert fault.operation not in errors
