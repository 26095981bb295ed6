"""The tool crib: which tools are in which machine, with T number, pocket, and wear as the shop measured it.

A crib is a file of the user's folder, `crib/MACHINE.toml`, with one table a machine and one a tool in it:

    ["Mill 1200"."AL3 D10 R0"]
    number = 5
    pocket = 12
    wear_length = -0.012
    wear_radius = 0.004

Wear informs: tool lists and setup sheets have it, no geometry is changed by it (ISO 6983-1 leaves tool offsets to the control).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

from trunnion.findings import BadInput
from trunnion.model.process import ProcessTree
from trunnion.model.tool import AnyTool
from trunnion.shop.exchange.catalogue_text import quoted
from trunnion.shop.reading import SUFFIX, CatalogueEntry, by_name, entries, file_entries

KIND = "crib"
"""The folder of cribs in the user's folder."""
HIGHEST_NUMBER = 99_999
"""The highest T number and pocket; LinuxCNC's tool table, the widest of ours, takes five digits."""
LARGEST_WEAR = 5.0
"""mm: what is worn or reground by more is another tool."""
FIELDS = ("number", "pocket", "wear_length", "wear_radius")
"""The fields of a tool's table, as `schemas/crib.json` has them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CribTool:
    """A tool in a machine: its name in the catalogue, its T number, its pocket in the magazine (0: not known), and by how much in mm its
    length and radius differ from the catalogue's (below 0: worn away)."""

    name: str
    number: int
    pocket: int = 0
    wear_length: float = 0.0
    wear_radius: float = 0.0

    def as_dict(self) -> dict[str, Any]:
        """Return the tool as JSON has it."""
        return {"name": self.name, **{field: getattr(self, field) for field in FIELDS}}


@dataclass(frozen=True, slots=True, kw_only=True)
class Crib:
    """The tools in one machine, by T number; no two have the same number or pocket."""

    machine: str
    tools: tuple[CribTool, ...] = ()

    @property
    def names(self) -> frozenset[str]:
        """The names of its tools."""
        return frozenset(t.name for t in self.tools)

    @property
    def numbers(self) -> tuple[tuple[str, int], ...]:
        """Name and T number of each tool: all that a plan depends on."""
        return tuple((t.name, t.number) for t in self.tools)

    def tool(self, name: str) -> CribTool | None:
        """Return the tool of a name, None where it is not in the machine."""
        return next((t for t in self.tools if t.name == name), None)

    def free_number(self) -> int:
        """Return the lowest T number that no tool has."""
        taken = {t.number for t in self.tools}
        return next(n for n in range(1, len(taken) + 2) if n not in taken)

    def put(self, tool: CribTool, pockets: int) -> Crib:
        """Return the crib with a tool in it, in the place of one of its name; `pockets`: how many the magazine has.

        Raises `BadInput` for a T number or pocket that another tool has, that can't be, or where the magazine is full.
        """
        others = tuple(t for t in self.tools if t.name != tool.name)
        if tool.pocket > pockets or len(others) >= pockets:
            raise self._wrong(f"the magazine has {pockets} pockets; take another tool out first")
        return self._checked((*others, tool))

    def take(self, name: str) -> Crib:
        """Return the crib without a tool; raise `BadInput` where it is not in the machine."""
        self._known(name)
        return replace(self, tools=tuple(t for t in self.tools if t.name != name))

    def with_wear(self, name: str, length: float, radius: float) -> Crib:
        """Return the crib with the wear in mm of a tool; raise `BadInput` where it is not in the machine, or for wear that can't be."""
        worn = replace(self._known(name), wear_length=length, wear_radius=radius)
        return self._checked(tuple(worn if t.name == name else t for t in self.tools))

    def _known(self, name: str) -> CribTool:
        found = self.tool(name)
        if found is None:
            raise self._wrong(f"{name} is not in the machine; put it there first")
        return found

    def _checked(self, tools: Iterable[CribTool]) -> Crib:
        """Return the crib with other tools, read as their file is: what can't be written is refused at once."""
        made = replace(self, tools=tuple(sorted(tools, key=lambda t: t.number)))
        fields = {t.name: _fields(t) for t in made.tools}
        return _crib(CatalogueEntry(file=KIND, name=self.machine, fields=fields))

    def _wrong(self, what: str) -> BadInput:
        return BadInput(f"{KIND}: {self.machine}: {what}")


Cribs = Mapping[str, Crib]
"""Cribs by the names of their machines."""
NO_CRIBS: Cribs = MappingProxyType({})


def load_cribs(user_folder: Path | None) -> dict[str, Crib]:
    """Return the cribs of a user's folder by machine; raise `BadInput` with file, machine and tool of the first fault.

    Tools and machines that the catalogue doesn't have stay: what is in the machine keeps its T number.
    """
    return {name: _crib(entry) for name, entry in by_name(entries(KIND, user_folder)).items()}


def crib_file(user_folder: Path, machine: str) -> Path:
    """Return the file that a machine's crib is kept in: the one that has its table, else one of its name."""
    for path in sorted((user_folder / KIND).glob(f"*{SUFFIX}")):
        if any(entry.name == machine for entry in file_entries(path, str(path))):
            return path
    stem = re.sub(r"[^\w .-]", "-", machine).strip(" .") or "machine"
    return user_folder / KIND / f"{stem}{SUFFIX}"


def cribs_in(path: Path) -> dict[str, Crib]:
    """Return the cribs of one file, none where it is not there."""
    if not path.exists():
        return {}
    return {entry.name: _crib(entry) for entry in file_entries(path, str(path))}


def crib_text(cribs: Iterable[Crib]) -> str:
    """Return the text of a file with some cribs, the same for the same cribs."""
    blocks = ["# Tools in the machine: T number, pocket, wear in mm (below 0: worn away).\n"]
    for crib in cribs:
        blocks.append(f"[{quoted(crib.machine)}]\n")
        for tool in crib.tools:
            lines = "".join(f"{name} = {value!r}\n" for name, value in _fields(tool).items())
            blocks.append(f"[{quoted(crib.machine)}.{quoted(tool.name)}]\n{lines}")
    return "\n".join(blocks)


def _fields(tool: CribTool) -> dict[str, Any]:
    """Return the fields of a tool's table: its number, and others that are not 0."""
    return {"number": tool.number} | {
        name: value for name in FIELDS[1:] if (value := getattr(tool, name))
    }


def _crib(entry: CatalogueEntry) -> Crib:
    tools = [_tool(entry, name) for name in entry.fields]
    for word in ("number", "pocket"):
        given: dict[int, str] = {}
        for tool in tools:
            value: int = getattr(tool, word)
            if value and given.setdefault(value, tool.name) != tool.name:
                raise entry.wrong(
                    f"{given[value]} and {tool.name} have the same {word}, {value}; give one of them another"
                )
    return Crib(machine=entry.name, tools=tuple(sorted(tools, key=lambda t: t.number)))


def _tool(entry: CatalogueEntry, name: str) -> CribTool:
    table = entry.table(name)
    made = CribTool(
        name=name,
        number=table.count("number", 1, HIGHEST_NUMBER),
        pocket=table.count("pocket", 0, HIGHEST_NUMBER) if table.has("pocket") else 0,
        wear_length=table.number("wear_length", -LARGEST_WEAR, LARGEST_WEAR, 0.0),
        wear_radius=table.number("wear_radius", -LARGEST_WEAR, LARGEST_WEAR, 0.0),
    )
    table.done()
    return made


@dataclass(frozen=True, slots=True, kw_only=True)
class PlanTool:
    """A tool of a plan as tool lists have it, with its machine and what the crib of that has of it (None: in no machine)."""

    tool: AnyTool
    machine: str
    crib: CribTool | None

    def as_dict(self) -> dict[str, Any]:
        """Return the tool as `NAME.tools.json` has it; machine, pocket and wear are there where it is in a machine."""
        if self.crib is None:
            return self.tool.as_dict()
        wear = {"length": self.crib.wear_length, "radius": self.crib.wear_radius}
        return {
            **self.tool.as_dict(),
            "machine": self.machine,
            "pocket": self.crib.pocket,
            "wear": wear,
        }


def tools_listed(process: ProcessTree, cribs: Cribs = NO_CRIBS) -> tuple[PlanTool, ...]:
    """Return the tools in use of a plan by number, each once, with what the crib of the machine has where it has that number."""
    found = {(t.number, t.name): PlanTool(tool=t, machine="", crib=None) for t in process.tools()}
    for machine in dict.fromkeys(s.machine for s in process.setups if s.machine in cribs):
        for tool in process.tools(machine):
            entry, key = cribs[machine].tool(tool.name), (tool.number, tool.name)
            if entry is not None and entry.number == tool.number and found[key].crib is None:
                found[key] = PlanTool(tool=tool, machine=machine, crib=entry)
    return tuple(found[key] for key in sorted(found))
