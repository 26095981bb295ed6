"""The report a person reads: verdict, figures, operations, tools, findings, with pictures, in one HTML file."""

from __future__ import annotations

import base64
import math
from collections.abc import Sequence
from pathlib import Path

from trunnion.model.operation import CuttingData, Operation
from trunnion.model.repair import words_of
from trunnion.model.session import Session
from trunnion.model.spindle import FeedMode, SpindleMode
from trunnion.plan.freeform.estimate.finishing_time import Estimate
from trunnion.plan.setups.flip import TURNED_OVER, turn_words
from trunnion.report.palette import load_palette
from trunnion.report.pictures import Picture
from trunnion.shop.crib import PlanTool, tools_listed
from trunnion.units import degrees, timed
from trunnion_resources import folder as resource_folder

ROUNDING = 1e-6
"""What sums of thousands of areas may be short of a whole, in hundredths of a per cent."""


def report_html(
    session: Session,
    name: str,
    pictures: Sequence[Picture],
    folder: Path,
    date: str = "",
    estimate: Estimate | None = None,
    tools: Sequence[PlanTool] = (),
) -> str:
    """Return the report of a session, the same bytes for the same session; the pictures are read from the folder and stand in the text.

    `estimate` has the times of areas that are finished and the gain of cutters of their own, where the plan has such areas; `tools` the
    tools of the plan with what the cribs have of them (none: the plan's alone).
    """
    from jinja2 import Environment, StrictUndefined

    template = (resource_folder("report") / "report.html").read_text(encoding="utf-8")
    page = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    ).from_string(template)
    shown = [
        (p.caption, base64.b64encode((folder / p.file).read_bytes()).decode("ascii"))
        for p in pictures
    ]
    verdict = session.verdict
    proofs = {p.operation: p for p in verdict.operations} if verdict else {}
    return page.render(
        name=name,
        date=date,
        session=session,
        pictures=shown,
        proofs=proofs,
        longest=max((p.time_s for p in proofs.values()), default=0.0),
        time_colours={
            k: "#{:02x}{:02x}{:02x}".format(*c) for k, c in load_palette().machine_time.items()
        },
        laid={p.operation: p.power for p in session.paths},
        duration=duration,
        share=share,
        degrees=degrees,
        residual_faces=residual_faces(session),
        spindle=spindle,
        feed=feed,
        estimate=estimate,
        fix_words=words_of,
        turns=turns(session),
        tools=tools or (tools_listed(session.process) if session.process else ()),
    )


def turns(session: Session) -> dict[str, str]:
    """Return for each setup after the first how the part is turned for it, by the setup's name: what the route says, else from frames."""
    if session.process is None:
        return {}
    notes = {f.where[0]: f.text for f in session.process.findings if f.code == TURNED_OVER}
    setups = session.process.setups
    return {s.name: notes.get(s.name) or turn_words(setups[0], s) for s in setups[1:]}


def spindle(operation: Operation) -> str:
    """Return a spindle speed as the setup sheet has it: 1/min, the constant surface speed and the highest, or the table's speed under a
    locked spindle."""
    data = operation.data
    if operation.tool.locked:
        return f"locked, table {data.spindle:.1f}"
    if data.spindle_mode is SpindleMode.RPM:
        return f"{data.spindle:.0f}"
    return f"{data.speed:.0f} m/min, at most {data.highest_spindle:.0f}"


def feed(data: CuttingData) -> str:
    """Return a feed as the setup sheet has it: in mm/min, or as programs give it."""
    return {
        FeedMode.MINUTE: f"{data.feed:.0f}",
        FeedMode.REVOLUTION: f"{data.feed_per_revolution:.3f} mm a revolution",
        FeedMode.INVERSE: f"{data.feed:.0f} in inverse time",
    }[data.feed_mode]


def duration(seconds: float) -> str:
    """Return a time in words: `1 h 02 min 05 s`."""
    return timed(float(round(seconds)))


def share(value: float) -> str:
    """Return a share as per cent with two decimals, never rounded up to a goal it does not reach."""
    return f"{math.floor(value * 10_000 + ROUNDING) / 100:.2f} %"


def residual_faces(session: Session) -> list[tuple[int, float, float, bool, bool]]:
    """Return the faces that are not finished whole: (tag, unfinished mm2, most material left mm, planned, reachable), most first."""
    if session.verdict is None:
        return []
    rows = [
        (f.face, f.area - f.finished, f.left_max, f.planned, f.reachable)
        for f in session.verdict.faces
        if not f.blank_surface and f.area - f.finished > 0.0
    ]
    return sorted(rows, key=lambda r: (-r[1], r[0]))
