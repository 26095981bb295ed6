"""The faces of a casing that no feature explains, each named in a finding by what it looks like."""

from __future__ import annotations

from collections.abc import Sequence

from trunnion.findings import Finding, face_tags, warning
from trunnion.geometry.facegraph import CONVEX, SMOOTH
from trunnion.recognize.casing.faces import CasingFaces

WORDS = {
    "casing.opening": (
        "openings and notches that are no round holes are not handled yet",
        "cut them by hand-made operations, or name them by hand",
    ),
    "casing.free-form": (
        "faces that are neither turned nor those of bosses and holes are not handled yet",
        "look at the part there: a strut or a vane is machined with the strategies of curved surfaces",
    ),
    "casing.unexplained": (
        "no feature explains these faces",
        "look at the part there and name the feature by hand",
    ),
}
PLAIN = ("plane", "cylinder", "cone")


def rest_findings(faces: CasingFaces, rows: Sequence[int]) -> tuple[Finding, ...]:
    """Return one finding for each sort of unexplained face, with the share of the area."""
    sorts: dict[str, list[int]] = {}
    for row in rows:
        sorts.setdefault(_sort(faces, row), []).append(row)
    total = float(faces.graph.area.sum())
    return tuple(
        warning(
            code,
            f"{WORDS[code][0]}: {len(found)} {'face' if len(found) == 1 else 'faces'}, "
            f"{float(faces.graph.area[found].sum()) / total:.1%} of the area",
            *face_tags(r + 1 for r in found),
            remedy=WORDS[code][1],
        )
        for code, found in sorted(sorts.items())
    )


def _sort(faces: CasingFaces, row: int) -> str:
    graph = faces.graph
    if graph.surface[row] not in PLAIN:
        return "casing.free-form"
    rim = [
        graph.convexity[e] for e in graph.edges_of[row] if faces.runs_round(graph.across(e, row))
    ]
    if rim and all(c in (CONVEX, SMOOTH) for c in rim):
        return "casing.opening"
    return "casing.unexplained"
