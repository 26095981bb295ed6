"""The protocol of a family of parts, and the queries of a part beside its face graph."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Protocol, runtime_checkable

from trunnion import registry
from trunnion.findings import BadCall
from trunnion.geometry.arrays import Floats, Ints
from trunnion.geometry.boundary import Boundary
from trunnion.geometry.facegraph import FaceGraph
from trunnion.geometry.frame import Frame
from trunnion.geometry.plane.region import Region
from trunnion.geometry.surface.curvature import FaceCurvature
from trunnion.model.feature import Feature, GeneralizedPocket, Recognition
from trunnion.model.session import SizeEntry
from trunnion.progress import Progress
from trunnion.registry import FAMILIES


class Slicer(Protocol):
    """Something that can be cut by planes; a part satisfies it, and so does a table of regions in a test."""

    def section(self, frame: Frame, z: float) -> Region:
        """Return the material that the plane `z` (mm) of a frame cuts, in the frame's xy.

        Raises `BadInput` or `ValueError` when the part can't be cut there.
        """
        ...


class Bounded(Protocol):
    """Something whose faces have boundaries and bends; a part satisfies it."""

    def boundary(self, parts: Callable[[Floats], Ints] | None) -> Boundary:
        """Return the boundary of every face: each edge cut into `parts(lengths)` pieces of equal length, or its exact extremes."""
        ...

    def bend(self, tag: int) -> FaceCurvature:
        """Return how a face bends."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class Suitability:
    """How well a kind of part fits a part: `score` from 0 (not at all) to 1, the share of the part's area that the kind would explain,
    and what was found, in figures, as the end of a sentence."""

    score: float
    explained: float
    reason: str

    def __post_init__(self) -> None:
        for name in ("score", "explained"):
            if not 0.0 <= getattr(self, name) <= 1.0:
                raise ValueError(f"{name} must be from 0 to 1, not {getattr(self, name)}")


class PartKind(Protocol):
    """A kind of part that can be distinguished from others before anything is recognised: the name it is registered under, and what a part
    of it is called, with its article ("a panel").

    A package adds one that no family serves through the entry points `trunnion.part_kinds`; every family is one too.
    """

    name: str
    noun: str

    def suits(self, graph: FaceGraph) -> Suitability:
        """Return how well the kind fits a part, from its face graph alone: in the part's coordinates, whatever its position and unit."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class LegendClass:
    """Features of a kind that legends count together: those whose `attribute` is true, or (empty) all that no other class has.

    `label` is what several of them are called. One of `colours` (`#rrggbb`) is that of all; with several each feature has one of its own of
    hues around theirs (`report.colour_choice`), and the first represents the class.
    """

    label: str
    colours: tuple[str, ...]
    attribute: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class FeatureKind:
    """A kind of features as people meet it: `name` in features and files, `label` in words ("open pocket"), `colour` (`#rrggbb`).

    `classes`, where features of the kind are distinguished, have the colours instead, and `heading` says what they are together. `pocket`
    gives the pocket paper's model of a feature of the kind, where it has one. `along_axes` are sizes taken along the axes of the part's
    file: they change when the part is turned, no other size does.
    """

    name: str
    label: str
    colour: str
    classes: tuple[LegendClass, ...] = ()
    heading: str = ""
    pocket: Callable[[Feature, Recognition], GeneralizedPocket] | None = None
    along_axes: tuple[str, ...] = ()

    def class_of(self, feature: Feature) -> LegendClass:
        """Return the class that a feature of the kind belongs to; the kind itself where it has no classes."""
        rest = LegendClass(label=self.label, colours=(self.colour,))
        for each in self.classes:
            if each.attribute and feature.attributes.get(each.attribute):
                return each
            if not each.attribute:
                rest = each
        return rest


class Family(PartKind, Protocol):
    """A kind of parts with features of its own: their kinds, its settings and its recogniser.

    A package adds one through the entry points `trunnion.families`.
    """

    kinds: tuple[FeatureKind, ...]
    settings: type

    def recognize(
        self, graph: FaceGraph, slicer: Any, settings: Any, progress: Progress
    ) -> Recognition:
        """Return the features of a part, given as a face graph and as a part to query (`Slicer`, `Bounded`).

        Every face is in a feature or in `unexplained`, with a finding that names it.

        Raises `Cancelled` when a person asked to stop.
        """
        ...


@runtime_checkable
class Measuring(Protocol):
    """A family whose features can be measured anew when a person has changed their faces."""

    settings: type

    def measured(
        self, found: Recognition, graph: FaceGraph, part: Any, settings: Any
    ) -> Recognition:
        """Return what was found with sizes and automatic attributes that fit the faces; what was set by hand stays."""
        ...


@runtime_checkable
class Describing(Protocol):
    """A family that can say what chosen faces are in a feature: a person may give its features of the kinds `describable` other faces."""

    settings: type
    describable: tuple[str, ...]

    def described(
        self, feature: Feature, found: Recognition, graph: FaceGraph, settings: Any
    ) -> Feature:
        """Return a feature, its kind and faces given, with the roles, sizes and automatic attributes that follow from these faces.

        `found` holds the other features. Raises `BadInput` where the faces can't be a feature of the kind.
        """
        ...


@runtime_checkable
class SizeMeasuring(Protocol):
    """A family that measures more of a part than its features' own sizes: what takes the part's exact surfaces, or two features."""

    def analysed(
        self, found: Recognition, graph: FaceGraph, part: Any, progress: Progress
    ) -> tuple[SizeEntry, ...]:
        """Return these sizes, ready for the size table.

        Raises `Cancelled` when a person asked to stop.
        """
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class Smallest:
    """A size of the part that is the smallest of a size of its features: `name` in the size table, `size` of features of some `kinds`."""

    name: str
    size: str
    kinds: tuple[str, ...]


@runtime_checkable
class Sharing(Protocol):
    """A family with kinds of features that share out faces: each face is in one of them at most, whoever put it there."""

    exclusive: tuple[str, ...]


@runtime_checkable
class Bounding(Protocol):
    """A family whose smallest sizes bound what cutters a part can be machined with: they are sizes of the part."""

    smallest: tuple[Smallest, ...]


@runtime_checkable
class FamilyBlank(Protocol):
    """A family whose parts are usually cut from another blank than a box: its kind, in the words of `blank.kind`."""

    blank: str


def usual_blank(family: str) -> str:
    """Return the kind of blank that parts of a family are usually cut from."""
    found = registered_family(family)
    return found.blank if isinstance(found, FamilyBlank) else "box"


def feature_kinds() -> dict[str, FeatureKind]:
    """Return the kinds of features of all registered families by name; raise `BadCall` where two declare one differently.

    Families share kinds such as holes: words and colours must agree. What only one says of a kind, the pocket paper's model or sizes along
    the axes of the file, counts for all.
    """
    found: dict[str, FeatureKind] = {}
    for family in registry.names(FAMILIES):
        for kind in registry.get(FAMILIES, family).kinds:
            before = found.setdefault(kind.name, kind)
            merged = _merged(before, kind)
            if merged is None:
                raise BadCall(
                    f"the family {family} declares the kind of features {kind.name} otherwise than another family: rename it"
                )
            found[kind.name] = merged
    return found


def _merged(a: FeatureKind, b: FeatureKind) -> FeatureKind | None:
    """Return what two families say of one kind together, None where they differ."""
    if a.pocket and b.pocket and a.pocket is not b.pocket:
        return None
    along = (*a.along_axes, *(s for s in b.along_axes if s not in a.along_axes))
    one, other = (replace(k, pocket=a.pocket or b.pocket, along_axes=along) for k in (a, b))
    return one if one == other else None


def sharing_families() -> tuple[str, ...]:
    """Return the registered families with kinds of features that share out faces."""
    return tuple(name for name in registry.names(FAMILIES) if exclusive_kinds(name))


def exclusive_kinds(family: str) -> tuple[str, ...]:
    """Return the kinds of features of a family that share out faces; none where the family has none or is not registered."""
    found = registered_family(family)
    return found.exclusive if isinstance(found, Sharing) else ()


def describable_kinds(family: str) -> tuple[str, ...]:
    """Return the kinds of features of a family that a person may give other faces; none where the family can't describe them."""
    found = registered_family(family)
    return found.describable if isinstance(found, Describing) else ()


def smallest_sizes(family: str) -> tuple[Smallest, ...]:
    """Return the sizes of the part that are the smallest of its features' by a family; none where it has none or is not registered."""
    found = registered_family(family)
    return found.smallest if isinstance(found, Bounding) else ()


def analysed_sizes(
    found: Recognition, graph: FaceGraph, part: Any, progress: Progress
) -> tuple[SizeEntry, ...]:
    """Return the sizes that a part's family measures besides those of its features; none where it has none or is not registered."""
    family = registered_family(found.family)
    return (
        family.analysed(found, graph, part, progress) if isinstance(family, SizeMeasuring) else ()
    )


def registered_family(family: str) -> Any:
    """Return the family that is registered under a name, None where there is none."""
    return registry.get(FAMILIES, family)() if family in registry.names(FAMILIES) else None
