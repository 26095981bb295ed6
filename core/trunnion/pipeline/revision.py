"""A part file that was revised, taken up by the session of the part before: what a person did is kept by matching faces.

Features keep their names where most of their faces have counterparts in one of the new ones; those made or changed by hand, cuts, settings
and operations that name faces, name the counterparts. What has none is told, never dropped in silence. Everything else is computed anew.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.findings import BadCall, BadInput, Finding, face_tags, info, warning
from trunnion.geometry.cut import Cut
from trunnion.geometry.face_matching import FaceMatch, matched_faces
from trunnion.model.feature import Feature, Recognition
from trunnion.model.operation import Operation
from trunnion.model.process import ProcessTree
from trunnion.model.session import Session, StepRecord
from trunnion.pipeline.planning.face_edits import described_anew
from trunnion.pipeline.planning.manual_edits import free_id
from trunnion.progress import NO_PROGRESS, Progress
from trunnion.settings import Value
from trunnion.store.project_file import PROJECT_SUFFIX

if TYPE_CHECKING:
    from trunnion.pipeline.engine import Engine

LEAST_SAME = 0.1
"""Share of a part's faces that are in its revision as they were; with less it is another part, or lies elsewhere."""
LEAST_OVERLAP = 0.5
"""Share of the faces of a feature, or of the new one, that they have in common where it keeps its name."""
_FACE = re.compile(r"\bface (\d+)\b")
"""How settings name a face."""
_NAME = re.compile(r"[A-Za-z_]+-\d+")
"""What may be the name of a feature in a text."""


def revised(
    engine: Engine, session: Session, path: str | Path, progress: Progress = NO_PROGRESS
) -> Session:
    """Return the session of a revised part file with what a person did to the one before: features, cuts, fixtures, settings and operations
    by hand; the engine goes on with the revised part.

    Its features are recognised; later steps are stale. Raises `BadInput` where the file can't be read or is another part; the engine keeps
    its part then.
    """
    path, progress = Path(path), progress.afresh()
    if session.part is None:
        raise BadCall("no part is open: open a STEP or IGES file first")
    if path.suffix.lower() == PROJECT_SUFFIX:
        raise BadInput(f"{path.name} is a project: give the revised part file itself")
    solid = session.part.solid if session.part.n_solids > 1 else None
    after = engine.beside()
    opened = after.open(path, solid=solid, progress=progress.part(0.0, 0.5))
    made = _carried_over(engine, session, after, opened, path, progress.part(0.5, 1.0))
    engine.take_over(after)
    return made


def _carried_over(
    before: Engine,
    session: Session,
    engine: Engine,
    opened: Session,
    path: Path,
    progress: Progress,
) -> Session:
    """Return the session of the revised part, as `opened` by an engine, with what a person did to the one that `session` is of."""
    made = replace(opened, choices=session.choices, fixtures=session.fixtures)
    made, lost_cuts = _with_cuts(before, session, engine, made, progress.part(0.0, 0.3))
    match = matched_faces(
        before.context_of(session).part.graph(), engine.context_of(made).part.graph()
    )
    same, n = int(match.same.sum()), len(match.same)
    if same < LEAST_SAME * n:
        raise BadInput(
            f"{path.name}: {same} of the {n} faces of the part before are in it as they were: it is another part, or lies elsewhere; "
            "open it by itself"
        )
    findings = [_counted(match, engine.context_of(made).part.n_faces), *lost_cuts]
    choices, lost = _choices_on(match, session.choices)
    findings += [
        warning(
            "revision.setting-lost",
            f"{key} named a face that the part has no more; it is back to its default",
            key,
            remedy="choose it again",
        )
        for key in lost
    ]
    made = replace(
        made,
        choices=choices,
        recognition=_recognition_on(match, session.recognition, findings),
        process=_process_on(match, session.process, findings),
        records={
            name: StepRecord(key="", seconds=record.seconds)
            for name, record in session.records.items()
        },
    )
    if made.recognition is not None:
        known_before = made.recognition
        made = engine.run(made, until="recognize", progress=progress.part(0.3, 1.0))
        made = _named_as_before(made, known_before)
        made = described_anew(engine, made, findings)
    assert made.part is not None
    part = replace(made.part, findings=(*made.part.findings, *findings))
    return replace(made, part=part)


def _with_cuts(
    before: Engine, session: Session, engine: Engine, made: Session, progress: Progress
) -> tuple[Session, list[Finding]]:
    """Return the session of the revised part with the cuts that can be made there too, and findings on the others."""
    cuts, lost = list[Cut](), list[Finding]()
    for n, cut in enumerate(session.cuts):
        progress.at(n / len(session.cuts), "cutting faces again")
        match = matched_faces(
            before.context_of(replace(session, cuts=session.cuts[:n])).part.graph(),
            engine.context_of(made).part.graph(),
        )
        face = match.of(cut.face)
        try:
            if not face:
                raise BadInput("the part has no such face any more")
            made = engine.with_cuts(made, (*cuts, replace(cut, face=face)))
        except BadInput as reason:
            lost.append(
                warning(
                    "revision.cut-lost",
                    f"the cut of face {cut.face} of the part before can't be made again: {reason}",
                    remedy="cut the face anew where it is wanted",
                )
            )
        else:
            cuts.append(replace(cut, face=face))
    return made, lost


def _counted(match: FaceMatch, n_faces: int) -> Finding:
    n, there = len(match.tags), int((match.tags > 0).sum())
    same = int(match.same.sum())
    return info(
        "revision.faces",
        f"of {n} faces of the part before {same} are as they were, {there - same} changed and {n - there} are gone; "
        f"{n_faces - there} are new",
        remedy="look at what is named beside this",
    )


def _choices_on(
    match: FaceMatch, choices: Mapping[str, Value]
) -> tuple[dict[str, Value], tuple[str, ...]]:
    """Return choices whose texts name the counterparts of faces, and the keys of those that named one which is gone."""
    kept, lost = dict[str, Value](), list[str]()
    for key, value in choices.items():
        named = [int(t) for t in _FACE.findall(value)] if isinstance(value, str) else []
        if not all(map(match.of, named)):
            lost.append(key)
        elif isinstance(value, str):
            kept[key] = _FACE.sub(lambda found: f"face {match.of(int(found.group(1)))}", value)
        else:
            kept[key] = value
    return kept, tuple(lost)


def _recognition_on(
    match: FaceMatch, found: Recognition | None, findings: list[Finding]
) -> Recognition | None:
    """Return the features of the part before with the counterparts of their faces; what a person made and is gone is told."""
    if found is None:
        return None
    features, gone = list[Feature](), list[str]()
    for f in found.features:
        faces = tuple(replace(r, face=match.of(r.face)) for r in f.faces if match.of(r.face))
        if faces or not f.by_hand:
            features.append(replace(f, faces=faces))
        else:
            gone.append(f.id)
        if f.by_hand and 0 < len(faces) < len(f.faces):
            findings.append(
                warning(
                    "revision.feature-faces",
                    f"{f.id}, made or changed by hand, has lost {len(f.faces) - len(faces)} of its {len(f.faces)} faces",
                    f.id,
                    *face_tags(r.face for r in faces),
                    remedy="add the faces that are there instead, or delete it",
                )
            )
    if gone:
        findings.append(
            warning(
                "revision.feature-lost",
                f"{', '.join(gone)}, made or changed by hand, had faces that the part has no more",
                *gone,
                remedy="make it anew where it is wanted",
            )
        )
    return replace(
        found,
        features=tuple(features),
        unexplained=match.all_of(found.unexplained),
        removed=tuple(tags for tags in map(match.all_of, found.removed) if tags),
        retired=(*found.retired, *gone),
        neighbours=None,
    )


def _process_on(
    match: FaceMatch, process: ProcessTree | None, findings: list[Finding]
) -> ProcessTree | None:
    """Return the process of the part before with the counterparts of its operations' faces, for a new route to take over what a person
    did."""
    if process is None:
        return None
    return replace(
        process, operations=tuple(_operation_on(match, o, findings) for o in process.operations)
    )


def _operation_on(match: FaceMatch, operation: Operation, findings: list[Finding]) -> Operation:
    faces = match.all_of(operation.faces)
    choices, lost = _choices_on(match, operation.choices)
    is_short = operation.own_faces and len(faces) < len(operation.faces)
    if is_short or (lost and operation.is_manual):
        findings.append(
            warning(
                "revision.operation-faces",
                f"{operation.id}: faces that a person chose for it are not there any more",
                operation.id,
                remedy="look at what leads it",
            )
        )
    return replace(
        operation,
        faces=faces,
        choices=choices,
        own_choices=tuple(k for k in operation.own_choices if k in choices),
        own_faces=operation.own_faces and bool(faces),
    )


def _named_as_before(session: Session, before: Recognition) -> Session:
    """Return the session whose recognised features have the names of those that they have most faces in common with."""
    found = session.recognition
    assert found is not None
    names = _names(before.features, found.features, {*found.retired})
    if all(id == name for id, name in names.items()):
        return session

    def in_new_names(words: str) -> str:
        return _NAME.sub(lambda name: names.get(name.group(), name.group()), words)

    features = tuple(
        replace(
            f,
            id=names[f.id],
            attributes={
                k: in_new_names(v) if isinstance(v, str) else v for k, v in f.attributes.items()
            },
        )
        for f in found.features
    )

    def renamed(notes: tuple[Finding, ...]) -> tuple[Finding, ...]:
        return tuple(
            replace(note, text=in_new_names(note.text), where=tuple(map(in_new_names, note.where)))
            for note in notes
        )

    record = session.records["recognize"]
    return replace(
        session,
        recognition=replace(found, features=_in_order(features), findings=renamed(found.findings)),
        records={
            **session.records,
            "recognize": replace(record, findings=renamed(record.findings)),
        },
    )


def _names(
    before: Sequence[Feature], found: Sequence[Feature], retired: set[str]
) -> dict[str, str]:
    """Return the name of each feature that was found, by the one it got: its counterpart's, else a free one that none had."""
    names = {f.id: f.id for f in found if f.by_hand}
    pairs = sorted(
        (
            (-_overlap(old, new), old.id, new.id)
            for new in found
            if not new.by_hand
            for old in before
            if old.kind == new.kind and not old.by_hand
        ),
    )
    spent = set(names.values())
    for overlap, old, new in pairs:
        if -overlap >= LEAST_OVERLAP and new not in names and old not in spent:
            names[new] = old
            spent.add(old)
    taken = spent | retired | {f.id for f in before}
    for f in found:
        if f.id not in names:
            names[f.id] = f.id if f.id not in taken else free_id(f.kind, taken)
            taken.add(names[f.id])
    return names


def _overlap(old: Feature, new: Feature) -> float:
    """Return the share of all faces of two features that both have."""
    a, b = set(old.tags), set(new.tags)
    return len(a & b) / len(a | b) if a or b else 0.0


def _in_order(features: Iterable[Feature]) -> tuple[Feature, ...]:
    """Return features kind by kind as they come, by name within a kind."""
    found = list(features)
    kinds = list(dict.fromkeys(f.kind for f in found))
    return tuple(sorted(found, key=lambda f: (kinds.index(f.kind), f.id)))
