"""Estimates of gains from files: areas and measured times, checked as catalogues are, with one clear line for what is wrong."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from trunnion.findings import BadInput
from trunnion.plan.freeform.estimate.efficiency import AreaRate, CutterAreas, EfficiencyEstimate
from trunnion.shop.reading import CatalogueEntry, by_name, entries, file_entries
from trunnion_resources import folder

EXAMPLES = "estimates"
"""The folder of resources with estimates that are shipped: the surface paper's."""
LARGEST_AREA, LONGEST_TIME = 1e12, 1e9
"""mm2 and s beyond which a figure is a slip of the hand: a square kilometre, thirty years."""
SMALLEST = 1e-6
"""mm2 and s below which nothing is finished."""


def read_estimates(path: Path) -> tuple[EfficiencyEstimate, ...]:
    """Return the estimates of a TOML file, in its order; raise `BadInput` with file, entry and field of the first fault."""
    found = tuple(map(checked_estimate, file_entries(path, str(path))))
    if not found:
        raise BadInput(
            f"{path}: there is no estimate in it; a table [name] with large and small is one"
        )
    return found


def example_estimates() -> tuple[EfficiencyEstimate, ...]:
    """Return the estimates that are shipped, in the order of files and of what stands in them."""
    return tuple(map(checked_estimate, by_name(entries(EXAMPLES, None)).values()))


def example_file() -> str:
    """Return where the shipped estimates lie, for a person who wants a copy to change."""
    return str(folder(EXAMPLES) / "quick-segmentation.toml")


def typed_estimate(
    large: Mapping[str, str], small: Mapping[str, str], name: str = "typed"
) -> EfficiencyEstimate:
    """Return the estimate of figures as a person types them, by the names of a file's fields; areas are parted by commas or spaces.

    Raises `BadInput` for the first one that can't be used.
    """
    fields = {"large": _typed(large), "small": _typed(small)}
    return checked_estimate(CatalogueEntry(file="areas and times", name=name, fields=fields))


def _typed(fields: Mapping[str, str]) -> dict[str, Any]:
    words = re.split(r"[\s,;+]+", fields.get("areas", ""))
    return {
        **fields,
        "areas": [_number(word) for word in words if word],
        "measured_area": _number(fields.get("measured_area", "")),
    }


def _number(word: str) -> float | str:
    """Return the number that a word is, else the word: the check of the field refuses it."""
    try:
        return float(word)
    except ValueError:
        return word


def checked_estimate(entry: CatalogueEntry) -> EfficiencyEstimate:
    """Return the estimate of one entry: `large` and `small`, each with `areas`, `measured_area` and `measured_time`."""
    made = EfficiencyEstimate(
        name=entry.name,
        title=entry.text("title", ""),
        source=entry.text("source", ""),
        large=_cutter(entry.table("large"), "large cutter"),
        small=_cutter(entry.table("small"), "small cutter"),
    )
    entry.done()
    if not (made.large.areas or made.small.areas):
        raise entry.wrong("neither cutter has an area")
    return made


def _cutter(entry: CatalogueEntry, name: str) -> CutterAreas:
    made = CutterAreas(
        cutter=entry.text("cutter", name),
        areas=entry.numbers("areas", SMALLEST, LARGEST_AREA, may_be_empty=True),
        rate=AreaRate(
            area=entry.number("measured_area", SMALLEST, LARGEST_AREA),
            time=entry.seconds("measured_time", SMALLEST, LONGEST_TIME),
        ),
    )
    entry.done()
    return made
