"""The context a session is worked on at: what a step needs that is not plain data (the CAD part) or not the session's own (the shop)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from trunnion import tolerance
from trunnion.findings import OutOfMemory
from trunnion.geometry.arrays import Floats
from trunnion.geometry.cut import Cut
from trunnion.geometry.frame import WORLD, Frame
from trunnion.geometry.sheet.skin import Skin
from trunnion.model.session import PartInfo
from trunnion.pipeline.planning.open_faces import OpenSettings, with_backing
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import choose, digest
from trunnion.shop import Shop
from trunnion.shop.library import PlanLibrary

if TYPE_CHECKING:
    from trunnion.part.part import Part


COARSER = 4.0
"""How many times the chord error of a part is that has too many triangles: a tenth of `tolerance.GOUGE` still, for finishing."""
DECIMALS = 7
"""Decimals of a box in mm: ten times finer than two points are distinguished."""


@dataclass(frozen=True)
class Context:
    """The part that a session programs, the shop it is programmed for and its plan library, where there is one."""

    part: Part
    shop: Shop
    library: PlanLibrary | None = None
    _skins: dict[float, Skin] = field(default_factory=dict, init=False, repr=False, compare=False)
    _machined: dict[str, Context] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    @cached_property
    def facts(self) -> PartInfo:
        """What a session keeps of the part."""
        p = self.part
        return PartInfo(
            path=str(p.path),
            name=p.name,
            digest=p.digest,
            unit=p.unit,
            n_faces=p.n_faces,
            n_solids=p.n_solids,
            solid=p.solid,
            area=p.area,
            volume=p.volume,
            low=p.low,
            high=p.high,
            findings=tuple(p.findings),
        )

    def machined(self, choices: Mapping[str, Any], progress: Progress = NO_PROGRESS) -> Context:
        """Return the context that a part is planned and proven in: of faces that enclose no material, that of them with their backing.

        Raises `BadInput` when no backing can be made; the one made last is kept.
        """
        if self.part.is_closed:
            return self
        key = digest(choose(OpenSettings, choices))
        if key not in self._machined:
            made = Context(with_backing(self.part, choices, progress), self.shop, self.library)
            self._machined.clear()
            self._machined[key] = made
        return self._machined[key]

    def in_shop(self, shop: Shop) -> Context:
        """Return the context of the same part in another shop, with the skins that were made."""
        made = Context(self.part, shop, self.library)
        made._skins.update(self._skins)
        return made

    def skin(self, chord: float = tolerance.SKIN_CHORD, progress: Progress = NO_PROGRESS) -> Skin:
        """Return the part's skin in its own coordinates within a chord error (mm), as fine as finishing needs it unless said; kept.

        A part of too many triangles for that is taken `COARSER` times as coarse; raises `OutOfMemory` where that is too fine as well.
        """
        if chord not in self._skins:
            from trunnion.part.shape.skin import skin_of

            try:
                self._skins[chord] = skin_of(self.part, WORLD, chord, progress)
            except OutOfMemory:
                self._skins[chord] = skin_of(self.part, WORLD, COARSER * chord, progress)
        return self._skins[chord]

    def box(self, frame: Frame) -> tuple[Floats, Floats]:
        """Return the part's box (low, high) in a frame."""
        low, high = self.part.box(frame)
        # What is computed from a turned part carries noise far below any meaning; a programmer should not see it in a work offset.
        return np.round(low, DECIMALS), np.round(high, DECIMALS)


class Contexts:
    """The contexts of one part file: of the part as read, and of what is left of it after cuts, each made once."""

    def __init__(self, part: Part, shop: Shop, library: PlanLibrary | None = None) -> None:
        self._made: dict[tuple[Cut, ...], Context] = {(): Context(part, shop, library)}

    def use_shop(self, shop: Shop) -> None:
        """Program the parts for another shop from now on."""
        self._made = {cuts: context.in_shop(shop) for cuts, context in self._made.items()}

    def after(self, cuts: tuple[Cut, ...], progress: Progress = NO_PROGRESS) -> Context:
        """Return the context of the part after some cuts; raise `BadInput` when one of them can't be made."""
        if cuts not in self._made:
            before = self.after(cuts[:-1], progress)
            progress.at(0.0, f"cutting face {cuts[-1].face}")
            from trunnion.part.cut import divided

            self._made[cuts] = Context(divided(before.part, cuts[-1]), before.shop, before.library)
        return self._made[cuts]
