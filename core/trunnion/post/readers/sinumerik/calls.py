"""Calls of a Sinumerik text: their arguments by the names of the manual's parameters, as numbers."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from trunnion.findings import BadInput
from trunnion.post.readers.numbers import LENGTH, shown
from trunnion.post.readers.sinumerik.blocks import CallBlock

_DRILLING = "RTP RFP SDIS DP DPR"
PARAMETERS: Mapping[str, tuple[str, ...]] = {
    name: tuple(names.split())
    for name, names in {
        "CYCLE81": _DRILLING,
        "CYCLE82": f"{_DRILLING} DTB",
        "CYCLE83": f"{_DRILLING} FDEP FDPR DAM DTB DTS FRF VARI AXN MDEP VRT DTD DIS1",
        "CYCLE84": f"{_DRILLING} DTB SDAC MPIT PIT POSS SST SST1",
        "CYCLE85": f"{_DRILLING} DTB FFR RFF",
        "CYCLE86": f"{_DRILLING} DTB SDIR RPA RPO RPAP POSS",
        "CYCLE89": f"{_DRILLING} DTB",
        "CYCLE800": "FR TC ST MODE X0 Y0 Z0 A B C X1 Y1 Z1 DIR FR_I DMODE",
        "CYCLE832": "TOL TOLM OTOL",
    }.items()
}
"""The parameters of each call in their order."""
_NUMBER = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)")


class CallParameters:
    """The arguments of one call, by the names of its parameters."""

    def __init__(self, block: CallBlock) -> None:
        names = PARAMETERS[block.name]
        self.line, self.name = block.line, block.name
        if len(block.arguments) > len(names):
            raise BadInput(
                f"line {block.line}: {block.name} has {len(block.arguments)} parameters, the first {len(names)} are understood: "
                f"{', '.join(names)}"
            )
        self.texts = dict(zip(names, block.arguments, strict=False))

    def text(self, name: str) -> str:
        """Return an argument as it is written, empty where it is left out."""
        return self.texts.get(name, "")

    def number(self, name: str, default: float | None = None) -> float:
        """Return an argument; raise `BadInput` for one that is missing without a default, no number, or out of range."""
        text = self.text(name)
        if not text:
            if default is None:
                raise BadInput(f"line {self.line}: {self.name} needs {name}")
            return default
        if not _NUMBER.fullmatch(text):
            raise BadInput(
                f"line {self.line}: {self.name}: {name} is {shown(text)}; parameters and expressions are not understood, "
                "write the number itself"
            )
        LENGTH.check(self.line, f"{self.name} {name} ", float(text))
        return float(text) + 0.0

    def only(self, values: Mapping[str, Sequence[float]]) -> None:
        """Raise `BadInput` for an argument with another value than those that are understood; one that is left out counts as the first."""
        for name, known in values.items():
            if self.number(name, known[0]) not in known:
                listed = " or ".join(f"{v:g}" for v in known)
                raise BadInput(
                    f"line {self.line}: {self.name}: {name} {self.text(name)} is not understood; write {listed}"
                )
