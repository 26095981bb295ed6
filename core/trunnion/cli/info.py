"""`trunnion info`: what is in a part file, without recognising anything."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from trunnion.cli.common import (
    exit_code,
    open_session,
    part_command,
    show_findings,
    show_json,
    table,
)

if TYPE_CHECKING:
    from trunnion.model.dimension import Dimension
    from trunnion.pipeline.part_entities import FileEntities

MOST_FACES = 40
"""Faces whose entities are printed; JSON has all."""
MOST_DIMENSIONS = 40
"""Dimensions that are printed; JSON has all."""


def add(commands: Any) -> None:
    """Add the command to the command line."""
    part_command(commands, "info", "what is in a part file").set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the part's facts."""
    from trunnion.pipeline.part_entities import file_entities

    engine, session = open_session(options, None)
    part, listed = session.part, file_entities(engine, session)
    assert part is not None
    dimensions = engine.context_of(session).part.dimensions
    size = [float(h - l) for l, h in zip(part.low, part.high, strict=True)]
    if options.json:
        show_json(
            {
                "part": part.name,
                "digest": part.digest,
                "unit": part.unit,
                "faces": part.n_faces,
                "solids": part.n_solids,
                "solid": part.solid,
                "area": part.area,
                "volume": part.volume,
                "low": list(map(float, part.low)),
                "high": list(map(float, part.high)),
                "size": size,
                "entities": listed.as_dict() if listed else None,
                "dimensions": [asdict(d) for d in dimensions],
                "findings": [f.as_dict() for f in part.findings],
            }
        )
    else:
        print(
            f"{part.name}: {part.n_faces} faces, solid {part.solid} of {part.n_solids}, file in {part.unit}"
        )
        print(f"size    {size[0]:.3f} x {size[1]:.3f} x {size[2]:.3f} mm")
        print(f"area    {part.area:.1f} mm2")
        print(f"volume  {part.volume:.1f} mm3")
        print(f"digest  {part.digest}")
        if listed is not None:
            print(f"\n{entity_text(listed)}")
        if dimensions:
            print(f"\n{dimension_text(dimensions)}")
    show_findings(options, part.findings)
    return exit_code(part.findings)


def entity_text(listed: FileEntities) -> str:
    """Return the types of an IGES file's entities with their number, and the entity that each face comes from, as aligned text."""
    from trunnion.pipeline.part_entities import type_name

    types = [("entity", "", "n")]
    types += [(str(n), type_name(n), str(count)) for n, count in listed.counts().items()]
    faces = [("face", "entity and its parts, by lines of the directory")]
    faces += [(str(tag), listed.words(line)) for tag, line in listed.faces.items()][:MOST_FACES]
    more = len(listed.faces) - MOST_FACES
    rest = f"\nand {more} more faces: --json has all" if more > 0 else ""
    return f"{table(types, right=(0, 2))}\n\n{table(faces, right=(0,))}{rest}"


def dimension_text(dimensions: Sequence[Dimension]) -> str:
    """Return the sizes that a file gives as data, with their number, as aligned text."""
    count = len(dimensions)
    rows = [("size", "mm", "upper", "lower", "fit", "thread", "faces", "called")]
    rows += [
        (
            d.kind,
            f"{d.value:.7g}",
            _deviation(d.upper),
            _deviation(d.lower),
            d.fit,
            d.thread,
            " ".join(map(str, d.faces)),
            d.text,
        )
        for d in dimensions[:MOST_DIMENSIONS]
    ]
    head = "1 dimension" if count == 1 else f"{count} dimensions"
    more = count - MOST_DIMENSIONS
    rest = f"\nand {more} more: --json has all" if more > 0 else ""
    return f"{head}\n{table(rows, right=(1, 2, 3))}{rest}"


def _deviation(deviation: float | None) -> str:
    """Return a deviation (mm) with its sign, zero without one, and nothing where there is none."""
    if deviation is None:
        return ""
    return f"{deviation:+.6g}" if deviation else "0"
