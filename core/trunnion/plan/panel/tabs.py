"""Tabs on a panel's outline: where the operations that cut it leave them, and what a person is told of their number and thickness."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from trunnion.findings import Finding, error, info, warning
from trunnion.model.operation import Operation
from trunnion.model.tabs import HEIGHT, POSITIONS, RAMP, WIDTH, Tab, written
from trunnion.plan.prismatic.drive import IN_CORNERS, OF_OUTLINES, WALL_ALLOWANCE, profile_bottom
from trunnion.plan.prismatic.regions import SetupSpace
from trunnion.plan.prismatic.tabs import TabForm, TabSettings, spread_tabs
from trunnion.plan.settings import HALVES
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import Value
from trunnion.units import trimmed

LEAD_SPACE = 5.0
"""mm that the channel is wider than the largest cutter on the outline and the allowance: space for the finishing cutter's leads, and one or
more rings of roughing beside the slot that opens it."""


def with_tabs(
    operations: Sequence[Operation],
    space: SetupSpace,
    settings: TabSettings,
    progress: Progress = NO_PROGRESS,
) -> tuple[list[Operation], list[Finding]]:
    """Return a setup's operations, those on its outline with the tabs that they leave, and what is told of them.

    Without tabs in the settings they are as they were. An outline that is cut half from each side has none.
    """
    if settings.count == 0 and settings.distance == 0.0:
        return list(operations), []
    changed, findings = list(operations), []
    outlines = dict.fromkeys(o.feature for o in operations if o.kind in OF_OUTLINES)
    for feature in outlines:
        mine = [
            o for o in operations if o.feature == feature and o.kind in (*OF_OUTLINES, *IN_CORNERS)
        ]
        if any(o.choices.get(HALVES) is True for o in mine):
            findings.append(
                error(
                    "route.no-tabs",
                    f"{feature} is cut half from each side: no tabs are planned there",
                    feature,
                    remedy="set profile.tabs.count and profile.tabs.distance to 0 and hold the part by other means",
                )
            )
            continue
        form = _form(mine, space, settings)
        wanted, tabs = _positioned(form, space, settings, progress)
        findings.append(_report(feature, wanted, tabs, form))
        if tabs:
            given = _choices(tabs, settings)
            changed = [
                replace(o, choices={**o.choices, **given}, rules=(*o.rules, _rule(o, tabs)))
                if o in mine
                else o
                for o in changed
            ]
    return changed, findings


def frame_at_edges(tabs: bool, space: SetupSpace) -> list[Finding]:
    """Return what is told of a setup that cuts the part on its edge where tabs hold it in the blank's frame: the frame is in the way."""
    if not tabs or not space.is_on_edge:
        return []
    name = space.setup.name
    return [
        warning(
            "route.frame-at-edge",
            f"{name} cuts the part on its edge, where the blank's frame that tabs hold it in is in the way",
            name,
            remedy=f"cut the tabs off before {name} and clamp the part itself, or plan without tabs",
        )
    ]


def _form(operations: Sequence[Operation], space: SetupSpace, settings: TabSettings) -> TabForm:
    """Return what the tabs of an outline have in common. How wide the channel is follows from the cutters alone, not from their data, which
    depend on the blank."""
    widest = max(o.cutter.diameter for o in operations)
    allowance = max(float(o.choices.get(WALL_ALLOWANCE, 0.0)) for o in operations)
    return TabForm(
        width=settings.width,
        height=settings.height,
        ramp=math.radians(settings.ramp_angle),
        channel=widest + allowance + LEAD_SPACE,
        frame=settings.frame,
        radius=0.5 * widest,
        bottom=profile_bottom(space, False),
        top=space.top,
    )


def _positioned(
    form: TabForm, space: SetupSpace, settings: TabSettings, progress: Progress
) -> tuple[int, list[Tab]]:
    """Return how many tabs are wanted along all outlines, and those that there are."""
    around, blank, wanted = space.silhouette(), space.blank_area(), 0
    tabs: list[Tab] = []
    if form.height >= form.top - form.bottom:
        return settings.count, tabs
    for piece in around.pieces:
        spaced = piece.outer.length / settings.distance if settings.distance > 0.0 else 0.0
        count = max(settings.count, math.ceil(spaced))
        wanted += count
        tabs += spread_tabs(piece.outer, around, blank, space.section, form, count, progress)
    return wanted, tabs


def _choices(tabs: Sequence[Tab], settings: TabSettings) -> dict[str, Value]:
    rows = ((*t.middle, t.bottom, math.degrees(t.direction), t.reach) for t in tabs)
    return {
        POSITIONS: written(rows),
        WIDTH: settings.width,
        HEIGHT: settings.height,
        RAMP: settings.ramp_angle,
    }


def _report(feature: str, wanted: int, tabs: Sequence[Tab], form: TabForm) -> Finding:
    """Return what is told of the tabs of an outline: an error where there is none, for nothing would hold the part in its frame."""
    needed = trimmed(form.channel + form.frame, 1)
    remedy = (
        f"make the blank wider: {needed} mm beside the outline (blank.side) is the channel of {trimmed(form.channel, 1)} mm and a frame "
        f"of {trimmed(form.frame, 1)} mm; tabs need straight pieces of {trimmed(2.0 * form.half_length, 1)} mm with solid material behind "
        "them: smaller cutters (route.largest), narrower or lower tabs ask for less"
    )
    if not tabs:
        return error(
            "route.no-tabs",
            f"none of the {wanted} tabs has a place on {feature}",
            feature,
            remedy=f"{remedy}; or set profile.tabs.count and profile.tabs.distance to 0",
        )
    if len(tabs) < wanted:
        return warning(
            "route.few-tabs",
            f"{len(tabs)} of {wanted} tabs have a place on {feature}",
            feature,
            remedy=remedy,
        )
    return info("route.tabs", f"{feature}: {_sentence(tabs)}", feature)


def _sentence(tabs: Sequence[Tab]) -> str:
    first = tabs[0]
    return (
        f"{len(tabs)} tabs {trimmed(first.width, 2)} mm wide and {trimmed(first.height, 2)} mm thick hold the part in the blank's frame; "
        "they are cut off by hand afterwards"
    )


def _rule(operation: Operation, tabs: Sequence[Tab]) -> str:
    return f"It is lifted over the tabs: {_sentence(tabs)}."
