"""What each format loses of each kind of tool, as a table that a person reads; `TRUNNION_REGOLD=1` writes what comes out now."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

from random_cutters import CONTEXT, SHOP
from trunnion import registry
from trunnion.shop.cutters import Cutter
from trunnion.shop.exchange import LossKind
from trunnion.shop.exchange.contract import WHOLE_TOOL

GOLDEN = Path(__file__).resolve().parents[2] / "golden" / "tool_losses" / "expected.txt"
LIBRARY = ".fctl"
"""The ending that FreeCAD's tools are written with here: each in a file of its own."""


def examples() -> dict[str, Cutter]:
    """Return a cutter of each form of the catalogue, and of each use that a format has a word for; all have numbers."""
    found: dict[str, Cutter] = {}
    for cutter in SHOP.cutters:
        tool = cutter.tool
        name = f"{tool.form} ({', '.join(cutter.use)})"
        found.setdefault(name, replace(cutter, tool=replace(tool, number=len(found) + 1)))
    return dict(sorted(found.items()))


def table() -> str:
    """Return the losses of each example in each format."""
    lines = []
    for name in registry.names(registry.TOOL_FORMATS):
        form = registry.get(registry.TOOL_FORMATS, name)()
        ending = LIBRARY if LIBRARY in form.suffixes else form.suffixes[0]
        lines.append(f"{form.title}")
        for example, cutter in examples().items():
            done = form.write([cutter], Path(f"tools{ending}"), CONTEXT)
            omitted = [l.why for l in done.losses if l.field == WHOLE_TOOL]
            lost = [l.field for l in done.losses if l.kind is LossKind.LOST]
            invented = [l.field for l in done.losses if l.kind is LossKind.ASSUMED]
            words = f"not written: {omitted[0]}" if omitted else f"loses {', '.join(lost)}"
            lines.append(
                f"    {example}: {words}" + (f"; invents {', '.join(invented)}" if invented else "")
            )
        lines.append("")
    return "\n".join(lines)


def test_each_format_loses_of_each_kind_of_tool_what_the_table_says():
    found = table()
    if os.environ.get("TRUNNION_REGOLD"):
        GOLDEN.write_text(found)
    assert found == GOLDEN.read_text()


def test_the_table_has_a_tool_of_every_form_of_the_catalogue():
    assert {e.partition(" ")[0] for e in examples()} == {c.tool.form for c in SHOP.cutters}
