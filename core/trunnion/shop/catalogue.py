"""The shop: every catalogue, the program's own with the user's folder over it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TypeVar

from trunnion.findings import BadInput
from trunnion.model.hole_limits import Limits
from trunnion.model.material import (
    DrillingTable,
    Machine,
    Material,
    TappingTable,
    ThreadMillingTable,
    TurningTable,
)
from trunnion.model.screw_thread import ScrewThread
from trunnion.model.tool import Tool, TurningTool
from trunnion.settings import digest
from trunnion.shop.crib import Crib, Cribs, load_cribs
from trunnion.shop.cutters import Cutter, load_cutters, load_holders
from trunnion.shop.drilling import load_boring, load_drilling, load_reaming, load_tapping
from trunnion.shop.fits import FitTables, load_fits
from trunnion.shop.machines import load_machines
from trunnion.shop.materials import load_materials
from trunnion.shop.plans import TypicalPlan, load_plans
from trunnion.shop.screw_threads import ThreadTables, load_threads
from trunnion.shop.thread_milling import load_thread_milling
from trunnion.shop.turning import load_turning, load_turning_data

T = TypeVar("T")


@dataclass(frozen=True, kw_only=True)
class Shop:
    """Cutters, materials, machines and typical plans that a plan may choose from; `plans` in their order (`load_plans`).

    `turning` has the turning tools: no cutter that mills or drills is among them, and none of them among the cutters. `drilling` says by
    ISO 513 group or by material what drills bear, `reaming`, `boring`, `tapping` and `thread_milling` what reamers, boring bars, taps and
    thread mills do, `turning_data` what inserts do; `fits` and `threads` have the limits of holes and screw threads. `cribs` says which
    of the tools are in which machine.
    """

    cutters: tuple[Cutter, ...]
    materials: Mapping[str, Material]
    machines: Mapping[str, Machine]
    plans: Mapping[str, TypicalPlan]
    turning: tuple[TurningTool, ...] = ()
    drilling: Mapping[str, DrillingTable] = field(default_factory=dict)
    turning_data: Mapping[str, TurningTable] = field(default_factory=dict)
    reaming: Mapping[str, DrillingTable] = field(default_factory=dict)
    boring: Mapping[str, DrillingTable] = field(default_factory=dict)
    tapping: Mapping[str, TappingTable] = field(default_factory=dict)
    thread_milling: Mapping[str, ThreadMillingTable] = field(default_factory=dict)
    fits: FitTables = field(default_factory=FitTables)
    threads: ThreadTables = field(default_factory=ThreadTables)
    cribs: Cribs = field(default_factory=dict)

    @property
    def tools(self) -> tuple[Tool, ...]:
        """All cutters, sorted by diameter, corner radius and reach; their numbers are 0."""
        return tuple(c.tool for c in self.cutters)

    @property
    def names(self) -> frozenset[str]:
        """The names of all cutters and turning tools."""
        return frozenset((*(c.tool.name for c in self.cutters), *(t.name for t in self.turning)))

    @cached_property
    def digest(self) -> str:
        """A short stable digest of everything in the catalogues: what was planned with another one is stale."""
        return digest(
            self.cutters,
            self.materials,
            self.machines,
            self.plans,
            tuple(self.plans),
            self.turning,
            self.drilling,
            self.turning_data,
            self.reaming,
            self.boring,
            self.tapping,
            self.thread_milling,
            self.fits,
            self.threads,
            *(self._crib_numbers,) * bool(self.cribs),
        )

    @property
    def _crib_numbers(self) -> dict[str, tuple[tuple[str, int], ...]]:
        """What plans depend on of the cribs: wear and pockets change no plan."""
        return {name: crib.numbers for name, crib in self.cribs.items()}

    def tools_for(self, iso_group: str, use: str) -> tuple[Tool, ...]:
        """Return the cutters made for a group of materials and a use (`face`, `rough`, `finish`)."""
        return tuple(c.tool for c in self.cutters if iso_group in c.suits and use in c.use)

    def crib(self, machine: str) -> Crib:
        """Return the tools in a machine, an empty crib where none is kept."""
        return self.cribs.get(machine, Crib(machine=machine))

    def with_tools(self, cutters: Collection[str], turning: Collection[str]) -> Shop:
        """Return the shop with only the cutters and the turning tools of some names."""
        return replace(
            self,
            cutters=tuple(c for c in self.cutters if c.tool.name in cutters),
            turning=tuple(t for t in self.turning if t.name in turning),
        )

    def material(self, name: str) -> Material:
        """Return a material; raise `BadInput` with the known names."""
        return _named(self.materials, name, "material")

    def drilling_for(self, material: Material) -> DrillingTable:
        """Return what drills bear in a material: its own table, else that of its group; raise `BadInput` where there is neither."""
        return _table_of(self.drilling, material, "drilling")

    def reaming_for(self, material: Material) -> DrillingTable:
        """Return what reamers bear in a material, and the allowance they need, as `drilling_for` does of drills."""
        return _table_of(self.reaming, material, "reaming")

    def boring_for(self, material: Material) -> DrillingTable:
        """Return what boring bars bear in a material, as `drilling_for` does for drills."""
        return _table_of(self.boring, material, "boring")

    def tapping_for(self, material: Material) -> TappingTable:
        """Return what taps bear in a material, as `drilling_for` does of drills."""
        return _table_of(self.tapping, material, "tapping")

    def thread_milling_for(self, material: Material) -> ThreadMillingTable:
        """Return what thread mills bear in a material, as `drilling_for` does of drills."""
        return _table_of(self.thread_milling, material, "thread_milling")

    def fit_limits(self, text: str, diameter: float) -> Limits:
        """Return the limits of a hole of a nominal diameter (mm) by its tolerance class (ISO 286-1, "H7") or by deviations in mm
        ("+0.021/0", "+-0.02"); raise `BadInput` with what is known."""
        return self.fits.limits(text, diameter)

    def thread(self, text: str) -> ScrewThread:
        """Return the screw thread that a text names ("M6", "M6x0.75", "1/4-20 UNC"); raise `BadInput` with what is known."""
        return self.threads.thread(text)

    def turning_for(self, material: Material) -> TurningTable:
        """Return what inserts bear in a material: its own table, else that of its group; raise `BadInput` where there is neither."""
        found = self.turning_data.get(material.name) or self.turning_data.get(material.iso_group)
        if found is None:
            raise BadInput(
                f"nothing is known of turning {material.name}: add a table [data.{material.iso_group}] to the turning folder"
            )
        return found

    def machine(self, name: str) -> Machine:
        """Return a machine; raise `BadInput` with the known names."""
        return _named(self.machines, name, "machine")

    def turning_tool(self, name: str) -> TurningTool:
        """Return a turning tool, `HOLDER INSERT`; raise `BadInput` with the known names."""
        return _named({t.name: t for t in self.turning}, name, "turning tool")

    def plan_for(self, family: str, named: str = "") -> TypicalPlan:
        """Return the typical plan of a family that is named, or (empty) its first; raise `BadInput` when there is none."""
        known = {name: plan for name, plan in self.plans.items() if plan.family == family}
        if not known:
            raise BadInput(
                f"there is no typical plan for the family {family}; add one to the plans folder"
            )
        return (
            _named(known, named, f"typical plan for the family {family},")
            if named
            else next(iter(known.values()))
        )


def load_shop(user_folder: Path | None = None) -> Shop:
    """Return the catalogues, checked; raise `BadInput` with file, entry and field of the first fault.

    `user_folder` has the shape of the program's own (`tools`, `holders`, `turning`, `materials`, `drilling`, `reaming`, `boring`,
    `tapping`, `thread_milling`, `fits`, `threads`, `machines`, `plans`, each with TOML files) and adds entries or replaces those of the
    same name; its `crib` says which tools are in which machine. What is missing there is not needed.
    """
    return Shop(
        cutters=load_cutters(load_holders(user_folder), user_folder),
        materials=load_materials(user_folder),
        machines=load_machines(user_folder),
        plans=load_plans(user_folder),
        turning=load_turning(user_folder),
        drilling=load_drilling(user_folder),
        turning_data=load_turning_data(user_folder),
        reaming=load_reaming(user_folder),
        boring=load_boring(user_folder),
        tapping=load_tapping(user_folder),
        thread_milling=load_thread_milling(user_folder),
        fits=load_fits(user_folder),
        threads=load_threads(user_folder),
        cribs=load_cribs(user_folder),
    )


def _table_of(tables: Mapping[str, T], material: Material, work: str) -> T:
    """Return a material's own table of a work, which names its folder too, else that of its group."""
    found = tables.get(material.name) or tables.get(material.iso_group)
    if found is None:
        raise BadInput(
            f"nothing is known of {work} {material.name}: add a table for it, or for the group {material.iso_group}, "
            f"to the {work} folder"
        )
    return found


def _named(things: Mapping[str, T], name: str, kind: str) -> T:
    if name not in things:
        raise BadInput(f"unknown {kind} {name}; known: {', '.join(sorted(things))}")
    return things[name]
