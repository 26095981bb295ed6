"""Colours as data: the same in window, report and pictures."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass

from trunnion.findings import BadInput
from trunnion_resources import folder

Colour = tuple[int, int, int]


@dataclass(frozen=True, kw_only=True)
class Palette:
    """Colours of feature kinds and of motions, and the map of deviations with its limit in mm."""

    kinds: dict[str, Colour]
    motions: dict[str, Colour]
    deviation_map: str
    deviation_limit: float

    def kind(self, name: str) -> Colour:
        """Return the colour of a feature kind; kinds without one of their own share that of `other`."""
        return self.kinds.get(name, self.kinds["other"])

    def motion(self, name: str) -> Colour:
        """Return the colour of a kind of motion."""
        return self.motions[name]


def load_palette() -> Palette:
    """Return the palette that is shipped; raise `BadInput` when a colour is not written as `#rrggbb`."""
    data = tomllib.loads((folder("palette") / "palette.toml").read_text(encoding="utf-8"))
    kinds, motions = ({k: _colour(k, v) for k, v in data[table].items()} for table in ("kinds", "motions"))
    return Palette(kinds=kinds, motions=motions, deviation_map=data["deviation"]["map"], deviation_limit=float(data["deviation"]["limit"]))


def _colour(name: str, text: str) -> Colour:
    if len(text) != 7 or not text.startswith("#"):
        raise BadInput(f"palette: the colour of {name} must be written #rrggbb, not {text}")
    return int(text[1:3], 16), int(text[3:5], 16), int(text[5:7], 16)
