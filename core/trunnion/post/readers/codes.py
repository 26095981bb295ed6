"""The G and M codes that the reader of LinuxCNC text knows, why it refuses others, and which words and codes may share a line."""

from __future__ import annotations

from trunnion.findings import BadInput
from trunnion.model.toolpath import Motion
from trunnion.post.readers.blocks import Block

MOTIONS = {"G0": Motion.RAPID, "G1": Motion.LINE, "G2": Motion.ARC_CW, "G3": Motion.ARC_CCW}
OFFSETS = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")
_GROUPS = (("G0", "G1", "G2", "G3", "G80"), ("G20", "G21"), OFFSETS, ("G43", "G49"), ("G61", "G61.1", "G64"), ("G93", "G94"),
           ("M3", "M5"), ("M7", "M9"), ("M8", "M9"), ("M0", "M1", "M2", "M30"))
_WITHOUT_MOTION = frozenset(("G17", "G40", "G61", "G61.1", "G90", "G91.1", "G94", "G97", "M0", "M1"))
KNOWN = _WITHOUT_MOTION | frozenset((*MOTIONS, *OFFSETS, "G4", "G20", "G21", "G43", "G49", "G53", "G64", "G80", "M2", "M3", "M5", "M6",
                                     "M7", "M8", "M9", "M30"))
_REFUSED = {
    "G18": "arcs in the plane ZX are not understood; use G17", "G19": "arcs in the plane YZ are not understood; use G17",
    "G41": "cutter compensation changes the path at the machine; write the tool centre's path under G40",
    "G42": "cutter compensation changes the path at the machine; write the tool centre's path under G40",
    "G90.1": "absolute arc centres are not understood; use G91.1 and centres from the arc's start",
    "G91": "incremental moves are not understood; use G90", "G93": "inverse-time feeds are not understood; use G94",
    "G95": "feeds a turn are not understood; use G94", "M4": "it turns the cutter backwards; use M3",
    "G28": "the place of G28 is not known here; use G53 G0 Z0", "G30": "the place of G30 is not known here; use G53 G0 Z0",
    "G92": "it moves the program's zero; use the setup's work offset", "G10": "it changes offsets; set them at the machine",
}
_CYCLES = frozenset(("G73", "G74", "G76", "G81", "G82", "G83", "G84", "G85", "G86", "G87", "G88", "G89", "G98", "G99"))
_ROTARY = "ABC"


def why_not(code: str) -> str:
    """Return why a code is refused, and what to write for it."""
    if code in _REFUSED:
        return f"{code}: {_REFUSED[code]}"
    if code in _CYCLES:
        return f"{code}: canned cycles are not understood; write the moves out"
    return f"{code} is not understood; remove it or write what it does in known words"


def one_of_a_group(line: int, codes: list[str]) -> None:
    """Raise `BadInput` for two codes of one modal group."""
    for group in _GROUPS:
        found = [c for c in codes if c in group]
        if len(found) > 1:
            raise BadInput(f"line {line}: {' and '.join(found)} can't stand in one line; keep one")


def letters_belong(block: Block) -> None:
    """Raise `BadInput` for letters whose code is missing: H without G43, P and Q without what takes them."""
    words, codes = block.words, block.codes
    takes_p = "G64" in codes or "G4" in codes or "I" in words or "J" in words
    if "P" in words and not takes_p:
        raise BadInput(f"line {block.line}: P without G4, G64 or an arc; remove it")
    if "Q" in words and "G64" not in codes:
        raise BadInput(f"line {block.line}: Q without G64; remove it")
    if "H" in words and "G43" not in codes:
        raise BadInput(f"line {block.line}: H without G43; write G43 H{words['H']:g}")
    if "G4" in codes and "G64" in codes:
        raise BadInput(f"line {block.line}: G4 and G64 in one line: whose P it is is not clear; write two lines")
    if "G4" in codes and any(letter in words for letter in "XYZIJR" + _ROTARY):
        raise BadInput(f"line {block.line}: a dwell G4 and a move in one line; write two lines")
    if "G53" in codes and not any(letter in words for letter in "XYZ"):
        raise BadInput(f"line {block.line}: G53 without a move")
