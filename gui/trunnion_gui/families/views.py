"""The views of all families in a window: which one presents what."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from PySide6.QtWidgets import QMenu, QWidget

from trunnion import registry
from trunnion.findings import BadCall
from trunnion.model.feature import Feature, Recognition
from trunnion_gui.document import Document
from trunnion_gui.face_edits import FaceEdits
from trunnion_gui.families.contract import FamilyView, FeatureClass
from trunnion_gui.guide_edits import GuideEdits


class Views:
    """One view for each family, by its name; families without one have a plain view."""

    def __init__(self, document: Document) -> None:
        """Make the registered views; raise `BadCall` when two present the same kind of feature."""
        self._plain = FamilyView(document)
        self.face_edits = FaceEdits(document)
        self.guide_edits = GuideEdits(document)
        self._by_name = {
            name: _view(name, document)
            for name in sorted({*registry.names("families"), *registry.names("views")})
        }
        self._by_kind: dict[str, FamilyView] = {}
        for view in self:
            for kind in view.kinds:
                other = self._by_kind.setdefault(kind, view)
                if other is not view:
                    raise BadCall(
                        f"the views of {other.name} and {view.name} both present the kind {kind}: take it out of one of them"
                    )

    def __iter__(self) -> Iterator[FamilyView]:
        return iter(self._by_name.values())

    def __getitem__(self, family: str) -> FamilyView:
        return self._by_name[family]

    def of(self, feature: Feature) -> FamilyView:
        """Return the view that presents a feature."""
        return self._by_kind.get(feature.kind, self._plain)

    def allowance_kinds(self, family: str) -> tuple[str, ...]:
        """Return the kinds of feature of a family that a person may have material left on."""
        return self._by_name.get(family, self._plain).allowance_kinds

    def present(self, found: Recognition | None) -> tuple[FamilyView, ...]:
        """Return the views of kinds that were found."""
        kinds = {f.kind for f in found or ()}
        return tuple(view for view in self if kinds & set(view.kinds))

    def headings(self, found: Recognition | None) -> tuple[str, str]:
        """Return the titles of the columns with a feature's id and its number of faces."""
        return next(iter((*self.present(found), self._plain))).headings()

    def classes(self, found: Recognition) -> Iterator[FeatureClass]:
        """Give the classes that features stand in, kind by kind."""
        for kind in found.counts():
            features = tuple(found.of_kind(kind))
            yield from self.of(features[0]).classes(kind, features)

    def remarks(self, found: Recognition) -> str:
        """Return what is reported after the counts of a recognition."""
        return "".join(view.remark(found) for view in self.present(found))

    def offers(self, group: str, found: Recognition | None) -> bool:
        """Return whether a group of settings may matter to a part: it isn't owned by families alone that the part has nothing of."""
        owners = [view for view in self if view.owns(group)]
        return (
            found is None
            or not owners
            or any(v.name == found.family or v in self._foreign(found) for v in owners)
        )

    def most_offered(self, groups: Sequence[str]) -> int:
        """Return how many of some groups of settings a part of one family is offered at most."""
        owners = [[view for view in self if view.owns(group)] for group in groups]
        return max(
            (sum(not own or view in own for own in owners) for view in self), default=len(groups)
        )

    def _foreign(self, found: Recognition) -> tuple[FamilyView, ...]:
        """Return the views of kinds that were found; a kind that the view's family shares with the part's own says nothing."""
        own = _declared(found.family)
        kinds = {f.kind for f in found}
        return tuple(v for v in self if kinds & set(v.kinds) - (own & _declared(v.name)))

    def face_menu(self, parent: QWidget, tags: tuple[int, ...], operation: str = "") -> QMenu:
        """Return what may be done with some faces; `operation` is the one that was selected before."""
        menu = QMenu(parent)
        self.guide_edits.add_face_entries(menu, tags, operation)
        self.face_edits.add_face_entries(menu, tags)
        for view in self:
            view.add_face_entries(menu, tags)
        return menu


def _declared(family: str) -> set[str]:
    """Return the kinds of features of a family, none where it is not registered."""
    known = family in registry.names("families")
    return {k.name for k in registry.get("families", family).kinds} if known else set()


def _view(name: str, document: Document) -> FamilyView:
    made: FamilyView = (
        registry.get("views", name) if name in registry.names("views") else FamilyView
    )(document)
    made.name = name
    return made
