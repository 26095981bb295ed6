"""Patches that are too small to be planned by themselves: they are cut with the area around them."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from trunnion import tolerance
from trunnion.findings import Finding, face_tags, info
from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.feature import Recognition
from trunnion.model.operation import Operation

WHOLE = ("semi", "finish", "rest_finish")
"""Kinds of operations whose cutter follows its faces whatever their shape."""


def slivers_of(recognition: Recognition) -> frozenset[int]:
    """Return the tags of the faces that recognition left out of every feature by itself; what a person deleted is not to be cut."""
    return frozenset(recognition.dropped)


def sliver_findings(before: Sequence[Operation], after: Sequence[Operation]) -> tuple[Finding, ...]:
    """Return what is told of the patches that operations have gained: which operations cut each, and that none was chosen for it."""
    cut: dict[int, list[str]] = {}
    for old, new in zip(before, after, strict=True):
        for tag in new.faces[len(old.faces) :]:
            cut.setdefault(tag, []).append(new.id)
    if not cut:
        return ()
    patches = "1 patch" if len(cut) == 1 else f"{len(cut)} patches"
    return (
        info(
            "route.dropped",
            f"{patches} in no group: cut with the neighbour across the longest edge, by cutters that others chose: {_by_operation(cut)}",
            *face_tags(cut),
            remedy="lower recognize.surface.smallest and recognize.surface.sliver_width to plan them by themselves",
        ),
    )


def _by_operation(cut: Mapping[int, Sequence[str]]) -> str:
    """Return in words which faces the same operations cut, by the ids of each face's operations."""
    together: dict[str, list[str]] = {}
    for tag, ids in sorted(cut.items()):
        together.setdefault(", ".join(ids), []).append(f"face {tag}")
    return "; ".join(f"{', '.join(faces)} by {ids}" for ids, faces in together.items())


def with_slivers(
    operations: Sequence[Operation], slivers: Collection[int], graph: FaceGraph, skin: Skin
) -> tuple[list[Operation], tuple[int, ...]]:
    """Return the operations with each sliver among the faces of those that cut its neighbour across the longest common edge, and the tags
    that no operation cuts a neighbour of.

    Slivers beside slivers follow one after the other. Neighbours that a cutter follows in any shape come first; an operation on levels
    and walls takes a sliver only from within its faces' heights.
    """
    made, remaining = list(operations), sorted(slivers)
    grown = True
    while remaining and grown:
        grown = False
        for tag in list(remaining):
            hosts = _hosts(made, tag, graph, skin)
            for n in hosts:
                made[n] = replace(made[n], faces=(*made[n].faces, tag))
            if hosts:
                remaining.remove(tag)
                grown = True
    return made, tuple(remaining)


def _hosts(operations: Sequence[Operation], tag: int, graph: FaceGraph, skin: Skin) -> list[int]:
    """Return which operations cut the neighbour of a face that it goes with, none when no neighbour is cut."""
    neighbours = sorted(
        graph.neighbours(tag - 1), key=lambda row: (-_common(graph, tag - 1, row), row)
    )
    for whole in (True, False):
        for row in neighbours:
            found = [
                n
                for n, o in enumerate(operations)
                if row + 1 in o.faces
                and (o.kind in WHOLE) == whole
                and (whole or _within(skin, tag, o.faces))
            ]
            if found:
                return found
    return []


def _common(graph: FaceGraph, a: int, b: int) -> float:
    """Return the length of the edges that two face rows share, mm."""
    return sum(float(graph.length[e]) for e in graph.edges_of[a] if graph.across(e, a) == b)


def _within(skin: Skin, tag: int, faces: Collection[int]) -> bool:
    """Return whether a face lies within the heights of others."""
    mine, theirs = (
        skin.points[skin.triangles[skin.of(tags)], 2] for tags in ((tag,), tuple(faces))
    )
    return bool(
        mine.size
        and theirs.size
        and mine.min() > theirs.min() - tolerance.SLIVER
        and mine.max() < theirs.max() + tolerance.SLIVER
    )
