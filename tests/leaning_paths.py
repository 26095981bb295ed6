"""Machines with rotary axes, places of work on them, and paths whose tool leans, for the tests of posts and times."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from unittest import mock

import numpy as np

from own_shop import own_shop
from programs import FLAT_16, S1
from trunnion.geometry.arrays import Floats
from trunnion.model.material import Axis, Machine
from trunnion.model.motion.program import Program, ProgramSection
from trunnion.model.motion.toolpath import Mark, Motion, Toolpath
from trunnion.model.setup import Setup
from trunnion.model.tool import Tool
from trunnion.post.dialects.linuxcnc import LinuxCncDialect
from trunnion.post.header import Header
from trunnion.post.readers.linuxcnc import read_linuxcnc
from trunnion.post.readers.sections import SectionBlocks
from trunnion.post.readers.word_address import interpreter as control
from trunnion.post.readers.word_address.joints import Joints
from trunnion.post.settings import PostSettings
from trunnion.shop.kinematics import WorkPosition

SHOP = own_shop()
TABLE, FORK = SHOP.machine("Trunnion 650"), SHOP.machine("Gantry 6000 fork")
ENDLESS_FORK = replace(
    FORK, axes=(*FORK.axes[:3], replace(FORK.axes[3], low=-99999.0, high=99999.0), FORK.axes[4])
)
HEAD_AND_TABLE = replace(
    FORK,
    name="head B, table C",
    axes=(
        *FORK.axes[:3],
        Axis(
            name="B",
            kind="rotary",
            low=-100.0,
            high=100.0,
            rapid=9000.0,
            acceleration=600.0,
            direction=(0.0, 1.0, 0.0),
            carries="tool",
            point=(0.0, 0.0, 150.0),
        ),
        Axis(
            name="C",
            kind="rotary",
            low=-99999.0,
            high=99999.0,
            rapid=9000.0,
            acceleration=600.0,
            direction=(0.0, 0.0, -1.0),
            carries="work",
        ),
    ),
)
NUTATING = replace(
    TABLE,
    name="nutating table",
    axes=(
        *TABLE.axes[:3],
        Axis(
            name="B",
            kind="rotary",
            low=0.0,
            high=180.0,
            rapid=9000.0,
            acceleration=600.0,
            direction=(0.0, -math.sqrt(0.5), math.sqrt(0.5)),
            carries="work",
            point=(0.0, 0.0, 60.0),
        ),
        TABLE.axes[4],
    ),
)
MACHINES = (TABLE, ENDLESS_FORK, HEAD_AND_TABLE, NUTATING)
UP = np.array([0.0, 0.0, 1.0])
HEADER = Header(name="B1", part="B1", part_digest="ab12", plan_digest="cd34")


def lean(degrees: float, around: float = 0.0) -> Floats:
    """Return the axis that leans from z towards a direction in plan, both in degrees."""
    a, b = math.radians(degrees), math.radians(around)
    return np.array([math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)])


def standing(machine: Machine, foot: Sequence[float] = (10.0, 5.0, -40.0)) -> WorkPosition:
    """Return work on a machine, its foot in the setup frame, all of it within 120 mm round (10, 5, -20)."""
    return WorkPosition(
        machine=machine, foot=np.array(foot), centre=np.array([10.0, 5.0, -20.0]), radius=120.0
    )


def path_of(*stops: tuple[Sequence[float], Sequence[float]], feed: float = 1200.0) -> Toolpath:
    """Return a rapid to the first stop (tip, axis) and lines to the others."""
    n = len(stops)
    axis = np.array([a for _, a in stops], dtype=float)
    return Toolpath(
        position=[t for t, _ in stops],
        axis=axis / np.linalg.norm(axis, axis=1, keepdims=True),
        motion=[Motion.RAPID, *[Motion.LINE] * (n - 1)],
        centre=np.full((n, 3), np.nan),
        feed=[0.0, *[feed] * (n - 1)],
        mark=[Mark.RETRACT, *[Mark.CUT] * (n - 1)],
    )


def program(*paths: Toolpath, tool: Tool = FLAT_16, setup: Setup = S1) -> Program:
    """Return a program of operations with one tool."""
    return Program(
        name="B1.S1",
        setup=setup,
        sections=tuple(
            ProgramSection(operation=f"op-{n}", tool=tool, spindle=9000.0, path=path)
            for n, path in enumerate(paths, 1)
        ),
    )


def text_of(made: Program, place: WorkPosition, **settings) -> str:
    """Return the LinuxCNC text of a program."""
    return LinuxCncDialect().write(
        [made], HEADER, PostSettings(**settings), {made.setup.name: place}
    )


def again(
    text: str, place: WorkPosition, tools: Sequence[Tool] = (FLAT_16,), setup: Setup = S1
) -> Program:
    """Return what a text says, read back."""
    return read_linuxcnc(text, tools, setup, place)


def joint_rows(
    text: str, place: WorkPosition, tools: Sequence[Tool] = (FLAT_16,), setup: Setup = S1
) -> list[SectionBlocks]:
    """Return the blocks of every section as positions of the axes, before they are opened into what the tool does."""
    caught: list[SectionBlocks] = []

    class Caught(Joints):
        def opened(self, rows):
            caught.append(rows)
            return Joints.opened(self, rows)

    with mock.patch.object(control, "Joints", Caught):
        again(text, place, tools, setup)
    return caught
