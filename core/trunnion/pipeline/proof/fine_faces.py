"""Scallops, gouges and steps on chosen faces, measured to a fifth of a micron on the programs of all setups together."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from trunnion.findings import BadCall
from trunnion.geometry.arrays import Floats
from trunnion.geometry.frame import Frame
from trunnion.model.motion.program import Program, ProgramSection
from trunnion.model.session import Session
from trunnion.pipeline.engine import Engine
from trunnion.pipeline.proof.posted_programs import read_back
from trunnion.progress import NO_PROGRESS, Progress


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FineResult:
    """What was measured on faces (tags): heights in mm, and where in the part's coordinates (3,), NaN where nothing is.

    scallop: the highest ridge; gouge: the deepest cut; step: the largest difference where two operations or faces meet. lower: the
    operation on the step's lower side, or nothing. bound: how far scallop and gouge may be from the truth.
    """

    faces: tuple[int, ...]
    scallop: float
    scallop_at: Floats
    gouge: float
    gouge_at: Floats
    step: float
    step_at: Floats
    lower: str
    bound: float


def faces_named(text: str) -> tuple[int, ...]:
    """Return the face tags that a text names, as in `face 12, face 13` or `12 13`."""
    words = [w for w in re.split(r"[,;\s]+", text.strip()) if w not in ("", "face", "faces")]
    if not words or not all(w.isdigit() and int(w) > 0 for w in words):
        raise BadCall(f"--fine {text!r}: name faces by their tags, as in: face 12, face 13")
    return tuple(dict.fromkeys(int(w) for w in words))


def measure_fine(
    engine: Engine,
    session: Session,
    faces: Sequence[int],
    spacing: float,
    progress: Progress = NO_PROGRESS,
) -> FineResult:
    """Return what the posted programs of a session leave on faces; `spacing` mm is how far apart it begins to look."""
    from trunnion.part.shape.exact import ExactFace
    from trunnion.verify.finish.fine_mode import fine_measure
    from trunnion.verify.motion import moves_of

    if not session.posted:
        raise BadCall("no programs yet: prove them first")
    machines = engine.context_of(session).shop.machines
    programs = progress.aside(
        lambda _: read_back(session, session.posted, machines), "reading the text back"
    )
    if not any(p.sections for p in programs):
        raise BadCall("the programs cut nothing: there is nothing to measure")
    home = programs[0].setup.frame
    sections = [s for p in programs for s in _seen_from(p, home)]
    moves = moves_of(sections)
    found = fine_measure(
        [ExactFace(engine.context_of(session).part, tag, home) for tag in faces],
        moves,
        spacing,
        progress=progress,
    )
    lower = sections[int(moves.section[found.step.move])].operation if found.step.move >= 0 else ""
    return FineResult(
        faces=tuple(faces),
        scallop=found.scallop.value,
        scallop_at=home.to_world(found.scallop.position),
        gouge=found.gouge.value,
        gouge_at=home.to_world(found.gouge.position),
        step=found.step.value,
        step_at=home.to_world(found.step.position),
        lower=lower,
        bound=found.bound,
    )


def _seen_from(program: Program, home: Frame) -> tuple[ProgramSection, ...]:
    """Return a program's sections as they are in another frame."""
    own = program.setup.frame
    if own is home:
        return program.sections
    return tuple(
        replace(
            s,
            path=replace(
                s.path,
                position=home.to_local(own.to_world(s.path.position)),
                axis=_unit(home.local_direction(own.world_direction(s.path.axis))),
                centre=home.to_local(own.to_world(s.path.centre)),
            ),
        )
        for s in program.sections
    )


def _unit(axes: Floats) -> Floats:
    return np.asarray(axes / np.linalg.norm(axes, axis=1, keepdims=True))


def fine_dict(found: FineResult) -> dict[str, object]:
    """Return the figures as JSON data."""

    def position(at: Floats) -> list[float] | None:
        return [float(v) + 0.0 for v in at] if np.isfinite(at).all() else None

    return {
        "faces": [f"face {tag}" for tag in found.faces],
        "bound_mm": found.bound,
        "scallop_mm": found.scallop,
        "scallop_at": position(found.scallop_at),
        "gouge_mm": found.gouge,
        "gouge_at": position(found.gouge_at),
        "step_mm": found.step,
        "step_at": position(found.step_at),
        "step_below": found.lower,
    }


def fine_text(found: FineResult) -> str:
    """Return the figures in a few lines."""

    def line(name: str, value: float, at: Floats) -> str:
        where = (
            " at x {:.3f} y {:.3f} z {:.3f}".format(*(float(v) + 0.0 for v in at))
            if value and np.isfinite(at).all()
            else ""
        )
        return f"{name:<18} {value:.4f} mm{where}"

    return "\n".join(
        [
            f"fine, on {', '.join(f'face {tag}' for tag in found.faces)}, within {1000 * found.bound:g} um",
            line("  highest scallop", found.scallop, found.scallop_at),
            line("  deepest gouge", found.gouge, found.gouge_at),
            line("  largest step", found.step, found.step_at),
        ]
    )
