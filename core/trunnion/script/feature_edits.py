"""Edits of features by a person: their faces, what they keep, demands on holes, groups of patches; recognition keeps them as well."""

from __future__ import annotations

from collections.abc import Iterable

from trunnion.pipeline.planning import face_edits, patches
from trunnion.pipeline.planning.allowances import with_feature_allowance
from trunnion.pipeline.planning.hole_demands import with_hole_demand
from trunnion.plan.holes.demand import fit_demand, thread_demand
from trunnion.script.recording import recorded
from trunnion.script.state import ProgramState

RECOGNIZED = "recognize"
"""The step that features are there after."""


class FeatureEdits(ProgramState):
    """Edits of what was recognised; each runs recognition first where that is stale. Faces are given by their numbers, from 1.

    All raise `BadInput` for a feature or a face that is not there, and for faces that can't be what is asked for.
    """

    @recorded
    def add_faces(self, feature: str, faces: Iterable[int]) -> None:
        """Add faces to a feature, taken from the ones that have them."""
        self.session = face_edits.with_faces(
            self.engine, self.run(RECOGNIZED), feature, tuple(faces)
        )

    @recorded
    def take_faces(self, feature: str, faces: Iterable[int]) -> None:
        """Take faces from a feature; they are in no feature then."""
        self.session = face_edits.with_faces_taken(
            self.engine, self.run(RECOGNIZED), feature, tuple(faces)
        )

    @recorded
    def merge(self, features: Iterable[str]) -> None:
        """Make one feature of several, with the name and the kind of the first."""
        self.session = face_edits.with_merged(self.engine, self.run(RECOGNIZED), tuple(features))

    @recorded
    def make_feature(self, kind: str, faces: Iterable[int]) -> None:
        """Make a feature of a kind of faces, taken from the features that have them."""
        self.session = face_edits.with_feature(
            self.engine, self.run(RECOGNIZED), kind, tuple(faces)
        )

    @recorded
    def keep(
        self, features: Iterable[str], *, walls: float | None = None, floors: float | None = None
    ) -> None:
        """Have features keep so many mm on their walls, and on floors or tops, when the program has run; 0 takes it away."""
        self.run(RECOGNIZED)
        self.session = with_feature_allowance(
            self.session, tuple(features), wall_allowance=walls, floor_allowance=floors
        )

    @recorded
    def demand_fit(self, holes: Iterable[str], fit: str) -> None:
        """Demand a fit of holes (`H7`, `+0.021/0`); an empty word takes the demand away."""
        self.session = with_hole_demand(
            self.engine, self.run(RECOGNIZED), tuple(holes), fit_demand(fit)
        )

    @recorded
    def demand_thread(self, holes: Iterable[str], thread: str, depth: float = 0.0) -> None:
        """Demand a thread in holes (`M6`, `1/4-20 UNC`), full down to a depth in mm, 0: as deep as may be; an empty word takes it away."""
        self.session = with_hole_demand(
            self.engine, self.run(RECOGNIZED), tuple(holes), thread_demand(thread, depth)
        )

    @recorded
    def move_faces(self, faces: Iterable[int], group: str = "") -> None:
        """Move patches of a curved part to a group, or to a new one where none is named."""
        self.session = patches.with_moved(self.engine, self.run(RECOGNIZED), tuple(faces), group)

    @recorded
    def set_local(self, groups: Iterable[str], local: bool = True) -> None:
        """Call groups of patches local features, or not."""
        self.session = patches.with_local(self.run(RECOGNIZED), tuple(groups), local)
