"""What the route leaves and why: features that no operation is planned for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from trunnion.findings import Finding, error, face_tags, warning
from trunnion.model.feature import Feature, Recognition
from trunnion.plan.panel.tasks import OperationTask
from trunnion.plan.prismatic.lean import ALLOWED_LEAN, POCKETS, steepest_lean
from trunnion.plan.prismatic.regions import SectionSource, parent_of
from trunnion.plan.tool_choice import Candidates
from trunnion.shop import Stage
from trunnion.units import trimmed


def plannable(
    recognition: Recognition, stages: Sequence[Stage], *, freeform: bool = False
) -> tuple[list[Feature], dict[str, str]]:
    """Return the features that stages may plan, and for each other one (datum faces apart) why it is left; `freeform` says whether pockets
    may have leaning walls and curved floors."""
    known = {kind for stage in stages for kind in stage.on}
    planned, refusals = [], {}
    for feature in recognition:
        if feature.kind == "datum":
            continue
        reason = _refusal(feature, known, freeform=freeform)
        if reason:
            refusals[feature.id] = reason
        else:
            planned.append(feature)
    lost = [f for f in planned if (p := parent_of(f, recognition)) is not None and p.id in refusals]
    refusals |= {
        f.id: f"it stands in {parent.id}, which is not planned"
        for f in lost
        if (parent := parent_of(f, recognition))
    }
    return [f for f in planned if f.id not in refusals], refusals


def _refusal(feature: Feature, known: set[str], *, freeform: bool) -> str:
    refused = feature.attributes.get("refused", feature.sizes.get("refused"))
    if refused:
        return refused if isinstance(refused, str) else "it was refused"
    if feature.kind not in known:
        return f"the typical plan has no operation for a {feature.kind.replace('_', ' ')}"
    if freeform and feature.kind in (*POCKETS, "island"):
        return ""
    if feature.kind in POCKETS and (
        feature.sizes.get("curved_floor") or "floor_z_max" in feature.sizes
    ):
        return "a curved floor, which a plane operation would gouge or leave"
    steepest = steepest_lean(feature)
    if steepest > ALLOWED_LEAN:
        return f"walls that lean by {trimmed(steepest, 2)} degrees, which a vertical cutter would gouge or leave"
    return ""


def without_lonely_ribs(
    planned: list[Feature],
    refusals: dict[str, str],
    recognition: Recognition,
    adjacent: Mapping[str, frozenset[str]],
) -> tuple[list[Feature], dict[str, str]]:
    """Return the same without ribs beside a space that is not planned: their cutter would run in solid material."""
    kinds = {f.id: f.kind for f in recognition}
    for feature in planned:
        remaining = sorted(
            i for i in adjacent.get(feature.id, ()) if i in refusals and kinds[i] in POCKETS
        )
        if feature.kind == "rib" and remaining:
            refusals = {
                **refusals,
                feature.id: f"it stands beside {remaining[0]}, which is not planned",
            }
    return [f for f in planned if f.id not in refusals], refusals


def not_planned(refusals: Mapping[str, str], recognition: Recognition) -> list[Finding]:
    """Return one finding for each reason, naming features and faces."""
    reasons: dict[str, list[Feature]] = {}
    for id, reason in refusals.items():
        reasons.setdefault(reason, []).append(recognition.feature(id))
    found = []
    for reason, features in reasons.items():
        names = ", ".join(f.id for f in features)
        faces = face_tags(t for f in features for t in f.tags)
        found.append(
            warning(
                "route.not-planned",
                f"{names} not planned: {reason}",
                *(f.id for f in features),
                *faces,
                remedy="machine by hand or by another operation; the proof counts what is left",
            )
        )
    return found


def adjacent(recognition: Recognition, part: SectionSource) -> dict[str, frozenset[str]]:
    """Return for each feature those whose faces share an edge with its own, and those it is in or holds."""
    graph = part.graph()
    owners: dict[int, set[str]] = {}
    for feature in recognition:
        for tag in feature.tags:
            owners.setdefault(tag, set()).add(feature.id)
    found: dict[str, set[str]] = {f.id: set() for f in recognition if f.kind != "datum"}
    pairs = [
        (a, b)
        for r, s in graph.edge_face
        for a in owners.get(int(r) + 1, ())
        for b in owners.get(int(s) + 1, ())
    ]
    pairs += [(f.id, p.id) for f in recognition if (p := parent_of(f, recognition)) is not None]
    for a, b in pairs:
        if a != b and a in found and b in found:
            found[a].add(b)
            found[b].add(a)
    return {id: frozenset(near) for id, near in found.items()}


def no_cutter(task: OperationTask, found: Candidates) -> Finding:
    """Return the finding that no cutter of the catalogue fits an operation: an error where a whole feature stays, else a warning on what
    the proof will measure as left."""
    make_finding = warning if task.stage.cutter in ("corner", "foot") else error
    return make_finding(
        "route.no-cutter",
        f"{task.feature}: {found.reason} ({task.stage.name})",
        task.feature,
        *face_tags(task.faces),
        remedy=found.remedy,
    )
