"""The faces that no feature explains, each named in a finding by what it looks like: the seam for features that come later."""

from __future__ import annotations

from collections.abc import Collection, Sequence

from trunnion.findings import Finding, face_tags, warning
from trunnion.geometry.facegraph import CONVEX, FaceGraph
from trunnion.recognize.panel.classes import FaceClass, FaceClasses

WORDS = {
    "panel.chamfer": (
        "slopes wider than a chamfer are not handled yet",
        "cut them by hand-made operations",
    ),
    "panel.leaning-wall": (
        "leaning faces outside of pockets are not handled yet",
        "machine them with another strategy",
    ),
    "panel.underside": (
        "faces that look down are not reached from above",
        "add a setup for the other side",
    ),
    "panel.lower-top": (
        "tops below the part's top that are too wide for a rib are not handled yet",
        "face them by hand-made operations",
    ),
    "panel.undercut": (
        "recesses under material are not handled yet",
        "cut them with a T-slot cutter, or from another side",
    ),
    "panel.unexplained": (
        "no feature explains these faces",
        "look at the part there and name the feature by hand",
    ),
}


def rest_findings(
    graph: FaceGraph, classes: FaceClasses, rows: Sequence[int], undercut: Collection[int]
) -> tuple[Finding, ...]:
    """Return one finding for each sort of unexplained face, with the share of the area; `undercut` rows have material over them."""
    sorts: dict[str, list[int]] = {}
    for row in rows:
        sorts.setdefault(
            "panel.undercut" if row in undercut else _sort(graph, classes, row), []
        ).append(row)
    total = float(graph.area.sum())
    return tuple(
        warning(
            code,
            f"{WORDS[code][0]}: {len(found)} {'face' if len(found) == 1 else 'faces'}, "
            f"{float(graph.area[found].sum()) / total:.1%} of the area",
            *face_tags(r + 1 for r in found),
            remedy=WORDS[code][1],
        )
        for code, found in sorted(sorts.items())
    )


def _sort(graph: FaceGraph, classes: FaceClasses, row: int) -> str:
    kind = classes.kind[row]
    if kind in (FaceClass.DOWN, FaceClass.OVERHANG):
        return "panel.underside"
    if kind is FaceClass.UP:
        return "panel.lower-top"
    if kind is FaceClass.CROSS and all(
        graph.convexity[e] == CONVEX or graph.convexity[e] == 0 for e in graph.edges_of[row]
    ):
        return "panel.chamfer"
    if kind in (FaceClass.INNER, FaceClass.OUTER, FaceClass.STEEP):
        return "panel.leaning-wall"
    return "panel.unexplained"
