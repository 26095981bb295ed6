"""What only Sinumerik's codes do: tip control, tilted planes, smoothing, and cycles that are called."""

from __future__ import annotations

import math

import numpy as np

from trunnion import tolerance
from trunnion.findings import BadInput
from trunnion.geometry.arrays import Floats
from trunnion.post.readers.sinumerik.blocks import CallBlock
from trunnion.post.readers.sinumerik.calls import CallParameters
from trunnion.post.readers.sinumerik.cycles import CycleCall, cycle_of_call
from trunnion.post.readers.tip_modes import TipModes
from trunnion.post.readers.word_address.blocks import Block

FIRST_EDGE = 1.0
"""D of a cutting edge: the tool list has one a tool."""
SMOOTHINGS = ("_OFF", "_FINISH", "_SEMIFIN", "_ROUGH", "0", "1", "2", "3")
"""Machining types of CYCLE832 whose orientation tolerance is the control's own."""
ORIENTED = ("_ORI_FINISH", "_ORI_SEMIFIN", "_ORI_ROUGH", "11", "12", "13")
"""Those with an orientation tolerance of their own, in degrees."""
MOST_ORIENTATION = 0.05
"""Degrees: at 23 mm above the tip the flutes are as far aside as a gouge may be deep."""
AXES = {1: 0, 2: 1, 3: 2}
"""Coordinate axis of each turn of a swivel mode: two bits a turn, the first turn in the lowest."""


class SinumerikModes(TipModes):
    """Works off the codes of a Sinumerik text. `cycle` is in force for positions, `called` is to be cut where the tool is."""

    own = {
        "tip control": "follow_tip",
        "no tip control": "leave_tip",
        "plane": "tilt_plane",
        "smoothing": "check_smoothing",
        "modal call": "end_cycle",
        "cycle call": "call_cycle",
    }
    cycle: CycleCall | None = None
    called: CycleCall | None = None

    def set_length(self, block: Block) -> None:
        """Count the length of the tool in the spindle: its first cutting edge."""
        if self.state.tool is None:
            raise BadInput(
                f"line {block.line}: D before a tool is in the spindle; put T and M6 first"
            )
        if block.words["D"] != FIRST_EDGE:
            raise BadInput(
                f"line {block.line}: D{block.words['D']:g} is a cutting edge that the tool list does not have; use D1"
            )
        self.state.length_on = True

    def follow_tip(self, block: Block) -> None:
        """Follow the tip from here on (TRAORI)."""
        if isinstance(block, CallBlock) and block.arguments not in ((), ("1",)):
            raise BadInput(
                f"line {block.line}: of TRAORI only the first transformation is understood; write TRAORI"
            )
        self.follow(block, "TRAORI")

    def tilt_plane(self, block: Block) -> None:
        """Tilt the plane of the program and the tool with it, or take that back (CYCLE800)."""
        if not isinstance(block, CallBlock):
            raise BadInput(
                f"line {block.line}: CYCLE800 without its parameters; write CYCLE800() to end it"
            )
        self.refuse_following(block, "CYCLE800")
        if not block.arguments:
            self.level(block, "CYCLE800")
            return
        if not self.state.length_on:
            raise BadInput(f"line {block.line}: CYCLE800 without the tool's length; put D1 first")
        given = CallParameters(block)
        self.tilt(block, "CYCLE800", plane_of(given), int(given.number("DIR", 0.0)))

    def check_smoothing(self, block: Block) -> None:
        """Check how far CYCLE832 lets the control leave the path."""
        if not isinstance(block, CallBlock) or not block.arguments:
            return
        given = CallParameters(block)
        kind, limit = given.text("TOLM").upper() or "0", given.number("TOL", 0.0) * self.state.unit
        if kind not in (*SMOOTHINGS, *ORIENTED):
            raise BadInput(
                f"line {block.line}: CYCLE832: {kind} is no machining type; write _FINISH, _SEMIFIN, _ROUGH or _OFF"
            )
        if not 0.0 <= limit <= tolerance.GOUGE:
            raise BadInput(
                f"line {block.line}: CYCLE832 leaves the path by {given.text('TOL')}, more than {tolerance.GOUGE:g} mm; "
                "give a smaller tolerance"
            )
        if kind in ORIENTED and not 0.0 <= given.number("OTOL") <= MOST_ORIENTATION:
            raise BadInput(
                f"line {block.line}: CYCLE832 turns the tool by {given.text('OTOL')} degrees, more than {MOST_ORIENTATION:g}; "
                "give a smaller tolerance"
            )

    def end_cycle(self, block: Block) -> None:
        """End the cycle in force: MCALL alone, or another that begins."""
        self.cycle = None

    def call_cycle(self, block: Block) -> None:
        """Take over a drilling cycle: after MCALL for each position that follows, else for where the tool is."""
        if not isinstance(block, CallBlock):
            name = next(c for c in block.codes if self.language.meanings[c] == "cycle call")
            raise BadInput(f"line {block.line}: {name} without its parameters")
        cycle = cycle_of_call(CallParameters(block), self.state.unit)
        if "MCALL" in block.codes:
            self.cycle = cycle
        else:
            self.called = cycle


def plane_of(given: CallParameters) -> Floats:
    """Return the axes (3, 3), as columns, of the plane that CYCLE800 tilts to; raise `BadInput` for what is not understood of it."""
    given.only(
        {
            "FR": (0.0,),
            "MODE": tuple(float(m) for m in MODES),
            **dict.fromkeys(("X0", "Y0", "Z0", "X1", "Y1", "Z1", "FR_I"), (0.0,)),
            "DIR": (-1.0, 1.0, 0.0),
        }
    )
    if not (given.text("ST") or "0").isdigit() or not (given.text("ST") or "0").endswith("0"):
        raise BadInput(
            f"line {given.line}: CYCLE800: ST {given.text('ST')} adds to a plane before; write 0 as its last digit"
        )
    matrix = np.eye(3)
    for turn, angle in zip(MODES[int(given.number("MODE", 57.0))], "ABC", strict=True):
        matrix = matrix @ _turned(turn, math.radians(given.number(angle, 0.0)))
    return matrix


def _orders() -> dict[int, tuple[int, int, int]]:
    """Return the axes of the three turns by the number of each swivel mode "axis by axis" that turns about three different ones."""
    found = {}
    for mode in range(64):
        turns = tuple(AXES.get(mode >> shift & 3, -1) for shift in (0, 2, 4))
        if sorted(turns) == [0, 1, 2]:
            found[mode] = (turns[0], turns[1], turns[2])
    return found


MODES = dict(sorted(_orders().items(), key=lambda item: item[0] != 57))
"""The modes that are understood, the usual one first: 57 turns about X, then the new Y, then the new Z."""


def _turned(axis: int, angle: float) -> Floats:
    """Return the turn (3, 3) about a coordinate axis: Rodrigues' formula with its unit vector."""
    u = np.eye(3)[axis]
    cross = np.cross(np.eye(3), u)
    return np.asarray(np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross)
