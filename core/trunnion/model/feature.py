"""Machining features: what a recogniser found, by face tag only, never by copied geometry."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from trunnion.findings import ADDED_UNWRITTEN, Finding
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.frame import WORLD, Frame
from trunnion.settings import added

Size = float | int | bool | str | tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class FaceRole:
    """One face of a feature: its 1-based tag and the role it plays (words: `docs/words.md`)."""

    role: str
    face: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Feature:
    """One machining feature.

    `sizes` are mm and degrees in the recognition's frame; `attributes` carry `nested_in`, `in`, `through`, `direction`, ...
    `by_hand` is set when a person made or changed it: a re-run keeps it.
    """

    id: str
    kind: str
    faces: tuple[FaceRole, ...]
    sizes: Mapping[str, Size] = field(default_factory=dict)
    attributes: Mapping[str, Size] = field(default_factory=dict)
    by_hand: bool = False

    def with_role(self, *roles: str) -> tuple[int, ...]:
        """Return the tags of the faces that play one of the roles, in order."""
        return tuple(f.face for f in self.faces if f.role in roles)

    @property
    def tags(self) -> tuple[int, ...]:
        """The tags of all faces, in order."""
        return tuple(f.face for f in self.faces)

    def as_dict(self) -> dict[str, Any]:
        """Return the feature as the JSON that other programs rely on."""
        sizes = {k: list(v) if isinstance(v, tuple) else v for k, v in self.sizes.items()}
        extra = {k: list(v) if isinstance(v, tuple) else v for k, v in self.attributes.items()}
        return {
            "id": self.id,
            "kind": self.kind,
            "faces": [{"role": f.role, "face": f.face} for f in self.faces],
            "sizes": sizes,
            **extra,
        }


@dataclass(frozen=True, slots=True, kw_only=True)
class GeneralizedPocket:
    """A pocket in the words of "Slicing Recognition of Aircraft Integral Panel Generalized Pocket" (2.2).

    `identification` says what pocket it is; `centre` has two or three coordinates in mm, or none; `top` and `bottom` are heights in mm;
    `guide` are the faces that the guide profile's lines lie on, with their roles; `islands` and `auxiliary` are other features.
    """

    identification: str
    through: bool
    centre: tuple[float, ...] = ()
    top: float | None = None
    bottom: float | None = None
    guide: tuple[FaceRole, ...] = ()
    islands: tuple[Feature, ...] = ()
    auxiliary: tuple[Feature, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class TakenFor:
    """What kind of part a part was taken for: the kind's name and what its parts are called ("a panel"), how sure (0 to 1) and why."""

    kind: str
    noun: str
    score: float
    reason: str

    def as_dict(self) -> dict[str, Any]:
        """Return it as the JSON that other programs rely on."""
        return {"kind": self.kind, "score": self.score, "reason": self.reason}

    def __str__(self) -> str:
        return f"{self.noun} ({self.score:.2f}): {self.reason}"


@dataclass(frozen=True, kw_only=True)
class Recognition:
    """What a family found on a part: the frame it chose, features, and the faces that nothing explains (tags).

    `face_area` (n_faces,) float64, mm2, is the area of every face of the part in the order of the tags; empty where it is not known, as in
    features read from XML. `unexplained_share` is the unexplained faces' share of it. `taken_for` is the kind of part it was taken for;
    `doubt`, when not empty, the line that the steps after recognition refuse with until a person has chosen a family. `removed` has the
    faces of each feature that a person deleted: a re-run does not take up again what claims most of them. `retired` are the names of
    features that a person emptied or deleted: no other feature gets one of them. `neighbours` (k, 2) are the pairs of tags of faces with a
    common edge, None where they are not known.
    """

    family: str
    frame: Frame = WORLD
    features: tuple[Feature, ...] = ()
    unexplained: tuple[int, ...] = ()
    unexplained_share: float = 0.0
    face_area: Floats = field(default_factory=lambda: np.zeros(0), compare=False)
    findings: tuple[Finding, ...] = ()
    removed: tuple[tuple[int, ...], ...] = ()
    taken_for: TakenFor | None = None
    doubt: str = ""
    retired: tuple[str, ...] = added((), written=False)
    neighbours: Ints | None = field(default=None, compare=False, metadata=ADDED_UNWRITTEN)

    def of_kind(self, *kinds: str) -> tuple[Feature, ...]:
        """Return the features of some kinds, in order."""
        return tuple(f for f in self.features if f.kind in kinds)

    @property
    def dropped(self) -> tuple[int, ...]:
        """The tags that recognition itself put in no feature; faces of features that a person deleted are not among them."""
        deleted = {tag for tags in self.removed for tag in tags}
        return tuple(tag for tag in self.unexplained if tag not in deleted)

    def __iter__(self) -> Iterator[Feature]:
        return iter(self.features)

    def feature(self, id: str) -> Feature:
        """Return the feature with an id; raise `KeyError` when there is none."""
        for f in self.features:
            if f.id == id:
                return f
        raise KeyError(id)

    def without(self, id: str) -> Recognition:
        """Return the recognition after a person deleted a feature; faces that no other feature has become unexplained."""
        gone = self.feature(id)
        kept = tuple(f for f in self.features if f.id != id)
        loose = {*self.unexplained, *gone.tags} - {tag for f in kept for tag in f.tags}
        return replace(
            self.with_unexplained(loose),
            features=kept,
            removed=(*self.removed, gone.tags),
            retired=(*self.retired, id),
        )

    def with_unexplained(self, tags: Iterable[int]) -> Recognition:
        """Return the recognition with these faces unexplained, and their share of the area as far as areas are known."""
        loose = tuple(sorted(tags))
        total = float(self.face_area.sum())
        share = (
            float(self.face_area[np.array(loose, dtype=int) - 1].sum()) / total
            if total > 0.0
            else self.unexplained_share
        )
        return replace(self, unexplained=loose, unexplained_share=share)

    def counts(self) -> dict[str, int]:
        """Return the number of features of each kind, in order of appearance."""
        found: dict[str, int] = {}
        for f in self.features:
            found[f.kind] = found.get(f.kind, 0) + 1
        return found
