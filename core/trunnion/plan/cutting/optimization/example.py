"""A cut of known numbers to be optimised, from a file: the impeller paper's example, and what a person writes like it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.plan.cutting.optimization import limits
from trunnion.plan.cutting.optimization.limits import PowerLaw
from trunnion.plan.cutting.optimization.problem import CuttingProblem, Economics
from trunnion.shop.reading import CatalogueEntry, by_name, entries, file_entries
from trunnion_resources import folder

EXAMPLES = "optimization"
"""The folder of resources with the cuts that are shipped."""
SPEED_UNITS = ("mm/s", "m/s")
_LARGE = 1e6
_SMALL = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class PrintedPoint:
    """A point that a source prints: spindle 1/min, feed per tooth mm, and its time (min), cost (money) and objective, NaN where it has
    none."""

    name: str
    spindle: float
    feed: float
    time: float
    cost: float
    objective: float


@dataclass(frozen=True, slots=True, kw_only=True)
class CutExample:
    """A cut with constant tool life and force by the handbook's power law; lengths mm, force N, power kW, feed mm/min, roughness um."""

    name: str
    title: str
    source: str
    spindle: tuple[float, float]
    feed: tuple[float, float]
    length: float
    nose_radius: float
    tool_life: float
    economics: Economics
    force: PowerLaw
    largest_force: float
    largest_power: float
    largest_feed: float
    largest_rt: float
    printed: tuple[PrintedPoint, ...]

    def reading(self, speed_unit: str) -> CutExample:
        """Return the cut with the cutting speed of its force in another unit, `mm/s` or `m/s`."""
        return replace(self, force=replace(self.force, speed_unit=speed_unit))

    def problem(self) -> CuttingProblem:
        """Return the choice of spindle speed and feed per tooth."""
        law = self.force

        def life(spindle: Floats) -> Floats:
            return np.full(np.shape(spindle), self.tool_life)

        first = self.printed[0] if self.printed else None
        return CuttingProblem(
            length=self.length,
            teeth=law.teeth,
            spindle=self.spindle,
            feed=self.feed,
            life=life,
            economics=self.economics,
            constraints=(
                law.limit(limits.FORCE, law.force, self.largest_force),
                law.limit(limits.POWER, law.power, self.largest_power),
                limits.feed_limit(law.teeth, self.largest_feed),
                limits.rt_limit(self.nose_radius, self.largest_rt),
            ),
            handbook=(first.spindle, first.feed) if first else (self.spindle[0], self.feed[0]),
            load=limits.POWER,
        )


def read_cuts(path: Path) -> tuple[CutExample, ...]:
    """Return the cuts of a TOML file, in its order; raise `BadInput` with file, entry and field of the first fault."""
    found = tuple(map(checked_cut, file_entries(path, str(path))))
    if not found:
        raise BadInput(f"{path}: there is no cut in it; a table [name] with cut and limits is one")
    return found


def example_cuts() -> tuple[CutExample, ...]:
    """Return the cuts that are shipped."""
    return tuple(map(checked_cut, by_name(entries(EXAMPLES, None)).values()))


def example_file() -> str:
    """Return where the shipped cuts lie, for a person who wants a copy to change."""
    return str(folder(EXAMPLES) / "impeller-paper.toml")


def checked_cut(entry: CatalogueEntry) -> CutExample:
    """Return the cut of one entry."""
    cut, bounds = entry.table("cut"), entry.table("limits")
    made = CutExample(
        name=entry.name,
        title=entry.text("title", ""),
        source=entry.text("source", ""),
        spindle=_range(entry, "spindle"),
        feed=_range(entry, "feed_per_tooth"),
        length=cut.number("length", _SMALL, _LARGE),
        nose_radius=cut.number("nose_radius", _SMALL, _LARGE),
        tool_life=cut.number("tool_life", _SMALL, _LARGE),
        economics=_economics(entry.table("economics")),
        force=_force(entry.table("force"), cut),
        largest_force=bounds.number("force", _SMALL, _LARGE),
        largest_power=bounds.number("power", _SMALL, _LARGE)
        * bounds.number("efficiency", _SMALL, 1.0, 1.0),
        largest_feed=bounds.number("feed", _SMALL, _LARGE),
        largest_rt=bounds.number("rt", _SMALL, _LARGE),
        printed=tuple(map(_printed, entry.tables("printed"))) if entry.has("printed") else (),
    )
    for read in (cut, bounds, entry):
        read.done()
    return made


def _range(entry: CatalogueEntry, name: str) -> tuple[float, float]:
    found = entry.numbers(name, _SMALL, _LARGE)
    if len(found) != 2 or found[0] > found[1]:
        raise entry.wrong(f"{name} must be the smallest and the largest value; got {found}")
    return found[0], found[1]


def _economics(entry: CatalogueEntry) -> Economics:
    names = ("auxiliary", "change", "rate", "tool", "by_data", "feed_exponent", "speed_exponent")
    made = Economics(**{name: entry.number(name, 0.0, _LARGE, 0.0) for name in names})
    entry.done()
    return made


def _force(entry: CatalogueEntry, cut: CatalogueEntry) -> PowerLaw:
    exponents = ("depth", "feed", "width", "diameter", "speed")
    unit = entry.text("speed_unit", SPEED_UNITS[0])
    if unit not in SPEED_UNITS:
        raise entry.wrong(f"speed_unit must be one of {', '.join(SPEED_UNITS)}; got {unit}")
    made = PowerLaw(
        correction=entry.number("correction", _SMALL, _LARGE),
        coefficient=entry.number("coefficient", _SMALL, _LARGE),
        **{f"{name}_exponent": entry.number(f"{name}_exponent", _SMALL, 5.0) for name in exponents},
        depth=cut.number("depth", _SMALL, _LARGE),
        width=cut.number("width", _SMALL, _LARGE),
        diameter=cut.number("diameter", _SMALL, _LARGE),
        teeth=cut.count("teeth", 1, 1000),
        speed_unit=unit,
    )
    entry.done()
    return made


def _printed(entry: CatalogueEntry) -> PrintedPoint:
    nothing = float("nan")
    made = PrintedPoint(
        name=entry.text("name"),
        spindle=entry.number("spindle", _SMALL, _LARGE),
        feed=entry.number("feed_per_tooth", _SMALL, _LARGE),
        time=entry.number("time", 0.0, _LARGE) if entry.has("time") else nothing,
        cost=entry.number("cost", 0.0, _LARGE) if entry.has("cost") else nothing,
        objective=entry.number("objective", 0.0, _LARGE) if entry.has("objective") else nothing,
    )
    entry.done()
    return made
