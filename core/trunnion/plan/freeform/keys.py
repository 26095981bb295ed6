"""Keys of an operation's choices that say what a drive on curved faces is made with."""

from __future__ import annotations

from trunnion.model.operation import Operation

SCALLOP, ALLOWANCE, BOTTOM, CELL = (
    "surface.scallop",
    "surface.allowance",
    "surface.bottom",
    "surface.cell",
)
"""Keys of an operation's choices, mm: the scallop height it is wanted with, what it leaves on purpose, the height in the cutting frame that
it goes down to, and the distance of the positions at which the part's height is measured."""
KEPT = "feature.allowance"
"""Key of an operation's choices: what its feature keeps on purpose, mm; an operation leaves it beside its own allowance."""
LAYER = "surface.layer"
"""Key of an operation's choices: height in mm of the steps that roughing leaves on slopes; where it is not said, its depth of cut."""
EXTENSION = "surface.extension"
"""Key of an operation's choices: how far in mm its passes run on past free rims."""
PAST_RIM = "surface.past_rim"
"""Key of an operation's choices: how far in mm what it finishes of floors goes on past what hangs over them."""
OVERHANG = "surface.overhang"
"""Key of an operation's choices: how thick in mm material stays on faces that hang over, which necks and shanks keep off; where it is not
said, as much as earlier operations may leave."""
EARLIER = "surface.earlier"
"""Key of an operation's choices: the name of the cutter that finished its faces before."""
UPRIGHT_EARLIER = "surface.upright_earlier"
"""Key of an operation's choices: the name of the smallest upright cutter that finished its faces before; a leaning one cuts what that one
can't come to."""


def number(operation: Operation, key: str) -> float:
    """Return a choice of an operation that is a number; 0 where there is none."""
    value = operation.choices.get(key, 0.0)
    return float(value) if isinstance(value, (int, float)) else 0.0


def total_allowance(operation: Operation) -> float:
    """Return what an operation leaves on curved faces, mm: its allowance for later ones, and what its feature keeps."""
    return number(operation, ALLOWANCE) + number(operation, KEPT)
