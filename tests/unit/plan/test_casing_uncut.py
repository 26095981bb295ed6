"""What cutters leave on casings, on small parts whose pieces are worked out by hand."""

from __future__ import annotations

from functools import cache
from math import acos, pi, sin, sqrt

import numpy as np
import pytest

import samples
from seeded.casings import MadeBoss, Shell, _with_boss
from trunnion.plan.casing.uncut.plan import uncut_pieces
from trunnion.recognize.casing import CasingFamily, CasingSettings
from trunnion.settings import choose

SHELL = Shell(radius=120.0, slope=0.0, length=80.0, wall=6.0, flange=8.0, rim=16.0, rib=0.0)
LOBE = (9.0, 5.0, 4.0)
"""Distance of the lobes from the middle, their radius, and that of the hollows between them, mm."""


def boss(outline: str, theta: float, z: float, sizes: tuple[float, ...]) -> MadeBoss:
    return MadeBoss(
        outline=outline, theta=theta, z=z, height=8.0, tilt=0.0, fillet=0.0, sizes=sizes, hole=0.0
    )


@cache
def part(*bosses: MadeBoss):
    body = SHELL.solid()
    for each in bosses:
        body = _with_boss(body, SHELL, each)
    made = samples.read(body.cut(SHELL.bore()).val().wrapped)
    found = CasingFamily().recognize(made.graph(), made, choose(CasingSettings, {}))
    return made.graph(), found


def lobe_area(radius: float) -> float:
    """Return what a cutter leaves of three lobes: N (t(r) - t(rho)), t(x) = s sqrt((a + x)^2 - s^2) - a^2 b - x^2 (pi - 2 b) / 2 with
    b = acos(s / (a + x)), a the lobes' radius, s half their distance, rho the hollows' radius."""
    distance, a, rho = LOBE
    s = distance * sin(pi / 3.0)

    def t(x: float) -> float:
        b = acos(s / (a + x))
        return s * sqrt((a + x) ** 2 - s**2) - a**2 * b - 0.5 * x**2 * (pi - 2.0 * b)

    return 3.0 * (t(radius) - t(rho)) if radius > rho else 0.0


@pytest.mark.parametrize("diameter", [6.0, 10.0, 16.0])
def test_a_cutter_leaves_between_lobes_what_its_radius_is_too_large_for(diameter: float) -> None:
    pieces = uncut_pieces(*reversed(part(boss("lobe", 40.0, 40.0, LOBE))), diameter)
    assert sum(p.area for p in pieces) == pytest.approx(lobe_area(0.5 * diameter), rel=1e-6)
    assert len(pieces) == (3 if diameter > 8.0 else 0)
    assert all(p.number == 1 and p.clears == pytest.approx(8.0, abs=0.01) for p in pieces)


def test_an_allowance_makes_hollows_narrower() -> None:
    small = uncut_pieces(*reversed(part(boss("lobe", 40.0, 40.0, LOBE))), 7.0, 1.0)
    assert len(small) == 3 and small[0].clears == pytest.approx(6.0, abs=0.01)


@cache
def pair(gap: float):
    """Return the bosses of two rectangles beside each other round the axis, with the same direction nearly, so far apart."""
    half = np.degrees(np.arcsin((0.5 * gap + 8.0) / 120.0))
    return part(
        boss("rectangle", 90.0 - half, 40.0, (16.0, 30.0, 2.0)),
        boss("rectangle", 90.0 + half, 40.0, (16.0, 30.0, 2.0)),
    )


def test_a_cutter_that_fits_between_two_bosses_leaves_nothing() -> None:
    graph, found = pair(12.0)
    assert uncut_pieces(found, graph, 10.0) == ()


def test_a_cutter_wider_than_the_gap_leaves_a_throat_between_two_bosses() -> None:
    graph, found = pair(12.0)
    (piece,) = uncut_pieces(found, graph, 16.0)
    assert piece.number == 2 and piece.owners == ("boss-01", "boss-02")
    assert 10.0 < piece.clears <= 12.01
    # The sides are 30 mm long; at either end the cutter comes in as far as it is stopped, less than its radius.
    assert 12.0 * (30.0 - 2.0 * 8.0) < piece.area < 12.0 * 30.0
    assert piece.volume == pytest.approx(8.0 * piece.area, rel=0.08)
    assert len(piece.end_lines) >= 4 and len(piece.boundary) > 20


def test_a_boss_beside_a_flange_leaves_a_throat_that_a_cutter_as_narrow_as_the_gap_clears() -> None:
    graph, found = part(boss("rectangle", 30.0, 8.0 + 7.0 + 6.0, (16.0, 14.0, 2.0)))
    (piece,) = uncut_pieces(found, graph, 12.0)
    assert (piece.number, piece.owners) == (3, ("boss-01", "pocket-01"))
    assert piece.clears == pytest.approx(6.0, abs=0.02)
    assert 6.0 * 10.0 < piece.area < 6.0 * 30.0
    assert uncut_pieces(found, graph, 5.9) == ()
