"""What is written for another program comes back as it was, but for the losses that are listed: no more, and no fewer."""

from __future__ import annotations

import dataclasses
import math
import tempfile
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from random_cutters import CONTEXT, cutters
from trunnion import registry
from trunnion.findings import BadInput
from trunnion.shop.cutters import Cutter, load_cutters, load_holders
from trunnion.shop.exchange import LossKind, ReadTools, WrittenTools
from trunnion.shop.exchange.catalogue_text import foreign_holders, holders_text, tools_text
from trunnion.shop.exchange.contract import WHOLE_TOOL
from trunnion.shop.exchange.fields import ONLY

FORMATS = tuple(
    (name, suffix)
    for name in registry.names(registry.TOOL_FORMATS)
    for suffix in registry.get(registry.TOOL_FORMATS, name).suffixes
    if suffix != ".fctb"
)
"""Every format with every ending of its files that holds several tools."""
WORDS = {"description": "title"}
"""Fields of a tool that a catalogue file calls otherwise."""
DERIVED = ("form", "holder", "gauge_length")
"""Fields that are compared apart: an end mill's form follows from its corner, the rest from others."""


def written_and_read(
    name: str, suffix: str, tools: list[Cutter], unit: str = "mm"
) -> tuple[WrittenTools, ReadTools | None]:
    """Return what a format writes of tools, and what it reads of the files on the disk; nothing where none was written."""
    form = registry.get(registry.TOOL_FORMATS, name)()
    options = dataclasses.replace(CONTEXT, unit=unit)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"tools{suffix}"
        done = form.write(tools, path, options)
        for file, data in done.files.items():
            assert file.parent == path.parent
            file.write_bytes(data)
        # A tool may be left out, or be written so that it can't be made whole again: both are told as the loss of the whole tool.
        gone = [l for l in done.losses if l.field == WHOLE_TOOL]
        if len(gone) < len(tools):
            return done, form.read(path, options)
        if path in done.files:
            with pytest.raises(BadInput):
                form.read(path, options)
    return done, None


def near(a: Any, b: Any) -> bool:
    if isinstance(a, float) and isinstance(b, float):
        return math.isclose(a, b, rel_tol=0, abs_tol=1e-6)
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(map(near, a, b))
    return a == b


def differing(cutter: Cutter, other: Cutter) -> set[str]:
    """Return the fields in which two cutters differ, found without any help of the code that lists losses."""
    a, b = cutter.tool, other.tool
    found = {
        WORDS.get(f.name, f.name)
        for f in dataclasses.fields(a)
        if f.name not in DERIVED and not near(getattr(a, f.name), getattr(b, f.name))
    }
    ends = ("flat", "bull", "ball")
    if a.form != b.form and not (a.form in ends and b.form in ends):
        found.add("form")
    found |= {"holder"} if a.holder.name != b.holder.name else set()
    found |= {"holder_rows"} if not near(a.holder.rows, b.holder.rows) else set()
    found |= {"suits"} if cutter.suits != other.suits else set()
    found |= {"use"} if cutter.use != other.use else set()
    return found


def assumed(read: ReadTools, name: str) -> set[str]:
    return {l.field for l in read.losses if l.tool == name and l.kind is LossKind.ASSUMED}


@pytest.mark.examples(30)
@pytest.mark.parametrize(("name", "suffix"), FORMATS)
@given(data=st.data())
@settings(max_examples=100, deadline=None)
def test_a_tool_comes_back_but_for_exactly_what_is_listed(name, suffix, data):
    cutter = data.draw(cutters())
    unit = data.draw(st.sampled_from(("mm", "inch")))
    done, again = written_and_read(name, suffix, [cutter], unit)
    listed = {l.field for l in done.losses if l.kind in (LossKind.LOST, LossKind.ASSUMED)}
    if again is None:
        return
    (back,) = again.cutters
    ours = {WORDS.get(f.name, f.name) for f in dataclasses.fields(cutter.tool)}
    own = listed & (ours | {"holder_rows", "suits", "use"})
    unsaid = assumed(again, back.tool.name) & own
    found = differing(cutter, back)
    found |= (
        {"gauge_length"} if not near(cutter.tool.gauge_length, back.tool.gauge_length) else set()
    )
    # A field of another form, such as the corner that a tap is read with, is lost with the form.
    if "form" not in found:
        assert found <= own, "a field that differs is not listed"
    else:
        assert {
            f for f in found if f in own or getattr(cutter.tool, f, 0) not in (0.0, "", (), 180.0)
        } <= own
    # Lost with the form, whatever the other form has in their place: the point of a drill of 180 degrees too.
    with_form = set(ONLY) if "form" in found else set()
    assert own <= found | unsaid | with_form, "a field is listed that came back as it was"


@pytest.mark.examples(8)
@pytest.mark.parametrize(("name", "suffix"), FORMATS)
@given(tools=st.lists(cutters(), min_size=2, max_size=5))
@settings(max_examples=30, deadline=None)
def test_a_library_comes_back_in_its_order_with_names_that_differ(name, suffix, tools):
    done, again = written_and_read(name, suffix, tools)
    if again is None:
        return
    gone = [l for l in done.losses if l.field == WHOLE_TOOL]
    assert len({c.tool.name for c in again.cutters}) == len(again.cutters) == len(tools) - len(gone)
    same, _ = written_and_read(name, suffix, tools)
    assert {f.name: d for f, d in same.files.items()} == {f.name: d for f, d in done.files.items()}
    assert same.losses == done.losses
    names = [c.tool.name for c in tools]
    twice = {n for n in names if names.count(n) > 1}
    assert twice <= {l.tool for l in done.losses if l.field in ("name", WHOLE_TOOL)}


@pytest.mark.examples(8)
@given(tools=st.lists(cutters(), min_size=1, max_size=4))
@settings(max_examples=25, deadline=None)
def test_catalogue_files_give_back_the_tools_that_they_are_written_of(tools):
    known = {c.tool.name for c in CONTEXT.cutters}
    unique = {c.tool.name: c for c in tools if c.tool.name not in known}
    holders = {c.tool.holder.name: c.tool.holder for c in unique.values()}
    unique = {
        n: c
        for n, c in unique.items()
        if c.tool.holder.name not in CONTEXT.holders
        or c.tool.holder == CONTEXT.holders[c.tool.holder.name]
    }
    unique = {n: c for n, c in unique.items() if holders[c.tool.holder.name] == c.tool.holder}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        written = tuple(unique.values())
        for kind, text in (
            ("tools", tools_text(written, source="a\nb")),
            ("holders", holders_text(foreign_holders(written, CONTEXT.holders))),
        ):
            (folder / kind).mkdir()
            (folder / kind / "own.toml").write_text(text, encoding="utf-8")
        found = {c.tool.name: c for c in load_cutters(load_holders(folder), folder)}
    for cutter in written:
        again = found[cutter.tool.name]
        assert differing(cutter, again) <= {
            "number",
            *(["fit"] if cutter.tool.form == "boring-bar" else []),
        }
        assert again.tool.form == cutter.tool.form
