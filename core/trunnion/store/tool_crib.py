"""Tool cribs on the disk: tools put into a machine, taken out, and their wear, each change one file written whole or not at all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from trunnion.findings import BadInput
from trunnion.shop import Shop
from trunnion.shop.crib import Crib, CribTool, crib_file, crib_text, cribs_in
from trunnion.store.atomic import write_text
from trunnion.store.tool_library import make_folder


def put_tool(
    folder: Path, shop: Shop, machine: str, name: str, *, number: int = 0, pocket: int = 0
) -> Crib:
    """Put a tool of the catalogue into a machine, or give one there another T number and pocket; its wear stays. Return the crib.

    `folder` is the user's; number 0 takes the lowest free one. Raises `BadInput` for a machine or tool that the catalogue doesn't have, and
    for numbers that can't be.
    """
    pockets = shop.machine(machine).tool_places
    if name not in shop.names:
        raise BadInput(f"unknown tool {name}: `trunnion tools list` has the names")

    def put(crib: Crib) -> Crib:
        before = crib.tool(name) or CribTool(name=name, number=0)
        wanted = number or before.number or crib.free_number()
        return crib.put(replace(before, number=wanted, pocket=pocket), pockets)

    return _changed(folder, machine, put)


def take_tool(folder: Path, machine: str, name: str) -> Crib:
    """Take a tool out of a machine and return the crib; raise `BadInput` where it is not there."""
    return _changed(folder, machine, lambda crib: crib.take(name))


def set_wear(folder: Path, machine: str, name: str, length: float, radius: float) -> Crib:
    """Keep the measured wear in mm of a tool in a machine and return the crib; raise `BadInput` where it is not there."""
    return _changed(folder, machine, lambda crib: crib.with_wear(name, length, radius))


def _changed(folder: Path, machine: str, change: Callable[[Crib], Crib]) -> Crib:
    """Return a machine's crib after a change, written to its file; other machines in that file stay as they are."""
    path = crib_file(folder, machine)
    cribs = cribs_in(path)
    changed = change(cribs.get(machine, Crib(machine=machine)))
    make_folder(path.parent)
    write_text(path, crib_text({**cribs, machine: changed}.values()))
    return changed
