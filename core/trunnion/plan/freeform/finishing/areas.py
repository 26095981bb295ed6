"""The areas that are finished with one cutter each: every local feature by itself, and what remains."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.facegraph import CONVEX, FaceGraph
from trunnion.model.blank import Blank
from trunnion.model.feature import Feature, Recognition
from trunnion.part.part import Part
from trunnion.plan.freeform.reach import AreaSamples, free_before, samples_on
from trunnion.plan.freeform.space import SurfaceSpace
from trunnion.plan.freeform.wall_curves import VERTICAL, is_upright
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.recognize.contract import exclusive_kinds

TIGHT = 8.0
"""mm: a hollow with a smaller radius bears only cutters smaller than those for what lies around it."""
LOCAL, REMAINING = "local", "remaining"
END_MILL = 3.0
"""mm: radius of a cutter that must have space down to the foot of an upright wall for it to stand free."""
FEW = 200
"""Positions on an upright face that say whether it stands free all over."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Area:
    """Faces that are finished together: its name in operations, its tags, whether it is a local feature, and whether it is hidden from an
    upright tool."""

    id: str
    tags: tuple[int, ...]
    local: bool
    hidden: bool = False


def areas_of(
    recognition: Recognition, graph: FaceGraph, omitted: Collection[int] = ()
) -> tuple[Area, ...]:
    """Return each connected set of local faces as an area of its own, by its largest face's tag, and the remaining faces as one."""
    groups = recognition.of_kind(*exclusive_kinds(recognition.family))
    local = {tag for f in groups if f.attributes.get("local") for tag in f.tags} - set(omitted)
    remaining = sorted({tag for f in groups for tag in f.tags} - local - set(omitted))
    sets = connected(local, graph)
    found = [Area(id=f"{LOCAL}-{n:02}", tags=tags, local=True) for n, tags in enumerate(sets, 1)]
    return (
        *([Area(id=REMAINING, tags=tuple(remaining), local=False)] if remaining else []),
        *found,
    )


def hidden_areas(
    recognition: Recognition, graph: FaceGraph, tags: Collection[int]
) -> tuple[Area, ...]:
    """Return hidden faces as areas: planes by themselves, hollows that are too tight for large cutters where they hang together (the
    fillets round a blade), and the other curved faces where they do. Hollows count as local."""
    tight = _tight(recognition) & set(tags)
    flat = [tag for tag in sorted(tags) if graph.surface[tag - 1] == "plane"]
    found = [Area(id=f"face-{tag}", tags=(tag,), local=False, hidden=True) for tag in flat]
    for word, faces in (("hidden", set(tags) - tight - set(flat)), ("hollow", tight - set(flat))):
        found += [
            Area(id=f"{word}-{n:02}", tags=each, local=word == "hollow", hidden=True)
            for n, each in enumerate(connected(faces, graph), 1)
        ]
    return tuple(found)


def with_joined_hollows(
    recognition: Recognition,
    graph: FaceGraph,
    hidden: Collection[int],
    among: Collection[int],
) -> tuple[int, ...]:
    """Return hidden faces with those `among` others that are tight hollows and hang together with hidden ones: the fillets round a blade
    are one area, though an upright cutter comes to some of them."""
    found = set(hidden)
    for tags in connected(_tight(recognition) & (set(among) | found), graph):
        if found & set(tags):
            found |= set(tags)
    return tuple(sorted(found))


def _tight(recognition: Recognition) -> set[int]:
    """Return the faces that are hollows too tight for large cutters."""
    return {tag for f in recognition if 0.0 < _radius(f) < TIGHT for tag in f.tags}


def _radius(feature: Feature) -> float:
    """Return the smallest concave radius of a feature's faces; 0 where none is known."""
    value = feature.sizes.get("concave_radius", 0.0)
    return float(value) if isinstance(value, (int, float)) else 0.0


def connected(tags: Collection[int], graph: FaceGraph) -> list[tuple[int, ...]]:
    """Return faces in sets that hang together by edges, each in ascending order, the sets by their first tag."""
    remaining, found = set(tags), []
    while remaining:
        mine, border = set(), [min(remaining)]
        while border:
            tag = border.pop()
            if tag in remaining:
                remaining.discard(tag)
                mine.add(tag)
                border += [graph.across(e, tag - 1) + 1 for e in graph.edges_of[tag - 1]]
        found.append(tuple(sorted(mine)))
    return found


def blank_faces(part: Part, blank: Blank) -> tuple[int, ...]:
    """Return the faces that lie in a side of the blank: nothing of it is there to be cut."""
    graph = part.graph()
    flat = np.array([kind == "plane" for kind in graph.surface])
    ends = [graph.edge_face[:, k] for k in (0, 1)]
    face = np.concatenate([graph.sample_face, *(e for e in ends for _ in range(3))])
    along = [graph.start, graph.middle, graph.end]
    near = blank.sides(
        blank.frame.to_local(np.vstack([graph.sample_point, *along, *along])), tolerance.SLIVER
    )
    misses = np.zeros((len(flat), near.shape[1]))
    np.add.at(misses, face, ~near)
    lies = flat & np.isin(np.arange(len(flat)), face) & (misses == 0).any(axis=1)
    return tuple(tag for tag in part.tags if lies[tag - 1])


def walls_of(samples: AreaSamples, tags: Collection[int]) -> tuple[int, ...]:
    """Return the faces that stand upright all over."""
    return tuple(
        sorted(
            t
            for t in tags
            if (own := samples.face == t).any()
            and bool((np.abs(samples.normal[own, 2]) < VERTICAL).all())
        )
    )


def on_outline(
    space: SurfaceSpace,
    tags: Collection[int],
    progress: Progress = NO_PROGRESS,
) -> tuple[int, ...]:
    """Return the upright faces that nothing of the part is in front of at their height: an end mill beside them is out in the free.

    A face that runs into another one at its foot, or meets one that comes out of it, doesn't stand free. One that leans or twists has
    another plan at each height, and none that the side of an end mill could go along.
    """
    found, graph = [], space.part.graph()
    for tag in progress.each(sorted(tags)):
        edges = [e for e in graph.edges_of[tag - 1] if graph.across(e, tag - 1) + 1 not in tags]
        if any(graph.convexity[e] != CONVEX for e in edges) or not is_upright(space.skin, tag):
            continue
        own, skin = samples_on(space.skin, (tag,), FEW), space.skin
        bottom = float(skin.points[skin.triangles[skin.of((tag,))], 2].min())
        if free_before(space, own, END_MILL, bottom, progress.part(0.0, 0.0)).all():
            found.append(tag)
    return tuple(found)
