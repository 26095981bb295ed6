"""Damaged tool libraries: whatever is changed in a file, it gives tools or one line; the same seeds every time."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from random_cutters import CONTEXT, SHOP
from trunnion import registry
from trunnion.findings import BadInput
from trunnion.shop.exchange import format_of

LIBRARIES = Path(__file__).parents[1] / "tool_libraries"
ROUNDS = 200
ODD = (
    *(b"nan", b"-1", b"1e999", b"\0", b"\xff", b"''", b"(((", b"[[[", b'"', b"{}", b"null"),
    *(b"9" * 40, b"true", b"#1", b"$", b"\\X2\\D800\\X0\\", b"\\ud800"),
)
"""What is put into files beside changed, missing and repeated bytes."""


def originals(suffix: str) -> list[bytes]:
    """Return whole files of an ending: the samples, and one that is written of a tool of each form."""
    found = [p.read_bytes() for p in sorted(LIBRARIES.rglob(f"*{suffix}"))]
    forms = {c.tool.form: c for c in SHOP.cutters}
    tools = [forms["drill"]] if suffix == ".fctb" else list(forms.values())
    path = Path(f"written{suffix}")
    return [*found, format_of(path).write(tools, path, CONTEXT).files[path]]


def damaged(data: bytes, chance: random.Random) -> bytes:
    """Return bytes with a few places changed."""
    for _ in range(chance.randint(1, 4)):
        at = chance.randrange(len(data) + 1)
        length = chance.choice((0, 1, 1, 4, 40))
        put = chance.choice(
            (b"", bytes([chance.randrange(256)]), chance.choice(ODD), data[at : at + length] * 2)
        )
        data = data[:at] + put + data[at + length :]
    return data[: chance.randrange(len(data) + 1)] if chance.random() < 0.1 else data


SUFFIXES = [
    suffix
    for name in registry.names(registry.TOOL_FORMATS)
    for suffix in registry.get(registry.TOOL_FORMATS, name).suffixes
]


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_a_damaged_file_gives_tools_or_one_line(suffix, tmp_path):
    chance = random.Random(suffix)
    whole, path = originals(suffix), tmp_path / f"damaged{suffix}"
    refused = 0
    for _ in range(ROUNDS):
        path.write_bytes(damaged(chance.choice(whole), chance))
        try:
            found = format_of(path).read(path, CONTEXT)
        except BadInput as reason:
            assert "\n" not in str(reason) and len(str(reason)) < 500
            refused += 1
        else:
            assert all(c.tool.diameter > 0.0 and c.tool.name for c in found.cutters)
    assert refused > ROUNDS // 10, "damage is met"
