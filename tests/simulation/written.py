"""What a shop gets: the files of one program, read without the program that wrote them."""

from __future__ import annotations

import json
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """A place in space: origin (3,) mm and axes (3, 3), a row an axis, in the coordinates of the part's file."""

    origin: np.ndarray
    axes: np.ndarray

    @staticmethod
    def of(origin: Any, x: Any, z: Any) -> Frame:
        """Return the right-handed frame of an origin and two axes."""
        return Frame(np.array(origin, float), np.array([x, np.cross(z, x), z], float))

    def into(self, points: np.ndarray) -> np.ndarray:
        """Return points (n, 3) of the part's file in this frame."""
        return (points - self.origin) @ self.axes.T


@dataclass(frozen=True, slots=True)
class Cutter:
    """A cutter of the tool list, mm: radius, radius of its corner, length; bodies above its flutes as (radius, height over the tip)."""

    radius: float
    corner: float
    length: float
    bodies: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True, eq=False)
class Written:
    """One setup's program: text, cutters by number, setup frame, box of the blank (2, 3) mm in a frame of its own."""

    text: str
    cutters: Mapping[int, Cutter]
    frame: Frame
    blank: np.ndarray
    blank_frame: Frame


def written(folder: Path, name: str, told: Mapping[str, Any]) -> list[Written]:
    """Return the programs NAME in a folder, a setup each; `told` is the JSON that `trunnion program --json` answers."""
    cutters = {
        t["number"]: cutter(t) for t in json.loads((folder / f"{name}.tools.json").read_text())
    }
    tree = ElementTree.parse(folder / f"{name}.process.xml")
    frames = {s.get("name"): _frame(s.find("frame")) for s in tree.iter("setup")}
    return [
        Written(
            (folder / s["nc"]).read_text(),
            cutters,
            frames[s["name"]],
            np.array([s["blank"]["min"], s["blank"]["max"]]),
            Frame.of(*(s["blank"]["frame"][key] for key in ("origin", "x", "z"))),
        )
        for s in told["setups"]
    ]


def cutter(entry: Mapping[str, Any]) -> Cutter:
    """Return the cutter of an entry of the tool list. Raises ValueError for forms that aren't known here."""
    radius = 0.5 * entry["diameter"]
    corners = {"flat": 0.0, "bull": entry["corner_radius"], "ball": radius}
    if entry["form"] not in corners:
        raise ValueError(f"tool {entry['number']}: the form {entry['form']} isn't known")
    shank = [
        (0.5 * entry["neck_diameter"], entry["flute_length"]),
        (0.5 * entry["shank_diameter"], entry["neck_length"]),
    ]
    holder = [
        end
        for z0, r0, z1, r1 in entry["holder"]
        for end in ((r0, entry["stickout"] + z0), (r1, entry["stickout"] + z1))
    ]
    bodies = tuple((r, z) for r, z in (*shank, *holder) if r > radius and z > 0.0)
    return Cutter(radius, corners[entry["form"]], entry["gauge_length"], bodies)


def _frame(element: Any) -> Frame:
    def numbers(tag: str) -> list[float]:
        return [float(element.find(tag).get(letter)) for letter in "xyz"]

    return Frame.of(numbers("origin"), numbers("x"), numbers("z"))
