"""Complex curved surfaces: quick segmentation of trimmed patches by feature size, and the local features among them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from trunnion.findings import BadInput, Finding, face_tags, info
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.facegraph import FaceGraph
from trunnion.model.feature import FaceRole, Feature, Recognition
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.recognize.contract import Bounded, Suitability
from trunnion.recognize.surface.frame import frame_of
from trunnion.recognize.surface.groups import aligned_groups, invariant_groups
from trunnion.recognize.surface.kinds import GROUP, KINDS, LOCAL
from trunnion.recognize.surface.local import LocalProposal, proposed
from trunnion.recognize.surface.radii import PatchRadii, patch_bends
from trunnion.recognize.surface.settings import ALIGNED, EXACT, SurfaceSettings
from trunnion.recognize.surface.size import PatchSizes, patch_sizes
from trunnion.recognize.surface.suitability import suitability


class SurfaceFamily:
    """Blades, small impellers and other parts of free-form patches with local features on them."""

    name = "surface"
    noun = "a part of curved surfaces"
    kinds = KINDS
    settings = SurfaceSettings
    exclusive: tuple[str, ...] = (GROUP,)

    def suits(self, graph: FaceGraph) -> Suitability:
        """Return how near the curved share of the part's area comes to that of parts that are surely of this family."""
        return suitability(graph)

    def recognize(
        self,
        graph: FaceGraph,
        bounded: Bounded,
        settings: SurfaceSettings,
        progress: Progress = NO_PROGRESS,
    ) -> Recognition:
        """Return one feature a group of equal patches, largest first; local ones are marked.

        Raises `BadInput` for a part without faces, `Cancelled` when asked to stop.
        """
        progress.at(0.0, "measuring patches")
        if not len(graph):
            raise BadInput(
                "the part has no face: export its solid or its surfaces from the CAD system"
            )
        sizes = _sizes(graph, bounded, settings)
        progress.at(0.5, "grouping patches")
        size = _size(sizes, settings)
        sliver_width, smallest = settings.limits(float(size.max()))
        sliver = sizes.width < sliver_width
        small = ~sliver & (size < smallest)
        rows = np.flatnonzero(~sliver & ~small)
        if not len(rows):
            raise BadInput(
                f"no patch is left to be grouped: all are narrower than {sliver_width:g} mm (recognize.surface.sliver_width) or below "
                f"{smallest:g} mm (recognize.surface.smallest); the largest is {size.max():.3g} mm across"
            )
        if settings.grouping == ALIGNED:
            groups = aligned_groups(
                sizes,
                rows,
                settings.tolerance,
                relative=settings.relative,
                subdivide=settings.subdivide,
            )
        else:
            groups = invariant_groups(sizes, rows, settings.tolerance, relative=settings.relative)
        bends = patch_bends(bounded, graph, sizes)
        proposal = _proposal(graph, sizes, bends, settings)
        features = tuple(
            _feature(f"group-{k:02}", g, sizes, bends, settings, proposal)
            for k, g in enumerate(_divided(groups, sizes, proposal), 1)
        )
        apart = sliver | small
        narrow = _findings(
            "surface.sliver",
            sizes,
            size,
            sliver,
            "sliver_width",
            f"narrower than {sliver_width:.3g} mm on average",
        )
        tiny = _findings(
            "surface.small",
            sizes,
            size,
            small,
            "smallest",
            f"below the smallest feature size of {smallest:.3g} mm",
        )
        return Recognition(
            family=self.name,
            frame=frame_of(graph),
            features=features,
            unexplained=tuple(int(t) for t in sizes.tag[apart]),
            unexplained_share=float(sizes.area[apart].sum() / sizes.area.sum()),
            findings=(*narrow, *tiny, *(proposal.findings() if proposal else ())),
        )

    def measured(
        self, found: Recognition, graph: FaceGraph, part: Bounded, settings: SurfaceSettings
    ) -> Recognition:
        """Return the groups with sizes that fit their faces; whether those made or changed by hand are local stays as a person said."""
        sizes = _sizes(graph, part, settings)
        bends = patch_bends(part, graph, sizes)
        proposal = _proposal(graph, sizes, bends, settings)
        rows = {f.id: np.flatnonzero(np.isin(sizes.tag, f.tags)) for f in found.of_kind(GROUP)}
        anew = {
            id: _feature(id, mine, sizes, bends, settings, proposal) for id, mine in rows.items()
        }
        features = tuple(
            f
            if f.kind != "group"
            else replace(f, sizes=anew[f.id].sizes)
            if f.by_hand
            else anew[f.id]
            for f in found.features
        )
        return replace(found, features=features)


def _sizes(graph: FaceGraph, bounded: Bounded, settings: SurfaceSettings) -> PatchSizes:
    present = np.flatnonzero(graph.area > 0.0)
    return patch_sizes(
        bounded,
        [int(r) + 1 for r in present],
        graph.area[present],
        exact=settings.boundary == EXACT,
    )


def _size(sizes: PatchSizes, settings: SurfaceSettings) -> Floats:
    return sizes.diagonal if settings.grouping == ALIGNED else sizes.diameter


def _proposal(
    graph: FaceGraph, sizes: PatchSizes, bends: PatchRadii, settings: SurfaceSettings
) -> LocalProposal | None:
    """Return what is proposed as local, None where a person set the threshold."""
    return None if settings.local_ratio > 0.0 else proposed(graph, sizes, bends.hollow)


def _divided(groups: list[Ints], sizes: PatchSizes, proposal: LocalProposal | None) -> list[Ints]:
    """Return the groups, those with equal patches on local features and elsewhere in two."""
    if proposal is None:
        return groups
    local = proposal.local[sizes.tag - 1]
    return [part for g in groups for part in (g[~local[g]], g[local[g]]) if len(part)]


def _feature(
    id: str,
    rows: Ints,
    sizes: PatchSizes,
    bends: PatchRadii,
    settings: SurfaceSettings,
    proposal: LocalProposal | None,
) -> Feature:
    size = _size(sizes, settings)
    ratio = float(size[rows].max() / size.max())
    local = (
        ratio < settings.local_ratio
        if proposal is None
        else bool(proposal.local[sizes.tag[rows] - 1].all())
    )
    return Feature(
        id=id,
        kind="group",
        faces=tuple(FaceRole(role="face", face=int(t)) for t in np.sort(sizes.tag[rows])),
        sizes={
            "feature_size": float(size[rows].mean()),
            "feature_size_min": float(size[rows].min()),
            "feature_size_max": float(size[rows].max()),
            "size_ratio": ratio,
            "diagonal": float(sizes.diagonal[rows].mean()),
            "diameter": float(sizes.diameter[rows].mean()),
            "boundary_length": float(sizes.length[rows].mean()),
            "area": float(sizes.area[rows].sum()),
            **bends.sizes(rows),
        },
        attributes={LOCAL: local},
    )


def _findings(
    code: str, sizes: PatchSizes, size: Floats, rows: Bools, limit: str, words: str
) -> tuple[Finding, ...]:
    """Return what patches join no group, and why: how many, how large across, and how much area; nothing when there are none."""
    if not rows.any():
        return ()
    tags, area = [int(t) for t in sizes.tag[rows]], float(sizes.area[rows].sum())
    are, join = ("patch is", "joins") if len(tags) == 1 else ("patches are", "join")
    return (
        info(
            code,
            f"{len(tags)} {are} {words} and {join} no group: {size[rows].min():.3g} to {size[rows].max():.3g} mm across, "
            f"{area:.3g} mm2, {area / float(sizes.area.sum()):.2%} of the area",
            *face_tags(tags),
            remedy=f"nothing needs to be done: they are machined with the area around them and exported by the word dropped alone; "
            f"lower recognize.surface.{limit} to group them",
        ),
    )
