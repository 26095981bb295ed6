"""A small program that passes its proof, as text of both controls, and its proof, for tests of numbers that no machine could do."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any

import numpy as np

from trunnion.findings import BadInput
from trunnion.model.material import Material
from trunnion.model.motion.program import Program
from trunnion.model.verdict import BlockProof, Verdict
from trunnion.post.dialects.apt import AptDialect
from trunnion.post.dialects.linuxcnc import LinuxCncDialect
from trunnion.post.header import Header
from trunnion.post.readers import read_program
from trunnion.post.settings import PostSettings
from trunnion.shop import load_shop
from verify_tools import FACING, POCKETING, SETUP, clean_plan, proof

TOOLS = (FACING, POCKETING)
HEADER = Header(name="B1", part="B1", part_digest="ab12", plan_digest="cd34")
DIALECTS = {"linuxcnc": LinuxCncDialect, "apt": AptDialect}
AWKWARD = (
    "0",
    "-0",
    "+0",
    "1",
    "-1",
    "0.5",
    "-0.5",
    "0.000000000001",
    "-0.000000000001",
    "0.0004",
    "99999",
    "-99999",
    "100000",
    "100001",
    "99999999999",
    "-99999999999",
    "9" * 309,
    "1" + "0" * 300,
    "-1" + "0" * 300,
    "9" * 5000,
    "0." + "0" * 320 + "1",
    "1." + "3" * 400,
    "",
    ".",
    "-",
    "+",
    "--1",
    "+-1",
    "1.2.3",
    "..5",
    "1E300",
    "1e5",
    "1E-300",
    "1E400",
    "NAN",
    "INF",
    "-INF",
    "1_000",
    "0X10",
    "١٢",
    "½",
    "1,5",
)
"""What a hand can leave where a number belongs."""


@cache
def lines_of(dialect: str) -> tuple[str, ...]:
    """Return the lines of the clean plan's program."""
    made = Program(name="B1.S1", setup=SETUP, sections=clean_plan())
    return tuple(DIALECTS[dialect]().write([made], HEADER, PostSettings()).split("\n"))


@cache
def a_material() -> Material:
    """Return a material of the catalogue, so that loads are judged too."""
    materials = load_shop().materials
    return materials[min(materials)]


def read(dialect: str, text: str) -> Program:
    """Return what a text says of the clean plan's setup."""
    return read_program(dialect, text, TOOLS, SETUP)


def judged(program: Program) -> Verdict:
    """Return the verdict on a program that was read, on a coarse stock."""
    return proof(*program.sections, material=a_material(), cell=1.0, spacing=2.0, threads=1)


def outcome_of(dialect: str, text: str) -> Verdict | str:
    """Return the verdict on a text, or the line that refuses it; anything else that happens is raised."""
    try:
        program = read(dialect, text)
    except BadInput as refused:
        return str(refused)
    return judged(program)


def after(dialect: str, place: str, new: str) -> str:
    """Return the program's text with a line put in after the last one that contains `place`."""
    lines = list(lines_of(dialect))
    row = max(n for n, line in enumerate(lines) if place in line)
    return "\n".join([*lines[: row + 1], new, *lines[row + 1 :]])


def replaced(dialect: str, old: str, new: str) -> str:
    """Return the program's text with the last occurrence of a piece replaced."""
    head, found, tail = "\n".join(lines_of(dialect)).rpartition(old)
    assert found
    return head + new + tail


def not_finite(thing: Any, name: str = "") -> Iterator[str]:
    """Yield the names of all numbers in a verdict that are no finite numbers; what is left by a block that nothing is nearest to is NaN."""
    if isinstance(thing, BlockProof):
        thing = {
            f.name: getattr(thing, f.name) for f in fields(thing) if not f.name.startswith("left_")
        }
        yield from not_finite(tuple(thing.values()), name)
    elif is_dataclass(thing) and not isinstance(thing, type):
        for field in fields(thing):
            yield from not_finite(getattr(thing, field.name), f"{name}.{field.name}")
    elif isinstance(thing, np.ndarray):
        if thing.dtype.kind == "f" and not np.isfinite(thing).all():
            yield name
    elif isinstance(thing, tuple | list):
        for k, item in enumerate(thing):
            yield from not_finite(item, f"{name}[{k}]")
    elif isinstance(thing, float) and not math.isfinite(thing):
        yield name
