"""Machining regions of a bottom: bands of one kind along the axis, and gap by gap; and whether they cover the bottom exactly once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from trunnion.plan.casing.regions.bands import FULL, INTERRUPTED, MILL, TURN, BottomBand
from trunnion.recognize.casing.meridian import Meridian
from trunnion.units import degrees

SAME_ANGLE = 1e-6
"""Radians: bounds of two gaps that differ by less are one, half a micrometre on the largest casings."""
COVERED = 1e-3
"""Share of a bottom's area that its regions may leave or take twice."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BandRun:
    """Neighbouring bands that are machined alike: heights (mm), kind, and the bosses in them."""

    z: tuple[float, float]
    kind: str
    bosses: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class MachiningRegion:
    """What one operation cuts of a bottom: heights (mm), angles (radians), kind, and the bosses on both sides; all round without a boss.

    `lower_speed` is the speed (m/min) at which a milled gap could be turned, None where there is none; `costs` is how much longer turning
    takes then.
    """

    z: tuple[float, float]
    kind: str
    theta: tuple[float, float]
    after: str = ""
    before: str = ""
    area: float = 0.0
    lower_speed: float | None = None
    costs: float = 0.0

    def as_dict(self) -> dict[str, object]:
        """Return it as the JSON that other programs rely on."""
        found: dict[str, object] = {
            "z": rounded_pair(self.z),
            "kind": self.kind,
            "theta": [round(degrees(t), 6) for t in self.theta],
            "area": round(self.area, 3),
        }
        if self.after:
            found |= {"after": self.after, "before": self.before}
        if self.lower_speed is not None:
            found |= {"lower_speed": round(self.lower_speed, 1), "costs": round(self.costs, 3)}
        return found


def rounded_pair(values: tuple[float, float]) -> list[float]:
    """Return two lengths for JSON."""
    return [round(v, 6) + 0.0 for v in values]


def merged(
    bands: Sequence[BottomBand], alike: Callable[[BottomBand, BottomBand], bool]
) -> tuple[BandRun, ...]:
    """Return bands with neighbours joined that are alike."""
    found: list[BandRun] = []
    before: BottomBand | None = None
    for band in bands:
        if before is not None and alike(before, band):
            found[-1] = BandRun(
                z=(found[-1].z[0], band.z[1]),
                kind=found[-1].kind,
                bosses=tuple(sorted({*found[-1].bosses, *band.bosses})),
            )
        else:
            found.append(BandRun(z=band.z, kind=band.kind, bosses=band.bosses))
        before = band
    return tuple(found)


def same_bosses(a: BottomBand, b: BottomBand) -> bool:
    """Return whether two bands are of one kind with the same bosses."""
    return (a.kind, a.bosses) == (b.kind, b.bosses)


def same_kind(a: BottomBand, b: BottomBand) -> bool:
    """Return whether two bands are of one kind."""
    return a.kind == b.kind


def without_slivers(bands: Sequence[BottomBand], narrowest: float) -> tuple[BottomBand, ...]:
    """Return bands without free ones narrower than the insert: they go to the band beside that is turned with interruptions, else to the
    one above, or at the end below, whose bosses and gaps they take."""
    found = list(bands)
    for n, band in enumerate(found):
        if band.kind != TURN or band.z[1] - band.z[0] >= narrowest:
            continue
        beside = [k for k in (n + 1, n - 1) if 0 <= k < len(found) and found[k].kind != TURN]
        if not beside:
            continue
        host = min(beside, key=lambda k: found[k].kind != INTERRUPTED)
        found[n] = replace(band, bosses=found[host].bosses, gaps=found[host].gaps)
    return tuple(found)


def regions_of(bands: Sequence[BottomBand], meridian: Meridian) -> tuple[MachiningRegion, ...]:
    """Return the regions of bands: free bands all round; else one for each longest run of bands over which a gap keeps its neighbours.

    A long gap in a band that is milled as a whole may be turned by itself.
    """
    found: list[MachiningRegion] = []
    open_now: dict[tuple[str, str, int], MachiningRegion] = {}
    for band in bands:
        now: dict[tuple[str, str, int], MachiningRegion] = {}
        for key, begun in _of_band(band):
            before = open_now.pop(key, None)
            if before is not None and before.kind == begun.kind:
                now[key] = replace(before, z=(before.z[0], begun.z[1]))
            else:
                if before is not None:
                    found.append(before)
                now[key] = begun
        found += open_now.values()
        open_now = now
    found += open_now.values()
    return tuple(
        replace(r, area=meridian.area(*r.z, r.theta[1] - r.theta[0]))
        for r in sorted(found, key=lambda r: (r.z, r.theta))
    )


def _of_band(band: BottomBand) -> list[tuple[tuple[str, str, int], MachiningRegion]]:
    if not band.bosses:
        return [(("", "", 0), MachiningRegion(z=band.z, kind=TURN, theta=(0.0, FULL)))]
    return [
        (
            (g.after, g.before, round(g.theta[0] / SAME_ANGLE)),
            MachiningRegion(
                z=band.z,
                kind=INTERRUPTED if g.long_enough else MILL,
                theta=g.theta,
                after=g.after,
                before=g.before,
            ),
        )
        for g in band.gaps
    ]


def around_bosses(bands: Sequence[BottomBand], meridian: Meridian) -> float:
    """Return the area (mm2) between the gaps: what bosses, widened, take of the bottom and is milled around them."""
    return sum(
        meridian.area(*b.z, FULL - sum(g.theta[1] - g.theta[0] for g in b.gaps))
        for b in bands
        if b.bosses
    )


def uncovered(regions: Sequence[MachiningRegion], taken: float, meridian: Meridian) -> float:
    """Return the share of a bottom's area by which its regions, with what bosses take (mm2), differ from it."""
    whole = meridian.area(*meridian.ends, FULL)
    return abs(sum(r.area for r in regions) + taken - whole) / whole
