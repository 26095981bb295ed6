"""`trunnion info`: what is in a part file, without recognising anything."""

from __future__ import annotations

import argparse
from typing import Any

from trunnion.cli.common import exit_code, open_session, part_command, show_findings, show_json


def add(commands: Any) -> None:
    """Add the command to the command line."""
    part_command(commands, "info", "what is in a part file").set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the part's facts."""
    _, session = open_session(options, None)
    part = session.part
    assert part is not None
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
    show_findings(options, part.findings)
    return exit_code(part.findings)
