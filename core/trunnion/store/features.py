"""The features XML: tags, roles and sizes, and each pocket in the pocket paper's words (`GeneralizedPocket`); no geometry is copied."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from lxml import etree

from trunnion.findings import BadCall
from trunnion.model.feature import Feature, GeneralizedPocket, Recognition
from trunnion.model.session import PartInfo, Session
from trunnion.recognize.contract import FeatureKind, feature_kinds
from trunnion.store import xml
from trunnion.store.atomic import write_bytes
from trunnion.store.pieces import (
    add,
    add_findings,
    add_frame,
    add_values,
    text_of,
)

FORMAT = 1


def write_features(session: Session, path: str | Path) -> None:
    """Write the features of a session as XML that fits the schema; raise `BadCall` while nothing is recognised."""
    if session.part is None or session.recognition is None:
        raise BadCall("no features yet: recognise first")
    write_bytes(path, features_xml(session.recognition, session.part))


def features_xml(recognition: Recognition, part: PartInfo) -> bytes:
    """Return the XML of what was recognised on a part."""
    root = etree.Element("features", version=str(FORMAT), family=recognition.family)
    add(
        root,
        "part",
        name=part.name,
        digest=part.digest,
        unit=part.unit,
        faces=str(part.n_faces),
        solid=str(part.solid),
    )
    _add_taken_for(root, recognition)
    add_frame(root, recognition.frame)
    kinds = feature_kinds()
    for feature in recognition.features:
        _add_feature(root, feature, recognition, kinds.get(feature.kind))
    unexplained = add(root, "unexplained", area_share=text_of(float(recognition.unexplained_share)))
    for tag in recognition.unexplained:
        add(unexplained, "face", tag=str(tag))
    for tags in recognition.removed:
        removed = add(root, "removed")
        for tag in tags:
            add(removed, "face", tag=str(tag))
    add_findings(root, recognition.findings)
    return xml.written(xml.validated(root, "features", "features"))


def _add_taken_for(root: Any, recognition: Recognition) -> None:
    """Add what kind of part it was taken for, and why the steps after recognition wait for a person, where that is known."""
    if (taken := recognition.taken_for) is not None:
        add(
            root,
            "taken-for",
            taken.reason,
            kind=taken.kind,
            noun=taken.noun,
            score=text_of(float(taken.score)),
        )
    if recognition.doubt:
        add(root, "doubt", recognition.doubt)


def _add_feature(
    root: Any, feature: Feature, recognition: Recognition, kind: FeatureKind | None
) -> None:
    element = add(
        root, "feature", id=feature.id, kind=feature.kind, by_hand=text_of(feature.by_hand)
    )
    for face in feature.faces:
        add(element, "face", tag=str(face.face), role=face.role)
    add_values(element, "size", "name", feature.sizes)
    add_values(element, "attribute", "name", feature.attributes)
    if kind is not None and kind.pocket is not None:
        _add_pocket(element, kind.pocket(feature, recognition))


def _add_pocket(element: Any, model: GeneralizedPocket) -> None:
    """Add the paper's model of a pocket: what it says comes from the feature's family."""
    pocket = add(
        element,
        "generalized-pocket",
        identification=model.identification,
        through=text_of(model.through),
    )
    if model.centre:
        add(
            pocket,
            "centre",
            **{axis: text_of(v) for axis, v in zip("xyz", model.centre, strict=False)},
        )
    for tag, z in (("top", model.top), ("bottom", model.bottom)):
        if z is not None:
            add(pocket, tag, z=text_of(z))
    guide = add(pocket, "guide-profile")
    for face in model.guide:
        add(guide, "guide-line", face=str(face.face), role=face.role)
    for other in (*model.islands, *model.auxiliary):
        tag = "island" if other in model.islands else "auxiliary"
        add(pocket, tag, feature=other.id, kind=other.kind)
