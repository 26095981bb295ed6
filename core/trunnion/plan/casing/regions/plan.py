"""The machining regions of a casing: for each bottom its bands and regions, with lower speeds offered and the cover checked."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from trunnion.findings import Finding, error, info
from trunnion.geometry.facegraph import FaceGraph
from trunnion.model.feature import Recognition
from trunnion.plan.casing.bottoms import CasingBottom, casing_bottoms
from trunnion.plan.casing.regions.bands import MILL, TURN, BossBox, BottomBand, bands_of, widened
from trunnion.plan.casing.regions.gaps import shortest_gap, speed_for
from trunnion.plan.casing.regions.machining_regions import (
    COVERED,
    BandRun,
    MachiningRegion,
    around_bosses,
    merged,
    regions_of,
    rounded_pair,
    same_bosses,
    same_kind,
    uncovered,
    without_slivers,
)
from trunnion.plan.casing.regions.settings import RegionSettings
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.units import degrees


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BottomRegions:
    """The bands and regions of a bottom that runs round; `around` is the area (mm2) that bosses take of it, `off` the share of the area
    by which regions and bosses differ from the bottom. A recess is milled as a whole and has none."""

    bottom: CasingBottom
    bands: tuple[BottomBand, ...] = ()
    regions: tuple[MachiningRegion, ...] = ()
    around: float = 0.0
    off: float = 0.0

    @property
    def free(self) -> list[tuple[float, float]]:
        """Heights (mm) of the bands without a boss, neighbours joined."""
        return [r.z for r in self.by_kind if r.kind == TURN]

    @property
    def by_kind(self) -> tuple[BandRun, ...]:
        """Neighbouring bands of one kind, whatever stands in them: the operations along the axis."""
        return merged(self.bands, same_kind)

    def as_dict(self) -> dict[str, Any]:
        """Return it as the JSON that other programs rely on: mm and degrees about z from the frame's x."""
        bottom = self.bottom
        low, high = bottom.meridian.ends
        found: dict[str, Any] = {
            "id": bottom.pocket.id,
            "full_circle": bottom.full_circle,
            "z": rounded_pair((low, high)),
            "radius": rounded_pair(
                (float(bottom.meridian.low[0]), float(bottom.meridian.high[-1]))
            ),
        }
        if not bottom.full_circle:
            return {**found, "kind": MILL, "recess_of": bottom.recess_of}
        return {
            **found,
            "free_z": [rounded_pair(z) for z in self.free],
            "bands": [_band_dict(b) for b in self.bands],
            "merged": [_run_dict(r) for r in merged(self.bands, same_bosses)],
            "merged_by_kind": [_run_dict(r) for r in self.by_kind],
            "regions": [r.as_dict() for r in self.regions],
            "around_bosses": round(self.around, 3),
            "uncovered": round(self.off, 9),
        }


def casing_regions(
    found: Recognition, graph: FaceGraph, settings: RegionSettings, progress: Progress = NO_PROGRESS
) -> tuple[BottomRegions, ...]:
    """Return the regions of all bottoms of a casing; raise `BadInput` for a part that has none, `Cancelled` when asked to stop."""
    progress.at(0.0, "unrolling bottoms")
    bottoms = progress.aside(lambda _: casing_bottoms(found, graph))
    return tuple(
        _regions(bottom, settings, progress) if bottom.full_circle else BottomRegions(bottom=bottom)
        for bottom in progress.over(bottoms, "regions")
    )


def _regions(bottom: CasingBottom, settings: RegionSettings, progress: Progress) -> BottomRegions:
    height = {b.id: b.height for b in bottom.bosses}
    boxes = []
    for boss in progress.each(bottom.bosses):
        own = boss.bounds(bottom.meridian, toe=settings.fillets)
        box = BossBox(
            boss=boss.id,
            theta_low=own.theta_low,
            theta_high=own.theta_high,
            z_low=own.z_low,
            z_high=own.z_high,
        )
        boxes.append(widened(box, bottom.meridian, settings.boss_widening))

    def needed(after: str, before: str) -> float:
        return shortest_gap(max(height[after], height[before]), settings)

    bands = without_slivers(bands_of(bottom.meridian, boxes, needed), settings.narrowest)
    regions = tuple(
        _offered(r, bands, height, settings) for r in regions_of(bands, bottom.meridian)
    )
    around = around_bosses(bands, bottom.meridian)
    return BottomRegions(
        bottom=bottom,
        bands=bands,
        regions=regions,
        around=around,
        off=uncovered(regions, around, bottom.meridian),
    )


def _offered(
    region: MachiningRegion,
    bands: tuple[BottomBand, ...],
    height: dict[str, float],
    settings: RegionSettings,
) -> MachiningRegion:
    """Return a milled gap with the lower speed at which it could be turned, if there is one, by its shortest arc."""
    if region.kind != MILL:
        return region
    arc = min(
        g.arc
        for b in bands
        if b.z[0] < region.z[1] and b.z[1] > region.z[0]
        for g in b.gaps
        if (g.after, g.before) == (region.after, region.before)
    )
    speed = speed_for(arc, max(height[region.after], height[region.before]), settings)
    if speed is None:
        return region
    return replace(region, lower_speed=speed, costs=settings.surface_speed / speed)


def region_findings(plans: tuple[BottomRegions, ...]) -> tuple[Finding, ...]:
    """Return what a person should know of regions: gaps that a lower speed makes long enough, and regions that miss the bottom."""
    found = []
    for plan in plans:
        name = plan.bottom.pocket.id
        offers = [r for r in plan.regions if r.lower_speed is not None]
        for r in offers:
            found.append(
                info(
                    "casing.lower-speed",
                    f"the gap from {r.after} to {r.before} between z {r.z[0]:.1f} and {r.z[1]:.1f} mm is too short to be turned; at "
                    f"{r.lower_speed:.0f} m/min it is long enough, and turning takes {r.costs:.1f} times as long",
                    name,
                    r.after,
                    r.before,
                    remedy=f"choose surface_speed = {r.lower_speed:.0f}, or leave the gap to milling",
                )
            )
        if plan.off > COVERED:
            found.append(
                error(
                    "casing.regions-off",
                    f"the regions of {name} differ from its area by {plan.off:.2%}",
                    name,
                    remedy="look at the bosses there: one of them may be recognised wrongly",
                )
            )
    return tuple(found)


def _band_dict(band: BottomBand) -> dict[str, Any]:
    return {
        "z": rounded_pair(band.z),
        "kind": band.kind,
        "mean_radius": round(band.mean_radius, 6),
        "bosses": list(band.bosses),
        "gaps": [
            {
                "after": g.after,
                "before": g.before,
                "theta": [round(degrees(t), 6) for t in g.theta],
                "arc": round(g.arc, 6),
                "needed": round(g.needed, 3),
                "long_enough": g.long_enough,
            }
            for g in band.gaps
        ],
    }


def _run_dict(run: BandRun) -> dict[str, Any]:
    return {"z": rounded_pair(run.z), "kind": run.kind, "bosses": list(run.bosses)}
