"""Roughing at constant engagement: how deep and how wide, and whether it is quicker than layers by contour-parallel passes."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from trunnion import tolerance
from trunnion.model.material import Machine, Material
from trunnion.model.operation import CuttingData
from trunnion.model.tool import Tool
from trunnion.plan.cutting.milling import (
    ROUGH,
    CuttingSettings,
    cutting_data,
    layer_depth,
    layer_width,
    slenderness,
)
from trunnion.units import trimmed

CONSTANT_ENGAGEMENT, CONTOUR_PARALLEL = "constant-engagement", "contour-parallel"
"""How a layer is cleared."""

BY_TIME = "by-time"
"""Each layer in the quicker of both."""

ENGAGED = (CONSTANT_ENGAGEMENT, BY_TIME)
"""Patterns whose cutting data are for constant engagement."""

ENGAGED_OVERHEAD, PARALLEL_OVERHEAD = 1.2, 1.35
"""Time that passes and links of a layer take over the layer's volume by the removal rate: crescents run in and come back; slots, corners
and links of contour-parallel passes go slower. Measured on pockets of 100 to 300 mm with cutters of 12 to 20 mm."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RoughingChoice:
    """A pattern, the cutting data that go with it, and why in words."""

    pattern: str
    data: CuttingData
    rule: str


def engaged_depth(tool: Tool, material: Material, settings: CuttingSettings) -> float:
    """Return the depth of cut in mm that a cutter bears at constant engagement: its flank is used."""
    return min(_deepest(tool, material, settings), tool.flute_length)


def engaged_width(tool: Tool, material: Material, settings: CuttingSettings, depth: float) -> float:
    """Return the width of cut in mm at constant engagement in a depth of cut (mm).

    Less deep it may be wider: a section ap ae bends the cutter the same, as far as the material bears the larger angle of contact.
    """
    width = min(material.widest_engaged_factor * settings.width_share, 1.0) * tool.diameter
    widest = min(material.shallow_width_factor * settings.width_share, 1.0) * tool.diameter
    section = width * _deepest(tool, material, settings)
    return max(width, min(section / depth, widest))


def _deepest(tool: Tool, material: Material, settings: CuttingSettings) -> float:
    factor = material.deepest_engaged_factor
    return factor * settings.depth_share * slenderness(tool, settings) * tool.diameter


def engaged_data(
    tool: Tool,
    material: Material,
    machine: Machine,
    settings: CuttingSettings,
    depth: float,
    width: float,
) -> CuttingData:
    """Return the cutting data of roughing at constant engagement at a depth and width (mm), with those of layers that slots open: entries,
    necks and what is too shallow are cut by them."""
    data = cutting_data(tool, material, machine, ROUGH, settings, depth, width)
    deep = min(layer_depth(tool, material, settings), depth)
    layers = cutting_data(
        tool, material, machine, ROUGH, settings, deep, layer_width(tool, material, settings)
    )
    return replace(
        data,
        layer_depth=deep,
        layer_width=layers.width,
        layer_share=min(layers.feed / data.feed, 1.0),
    )


def roughing_choice(
    tool: Tool,
    material: Material,
    machine: Machine,
    settings: CuttingSettings,
    height: float,
    wanted: str = BY_TIME,
) -> RoughingChoice:
    """Return how a pocket of a height (mm) is roughed by a cutter: as `wanted`, or in the pattern that takes less time.

    A layer's time goes with the width of cut times the feed, and there are as many as the depth of cut asks for.
    """
    deep = even_depth(height, engaged_depth(tool, material, settings))
    wide = engaged_width(tool, material, settings, deep)
    engaged = engaged_data(tool, material, machine, settings, deep, wide)
    parallel = cutting_data(
        tool,
        material,
        machine,
        ROUGH,
        settings,
        even_depth(height, layer_depth(tool, material, settings)),
        layer_width(tool, material, settings),
    )
    slower = ENGAGED_OVERHEAD / engaged.removal_rate > PARALLEL_OVERHEAD / parallel.removal_rate
    pattern = CONTOUR_PARALLEL if wanted == BY_TIME and slower else wanted
    taken, other = (parallel, engaged) if pattern == CONTOUR_PARALLEL else (engaged, parallel)
    return RoughingChoice(
        pattern=pattern,
        data=taken,
        rule=f"{pattern}: {trimmed(taken.removal_rate, 0)} cm3/min at ap {trimmed(taken.depth, 2)}, ae {trimmed(taken.width, 2)}; "
        f"{trimmed(other.removal_rate, 0)} at ap {trimmed(other.depth, 2)}, ae {trimmed(other.width, 2)}",
    )


def strip_engagement(
    tool: Tool,
    material: Material,
    machine: Machine,
    settings: CuttingSettings,
    kind: str,
    height: float,
    width: float,
) -> tuple[float, float]:
    """Return the depth and width in mm that take a strip of a height and width off along a wall in the least time: layers and rings as
    those that slots open, or along the flank at the width of constant engagement, which a straight pass keeps by itself.

    The time goes with the number of passes over their feed. In a notch of the outline a ring meets a slot: only materials that bear slots
    deeper than cuts along walls are cut along the flank.
    """

    def passes(deepest: float, widest: Callable[[float], float]) -> tuple[float, float, float]:
        deep = even_depth(height, deepest)
        wide = min(widest(deep), width)
        feed = cutting_data(tool, material, machine, kind, settings, deep, wide).feed
        count = math.ceil(height / deep - tolerance.COINCIDENT)
        count *= math.ceil(width / wide - tolerance.COINCIDENT)
        return count / feed, deep, wide

    layered = passes(
        layer_depth(tool, material, settings), lambda _: layer_width(tool, material, settings)
    )
    flank = passes(
        engaged_depth(tool, material, settings),
        lambda deep: engaged_width(tool, material, settings, deep),
    )
    found = [layered]
    if material.bears_deep_slots:
        found.append(flank)
    _, depth, taken = min(found, key=lambda each: each[0])
    return depth, taken


def even_depth(height: float, most: float) -> float:
    """Return the depth of equal layers of at most `most`.

    >>> even_depth(36.0, 15.0)
    12.0
    """
    return height / max(math.ceil(height / most - tolerance.COINCIDENT), 1)
