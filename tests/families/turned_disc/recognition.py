"""Recognition of turned discs: ends, rim and bevels about one axis, and slots sunk into an end."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.findings import error
from trunnion.geometry.frame import Frame
from trunnion.model.feature import FaceRole, Feature, Recognition
from trunnion.progress import NO_PROGRESS
from trunnion.recognize.contract import Suitability
from trunnion.recognize.revolution import main_axis, of_revolution
from trunnion.settings import setting, settings
from trunnion.tolerance import COINCIDENT
from trunnion.units import percent
from turned_disc.kinds import BEVEL, END, KINDS, RIM, SLOT

ALONG = 0.999
"""Cosine from which on two directions are the same."""
DECIMALS = 4
"""Decimals of sizes in mm."""


@settings("recognize.turned_disc")
class TurnedDiscSettings:
    """What decides whether a cone is a bevel."""

    widest_bevel: float = setting(
        10.0,
        unit="mm",
        low=0.1,
        high=100.0,
        label="Widest bevel",
        help="A cone that is higher than this along the axis is no bevel.",
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Disc:
    """Rows of the faces of a disc by what they are, and the frame with z towards the end that is milled."""

    frame: Frame
    top: int
    bottom: int
    rims: tuple[int, ...]
    bevels: tuple[int, ...]
    slots: tuple[tuple[int, ...], ...]

    @property
    def rows(self):
        """All rows."""
        return {
            self.top,
            self.bottom,
            *self.rims,
            *self.bevels,
            *(r for s in self.slots for r in s),
        }


def disc_of(graph):
    """Return the disc that a face graph shows, None when it shows none."""
    axis = main_axis(graph) if len(graph) and not graph.open_edges else None
    if axis is None:
        return None
    turned = of_revolution(graph, axis)
    across = np.abs(graph.normal @ axis.direction) > ALONG
    height = axis.height(graph.centre)
    flat = [r for r in np.flatnonzero(turned & across).tolist() if graph.surface[r] == "plane"]
    bulging = turned & (graph.bend > 0)
    rims = tuple(r for r in np.flatnonzero(bulging).tolist() if graph.surface[r] == "cylinder")
    bevels = tuple(r for r in np.flatnonzero(bulging).tolist() if graph.surface[r] == "cone")
    if len(flat) < 2 or not rims:
        return None
    low, high = min(flat, key=height.__getitem__), max(flat, key=height.__getitem__)
    slots = tuple(_slot(graph, floor, turned) for floor in flat if floor not in (low, high))
    milled = {n for slot in slots for r in slot for n in graph.neighbours(r)} & {low, high}
    bevelled = {n for r in bevels for n in graph.neighbours(r)} & {low, high}
    top = next(iter(sorted(milled or bevelled or {high})))
    bottom = low if top == high else high
    frame = Frame(
        axis.point + axis.direction * height[bottom], _along(graph, slots), graph.normal[top]
    )
    return Disc(frame=frame, top=top, bottom=bottom, rims=rims, bevels=bevels, slots=slots)


def _slot(graph, floor, turned):
    """Return the rows of a slot: its floor, then the walls that rise from it."""
    return (floor, *(r for r in graph.neighbours(floor) if not turned[r]))


def _along(graph, slots):
    """Return the direction (3,) of the longest straight edge of the first slot's floor, of the graph's where there is none."""
    edges = graph.edges_of[slots[0][0]] if slots else range(len(graph.curve))
    straight = [e for e in edges if graph.curve[e] == "line"]
    longest = max(straight or edges, key=lambda e: graph.length[e])
    way = graph.end[longest] - graph.start[longest]
    return way if np.linalg.norm(way) > COINCIDENT else graph.middle[longest] - graph.start[longest]


class TurnedDiscFamily:
    """Flat discs, turned all round, with slots in one end."""

    name, noun, kinds, settings = "turned_disc", "a turned disc", KINDS, TurnedDiscSettings

    def suits(self, graph):
        """Return the share of the area that a disc explains."""
        disc = disc_of(graph)
        if disc is None:
            return Suitability(score=0.0, explained=0.0, reason="no rim between two flat ends")
        share = min(1.0, float(graph.area[sorted(disc.rows)].sum() / graph.area.sum()))
        return Suitability(
            score=share,
            explained=share,
            reason=f"{percent(share)} of the area a disc with its slots",
        )

    def recognize(self, graph, slicer, settings, progress=NO_PROGRESS):
        """Return ends, rims, bevels and slots; every other face is unexplained, with a finding."""
        progress.at(0.0, "looking for the disc")
        disc = progress.aside(lambda _: disc_of(graph))
        present = np.flatnonzero(graph.area > 0.0).tolist()
        if disc is None:
            none = error(
                "disc.none", "no rim between two flat ends", remedy="choose another family"
            )
            return _found(
                self.name, graph, Frame(np.zeros(3), [1, 0, 0], [0, 0, 1]), (), present, none
            )
        local, features = graph.in_frame(disc.frame), []
        top = local.centre[disc.top][2]
        features.append(_feature(END, 1, {"top": [disc.top], "bottom": [disc.bottom]}, height=top))
        for n, row in enumerate(progress.each(disc.rims), 1):
            features.append(_feature(RIM, n, {"wall": [row]}, diameter=2.0 * graph.radius[row]))
        for n, row in enumerate(
            b for b in disc.bevels if _bevel(local, b)["height"] <= settings.widest_bevel
        ):
            features.append(_feature(BEVEL, n + 1, {"bevel": [row]}, **_bevel(local, row)))
        for n, (floor, *walls) in enumerate(progress.each(disc.slots), 1):
            features.append(
                _feature(
                    SLOT,
                    n,
                    {"floor": [floor], "wall": walls},
                    **_slot_sizes(local, floor, walls, top),
                )
            )
        explained = {tag - 1 for f in features for tag in f.tags}
        return _found(
            self.name, graph, disc.frame, features, [r for r in present if r not in explained]
        )


def _feature(kind, number, rows, **sizes):
    faces = tuple(FaceRole(role=role, face=r + 1) for role, own in rows.items() for r in own)
    return Feature(
        id=f"{kind}-{number:02}",
        kind=kind,
        faces=faces,
        sizes={name: round(float(value), DECIMALS) for name, value in sizes.items()},
    )


def _bevel(local, row):
    """Return radii, heights and angle of a cone from its circles, in the disc's frame."""
    rings = [e for e in local.edges_of[row] if np.isfinite(local.curve_radius[e])]
    inner, outer = sorted(rings, key=lambda e: local.curve_radius[e])[:: max(len(rings) - 1, 1)][:2]
    rise = abs(local.curve_centre[inner][2] - local.curve_centre[outer][2])
    run = local.curve_radius[outer] - local.curve_radius[inner]
    return {
        "height": rise,
        "outer_radius": local.curve_radius[outer],
        "foot_z": local.curve_centre[outer][2],
        "angle": np.degrees(np.arctan2(run, rise)),
    }


def _slot_sizes(local, floor, walls, top):
    rows = [floor, *walls]
    span = local.box_high[rows].max(axis=0) - local.box_low[rows].min(axis=0)
    z = local.centre[floor][2]
    return {"length": span[0], "width": span[1], "depth": top - z, "top_z": top, "floor_z": z}


def _found(name, graph, frame, features, left, *findings):
    """Return what was recognised, with a finding for each face that is left."""
    whole = float(graph.area.sum())
    return Recognition(
        family=name,
        frame=frame,
        features=tuple(features),
        unexplained=tuple(r + 1 for r in left),
        unexplained_share=float(graph.area[left].sum()) / whole if whole else 0.0,
        findings=(
            *findings,
            *(
                error(
                    "disc.unexplained",
                    "no face of a disc",
                    f"face {r + 1}",
                    remedy="machine it by hand",
                )
                for r in left
            ),
        ),
    )
