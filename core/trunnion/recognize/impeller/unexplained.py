"""What impeller recognition can't explain or is not sure of, as findings."""

from __future__ import annotations

from collections.abc import Sequence

from trunnion.findings import Finding, error, face_tags, info, warning
from trunnion.geometry.facegraph import FaceGraph
from trunnion.recognize.impeller.rows import BladeRows


def no_wheel() -> Finding:
    """Return the finding that no blades stand on a hub."""
    return error(
        "impeller.no-blades",
        "no blades with two walls stand on a hub about one axis",
        remedy="choose another family (recognize.family), or check that the part is one closed solid",
    )


def covered(rows: Sequence[int], count: int) -> Finding:
    """Return the finding that passages lie between hub and cover."""
    return error(
        "impeller.covered",
        f"the wheel is closed: its {count} blades stand between the hub and a cover, and no cutter gets into the passages from outside",
        *face_tags(r + 1 for r in rows),
        remedy="plan hub and cover as two parts that are joined later, or program the turned faces alone",
    )


def rest(graph: FaceGraph, rows: Sequence[int]) -> tuple[Finding, ...]:
    """Return the finding on faces that are in no feature, none when there are none."""
    if not rows:
        return ()
    share = float(graph.area[list(rows)].sum()) / float(graph.area.sum())
    return (
        warning(
            "impeller.unexplained",
            f"neither blades nor turned faces nor holes: {len(rows)} {'face' if len(rows) == 1 else 'faces'}, {share:.1%} of the area",
            *face_tags(r + 1 for r in rows),
            remedy="they are left as the steps around them leave them; add operations on them by hand",
        ),
    )


def of_rows(rows: BladeRows, names: Sequence[str]) -> tuple[Finding, ...]:
    """Return what is doubtful about the blades of a wheel; `names` are the features of its blades in order."""
    found: list[Finding] = []
    if uneven := rows.uneven():
        found.append(
            warning(
                "impeller.uneven",
                f"the wheel is not symmetric: {len(uneven)} of {len(names)} blades differ from the others of their row or stand beside "
                "their place",
                *(names[n] for n in uneven),
                remedy="check the model; a program for one channel must not be turned to these",
            )
        )
    if rows.turns == 0.0:
        found.append(
            info(
                "impeller.straight",
                "the blades are straight, so the file does not tell which way the wheel turns; anticlockwise is taken",
                remedy="set recognize.impeller.rotation to have the pressure sides right",
            )
        )
    return tuple(found)
