"""Lines on walls that meet the hub without fillets."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

import wheels
from leaning_tools import cutter
from trunnion.toolpath.contact_passes.channel_finish import off_hub
from trunnion.toolpath.contact_passes.contacts import Contacts

RADIUS = 2.0
BALL = cutter("ball", 2.0 * RADIUS, RADIUS)


def line_at(height: float) -> Contacts:
    """Return a line along the stream on a radial wall, as high over the hub as said, whose normal points round the axis."""
    channel = wheels.channel()
    u = np.linspace(0.2, 0.8, 20)
    rz = channel.meridian.at(u, height / channel.meridian.height(u))
    point = np.column_stack([rz[:, 0], np.zeros(20), rz[:, 1]])
    return Contacts(point=point, normal=np.tile([0.0, 1.0, 0.0], (20, 1)))


def drive():
    return SimpleNamespace(
        channels=(wheels.channel(),), surface=SimpleNamespace(feature="blade-01")
    )


def test_a_ball_stays_above_its_radius_over_the_hub():
    lines, left = off_hub([line_at(1.2 * RADIUS)], drive(), BALL)
    assert [len(c) for c in lines] == [20] and not left


def test_what_lies_deeper_is_left_and_said():
    lines, left = off_hub([line_at(0.5 * RADIUS), line_at(1.2 * RADIUS)], drive(), BALL)
    assert len(lines) == 1
    assert [f.code for f in left] == ["wheel.left"] and "sharp root" in left[0].text
