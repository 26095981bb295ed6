"""Which patches are proposed as local features: those of clusters below the natural break in the sizes of all clusters of a part."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from trunnion.findings import Finding, face_tags, info
from trunnion.geometry.arrays import Bools, Floats, Ints
from trunnion.geometry.facegraph import FaceGraph
from trunnion.recognize.surface.clusters import FaceClusters, clusters_of, components
from trunnion.recognize.surface.size import PatchSizes
from trunnion.tolerance import COINCIDENT
from trunnion.units import percent

JUMP = 1.25
"""Size over the next smaller one from which on there is a gap between them: sizes within a quarter are of one scale."""
MINORITY = 1.0 / 3.0
"""Share of the part's area that local features don't exceed: with more they would be what the part is, such as all blades of a fan. On the
paper's impeller the splitters have 24 %, all blades 71 %."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LocalProposal:
    """What is proposed as local: the rows (n,) of its faces, in how many connected clusters they are, their share of the part's area, and
    the sizes above and below the gap, mm. Where nothing is, these are the largest and the smallest size."""

    local: Bools
    clusters: int
    share: float
    above: float
    below: float

    def findings(self) -> tuple[Finding, ...]:
        """Return in words what is proposed and why; nothing where all faces are one cluster."""
        if self.above == self.below:
            return ()
        return (self._finding(),)

    def _finding(self) -> Finding:
        remedy = "mark or clear groups by hand, or set recognize.surface.local_ratio"
        if not self.local.any():
            return info(
                "surface.local",
                f"no local feature is proposed: connected faces measure {self.below:.1f} to {self.above:.1f} mm, and what is smaller by "
                f"a gap is more than {percent(MINORITY)} of the area or holds the rest together",
                remedy=remedy,
            )
        tags = (np.flatnonzero(self.local) + 1).tolist()
        return info(
            "surface.local",
            f"sizes of connected faces jump from {self.below:.1f} to {self.above:.1f} mm: everything below is proposed as local, "
            f"{_count(len(tags), 'face')} in {_count(self.clusters, 'cluster')}, {percent(self.share)} of the area",
            *face_tags(tags),
            remedy=remedy,
        )


def _count(number: int, word: str) -> str:
    return f"{number} {word}{'s' * (number != 1)}"


def proposed(graph: FaceGraph, sizes: PatchSizes, hollow: Floats) -> LocalProposal:
    """Return what is proposed as local, from the sizes of patches and their middle hollow curvature (k,), 1/mm.

    Fillets are judged with what they are the feet of, such as a boss; only where nothing is smaller than the rest, by themselves: the
    fillets at both ends of a turbine blade get a cutter of their own.
    """
    found = clusters_of(graph, sizes, hollow)
    feet = _parted(graph, found, found.together)
    return (
        feet if feet.local.any() else _parted(graph, found, np.minimum(found.size, found.together))
    )


def _parted(graph: FaceGraph, found: FaceClusters, by: Floats) -> LocalProposal:
    """Return what is proposed by one size of every cluster (c,), mm."""
    real = np.flatnonzero(found.area > 0.0)
    order = real[np.argsort(-by[real], kind="stable")]
    size, area = by[order], found.area[order]
    kept = natural_break(size, area)
    small = np.isin(found.cluster, order[kept:]) & (graph.area > 0.0)
    piece = _pieces(graph, small)
    local = small & ~np.isin(piece, _bridges(graph, small, piece, found.fillet))
    return LocalProposal(
        local=local,
        clusters=len(np.unique(piece[local])),
        share=float(graph.area[local].sum() / graph.area.sum()),
        above=float(size[kept - 1] if kept < len(size) else size[0]),
        below=float(size[kept] if kept < len(size) else size[-1]),
    )


def _pieces(graph: FaceGraph, small: Bools) -> Ints:
    """Return the number (n,) of the piece that each face is in: connected faces that are all small, or none of them."""
    a, b = graph.edge_face[small[graph.edge_face[:, 0]] == small[graph.edge_face[:, 1]]].T
    return components(len(graph), a, b)


def _bridges(graph: FaceGraph, small: Bools, piece: Ints, fillet: Bools) -> Ints:
    """Return the numbers of small pieces that hold larger ones together: a post between two plates, a hub between blades. Fillets join what
    meets without them."""
    a, b = np.concatenate([graph.edge_face, graph.edge_face[:, ::-1]]).T
    met = small[a] & ~small[b]
    pairs = np.unique(np.column_stack([piece[a[met]], piece[b[met]]]), axis=0)
    held, count = np.unique(pairs[:, 0], return_counts=True)
    return held[(count > 1) & np.isin(held, piece[small & ~fillet])]


def natural_break(size: Floats, area: Floats) -> int:
    """Return how many of some sizes (k,), largest first, lie above their natural break, all of them where there is none.

    The break parts the logarithms of the sizes, weighted by area, into two classes whose means differ most (natural breaks with two
    classes, Jenks 1967), among the gaps of `JUMP` at least with at most `MINORITY` of the area below.
    """
    value, whole = np.log(np.maximum(size, COINCIDENT)), float(area.sum())
    above = np.cumsum(area)[:-1] / whole
    mean = np.cumsum(area * value)[:-1] / whole
    apart = (mean - above * float((area * value).sum()) / whole) ** 2 / (above * (1.0 - above))
    gap = (value[:-1] - value[1:] >= np.log(JUMP)) & (1.0 - above <= MINORITY)
    return int(np.argmax(np.where(gap, apart, -1.0))) + 1 if gap.any() else len(size)
