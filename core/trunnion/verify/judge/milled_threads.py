"""Milled threads: what the motions of thread mills make of the bores that a thread is demanded in.

A thread mill is taken to cut no more than its core, so neither contact nor stock see its teeth. They are judged here, by the motions alone,
whole or as posts split them: every feed lies in a bore with a thread of its pitch, whose core was bored before. Where it runs round the
bore's axis with its teeth in the wall, it rises by the pitch a turn to the right (ISO 68-1 draws right-hand threads), in step with the
turns before it, and the last of the passes reaches the thread's major diameter. A groove is whole at every angle from half a pitch above
the lowest of the middles of the teeth on to half a pitch below the highest.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.findings import Finding, error, face_tags, warning
from trunnion.geometry.arrays import Floats
from trunnion.model.hole_demand import BoreDemand
from trunnion.model.motion.program import ProgramSection
from trunnion.model.tool import THREAD_MILL, Tool
from trunnion.model.tool.thread_mill import cuts_pitch, extra_depth, lowest_tooth, teeth_along
from trunnion.units import trimmed
from trunnion.verify.judge.locations import block_of, position_text
from trunnion.verify.judge.setups import SetupProof
from trunnion.verify.settings import ProofSettings

PITCH_WITHIN = 0.005
"""mm along the axis by which a helix may lie off that of its thread: a sixth of what grade 6 leaves the flanks of M3 (ISO 965-1), and far
more than the digits of a program."""
TURN_WITHIN = math.radians(0.5)
"""How much of a turn may be missing of a whole one, radians."""
PARALLEL = math.cos(tolerance.ANGLE)
"""Cosine of the largest angle between a tool's axis and a bore's."""
SAMPLES = 16
"""Positions along an arc that is looked at for its farthest distance from a bore's axis."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MillFeed:
    """A move of a thread mill in a bore's cylinder coordinates: at its start and its end the distance from the axis `radius` mm, the
    `angle` rad about it and the `height` mm along the way out, of the tool's tip, over where the bore begins.

    `farthest` mm is the largest distance on the way, `sweep` rad how far it turns about the axis (NaN where it does not run round it),
    `up` 1 where the tool's shank points out of the bore at its beginning and -1 at its far end, `removed` mm3 of stock by it.
    """

    proof: SetupProof
    section: ProgramSection
    tool: Tool
    row: int
    radius: tuple[float, float]
    angle: tuple[float, float]
    height: tuple[float, float]
    farthest: float
    sweep: float
    up: float
    removed: float

    @property
    def turns(self) -> bool:
        """Whether it runs round the axis, or along it."""
        return math.isfinite(self.sweep)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HelixRun:
    """Feeds that follow each other round a bore's axis, all at the same `radius` mm; `step` mm is how far they lie off a helix of the
    thread's pitch, at most, `sweep` rad how far they turn to the right."""

    feeds: tuple[MillFeed, ...]
    radius: float
    sweep: float
    step: float

    @property
    def is_whole_turn(self) -> bool:
        """Whether it goes round once at least."""
        return abs(self.sweep) >= math.tau - TURN_WITHIN

    def middles(self, pitch: float) -> tuple[float, float]:
        """Return the lowest and the highest of the middles of the teeth on the way, mm over where the bore begins."""
        tool, up = self.feeds[0].tool, self.feeds[0].up
        low, high = lowest_tooth(tool), lowest_tooth(tool) + (teeth_along(tool) - 1) * pitch
        ends = [h for f in self.feeds for h in f.height]
        teeth = sorted((up * low, up * high))
        return min(ends) + teeth[0], max(ends) + teeth[1]

    def phase(self, pitch: float) -> float:
        """Return where its groove crosses the angle 0, mm, which all turns of a thread have in common but for whole pitches."""
        first = self.feeds[0]
        middle = first.height[0] + first.up * lowest_tooth(first.tool)
        return middle - pitch * first.angle[0] / math.tau


def milled_threads(
    proofs: Sequence[SetupProof], demands: Sequence[BoreDemand], settings: ProofSettings
) -> tuple[list[Finding], dict[str, float]]:
    """Return errors on thread mills that cut no thread that is demanded, or not as it must be, and by feature how deep in mm a thread is
    full from where its bore begins."""
    found: list[Finding] = []
    threads = [d for d in demands if d.is_thread]
    by_bore: dict[int, list[MillFeed]] = defaultdict(list)
    for proof in proofs:
        for k, section in enumerate(proof.program.sections):
            tool = section.tool
            if isinstance(tool, Tool) and tool.form == THREAD_MILL:
                rows = np.flatnonzero((proof.moves.section == k) & ~proof.moves.rapid)
                found += _sorted_by_bore(proof, section, tool, rows.tolist(), threads, by_bore)
                found += _rapid_in_wall(proof, section, tool, k, threads, settings)
    best: dict[str, float] = {}
    for n, feeds in sorted(by_bore.items()):
        wrong, made = _judged(threads[n], feeds, settings)
        found += wrong
        if made > 0.0:
            best[threads[n].feature] = made
    return found, best


def _sorted_by_bore(
    proof: SetupProof,
    section: ProgramSection,
    tool: Tool,
    rows: Sequence[int],
    threads: Sequence[BoreDemand],
    by_bore: dict[int, list[MillFeed]],
) -> list[Finding]:
    """Add the feeds of a section to those of their bores; return an error on the first that is in no bore with a thread of the tool's
    pitch."""
    for row in rows:
        feeds = ((n, _feed_in(d, proof, section, tool, row)) for n, d in enumerate(threads))
        fitting = [
            (_beyond(feed, threads[n]), n, feed)
            for n, feed in feeds
            if feed is not None and cuts_pitch(tool, threads[n].pitch)
        ]
        if not fitting:
            return [_elsewhere(proof, section, tool, row, threads)]
        # Of two bores on one axis it is the one that the tool is in.
        _, n, feed = min(fitting, key=lambda one: one[:2])
        by_bore[n].append(feed)
    return []


def _rapid_in_wall(
    proof: SetupProof,
    section: ProgramSection,
    tool: Tool,
    k: int,
    threads: Sequence[BoreDemand],
    settings: ProofSettings,
) -> list[Finding]:
    """Return an error on the first rapid of a section, the k-th, that has its teeth in the wall of a bore with a thread."""
    for row in np.flatnonzero((proof.moves.section == k) & proof.moves.rapid).tolist():
        for bore in threads:
            move = _feed_in(bore, proof, section, tool, row)
            if move is None or _beyond(move, bore) > 0.0 or not _is_in_wall(move, bore, settings):
                continue
            return [
                _at(
                    move,
                    "verify.thread-radius",
                    f"{section.operation} moves at rapid with its teeth in the wall of {bore.feature}",
                    "bring it to the bore's axis at the feed before it is lifted",
                )
            ]
    return []


def _feed_in(
    bore: BoreDemand, proof: SetupProof, section: ProgramSection, tool: Tool, row: int
) -> MillFeed | None:
    """Return a feed as it is in a bore; None where the tool's axis is not along the bore's, or leaves its thread's cylinder."""
    moves, frame = proof.moves, proof.program.setup.frame
    up = float(frame.world_direction(moves.end_axis[row]) @ bore.out)
    before = float(frame.world_direction(moves.start_axis[row]) @ bore.out)
    along = up > PARALLEL or (bore.through and up < -PARALLEL)
    if not along or up * before < PARALLEL**2:
        return None
    ends = _in_bore(bore, frame.to_world(np.stack([moves.start[row], moves.end[row]])))
    radius = np.hypot(ends[:, 0], ends[:, 1])
    angle = np.arctan2(ends[:, 1], ends[:, 0])
    farthest, sweep = float(radius.max()), _turned(radius, angle)
    if moves.sweep[row] != 0.0:
        way = _in_bore(bore, frame.to_world(_on_arc(proof, row)))
        farthest = max(farthest, float(np.hypot(way[:, 0], way[:, 1]).max()))
        middle = _in_bore(bore, frame.to_world(moves.centre[row][None]))[0]
        is_round = np.hypot(middle[0], middle[1]) <= PITCH_WITHIN
        sweep = math.copysign(1.0, up) * float(moves.sweep[row]) if is_round else math.nan
    if farthest > 0.5 * bore.thread_diameter:
        return None
    return MillFeed(
        proof=proof,
        section=section,
        tool=tool,
        row=row,
        radius=(float(radius[0]), float(radius[1])),
        angle=(float(angle[0]), float(angle[1])),
        height=(float(ends[0, 2]), float(ends[1, 2])),
        farthest=farthest,
        sweep=sweep,
        up=math.copysign(1.0, up),
        removed=float(proof.stock.removed[row]),
    )


def _in_bore(bore: BoreDemand, points: Floats) -> Floats:
    """Return points (n, 3) of the part in a right-handed frame whose z is the way out of a bore, from where it begins."""
    least = int(np.argmin(np.abs(bore.out)))
    x = np.cross(np.eye(3)[least], bore.out)
    x /= np.linalg.norm(x)
    axes = np.stack([x, np.cross(bore.out, x), bore.out])
    return np.asarray((points - bore.start) @ axes.T)


def _on_arc(proof: SetupProof, row: int) -> Floats:
    """Return positions (`SAMPLES` + 1, 3) of the tip along an arc, in the setup's frame, all at one height along the axis."""
    moves = proof.moves
    axis, away = moves.end_axis[row], moves.start[row] - moves.centre[row]
    away = away - (away @ axis) * axis
    turned = float(moves.sweep[row]) * np.linspace(0.0, 1.0, SAMPLES + 1)[:, None]
    across = np.cross(axis, away)
    return np.asarray(moves.centre[row] + np.cos(turned) * away + np.sin(turned) * across)


def _turned(radius: Floats, angle: Floats) -> float:
    """Return how far a straight feed turns about the axis, NaN where it does not run round it: its ends are not as far from the axis, or
    its chord comes nearer to it than a program's arcs may be opened by."""
    sweep = math.remainder(float(angle[1] - angle[0]), math.tau)
    mean = 0.5 * float(radius.sum())
    is_round = abs(float(radius[1] - radius[0])) <= PITCH_WITHIN
    near = mean * (1.0 - math.cos(0.5 * sweep)) <= tolerance.GOUGE
    return sweep if is_round and near else math.nan


def _beyond(feed: MillFeed, bore: BoreDemand) -> float:
    """Return how far in mm the teeth are from a bore along its axis, 0 where they are in it."""
    top = feed.tool.flute_length
    low = min(feed.height) if feed.up > 0.0 else min(feed.height) - top
    high = max(feed.height) + (top if feed.up > 0.0 else 0.0)
    return max(low, -bore.depth - high, 0.0)


def _judged(
    bore: BoreDemand, feeds: Sequence[MillFeed], settings: ProofSettings
) -> tuple[list[Finding], float]:
    """Return the errors on what is milled in a bore, and how deep its thread is full."""
    # The bore's wall is at its own radius; a tool whose teeth stay inside of that cuts nothing.
    cutting = [
        f for f in feeds if _is_in_wall(f, bore, settings) and _beyond(f, bore) <= 0.5 * bore.pitch
    ]
    found = _too_wide(bore, cutting, settings) + _core(bore, feeds, settings)
    runs = list(_runs(bore, cutting))
    found += _off_pitch(bore, runs) or _out_of_step(bore, runs)
    if found or not runs:
        return found, 0.0
    whole = [r for r in runs if r.is_whole_turn]
    full = [r for r in whole if abs(r.radius - _target(bore, r)) <= settings.tolerance]
    if whole and not full:
        return [_too_small(bore, max(whole, key=lambda r: r.radius - _target(bore, r)))], 0.0
    return _depth(bore, full)


def _is_in_wall(feed: MillFeed, bore: BoreDemand, settings: ProofSettings) -> bool:
    """Return whether teeth go into a bore's wall, at some height."""
    return feed.farthest + feed.tool.radius > 0.5 * bore.diameter + settings.tolerance


def _target(bore: BoreDemand, run: HelixRun) -> float:
    """Return the radius in mm of a helix that makes a bore's thread with a run's tool."""
    return _full_radius(bore, run.feeds[0].tool)


def _full_radius(bore: BoreDemand, tool: Tool) -> float:
    return 0.5 * bore.thread_diameter + extra_depth(tool, bore.pitch) - tool.radius


def _runs(bore: BoreDemand, feeds: Iterable[MillFeed]) -> Iterator[HelixRun]:
    """Yield the runs of feeds that turn round a bore's axis one after the other, at the same distance from it."""
    run: list[MillFeed] = []
    for feed in feeds:
        if run and not _follows(run[-1], feed):
            yield _run(bore, run)
            run = []
        if feed.turns:
            run.append(feed)
    if run:
        yield _run(bore, run)


def _follows(before: MillFeed, feed: MillFeed) -> bool:
    return (
        feed.turns
        and feed.proof is before.proof
        and feed.section is before.section
        and feed.row == before.row + 1
        and abs(feed.radius[0] - before.radius[1]) <= PITCH_WITHIN
    )


def _run(bore: BoreDemand, feeds: Sequence[MillFeed]) -> HelixRun:
    sweep = np.cumsum([f.sweep for f in feeds])
    start = feeds[0].height[0]
    off = np.array([f.height[1] for f in feeds]) - start - bore.pitch * sweep / math.tau
    return HelixRun(
        feeds=tuple(feeds),
        radius=float(np.mean([r for f in feeds for r in f.radius])),
        sweep=float(sweep[-1]),
        step=float(np.abs(off).max()),
    )


def _too_wide(
    bore: BoreDemand, feeds: Sequence[MillFeed], settings: ProofSettings
) -> list[Finding]:
    """Return an error where teeth go farther out than the thread's major diameter."""
    over = [(f.farthest - _full_radius(bore, f.tool), k) for k, f in enumerate(feeds)]
    more, k = max(over, default=(0.0, 0))
    if more <= settings.tolerance:
        return []
    feed = feeds[k]
    return [
        _at(
            feed,
            "verify.thread-radius",
            f"{feed.section.operation} mills {bore.feature} {trimmed(more, 3)} mm deeper than the groove of {bore.words}",
            "mill it on the radius of the thread's major diameter less the tool's",
        )
    ]


def _too_small(bore: BoreDemand, run: HelixRun) -> Finding:
    feed, less = run.feeds[0], _target(bore, run) - run.radius
    return _at(
        feed,
        "verify.thread-radius",
        f"{feed.section.operation} leaves the groove of {bore.words} in {bore.feature} {trimmed(less, 3)} mm too shallow",
        "mill its last pass on the radius of the thread's major diameter less the tool's",
    )


def _off_pitch(bore: BoreDemand, runs: Sequence[HelixRun]) -> list[Finding]:
    """Return an error where feeds round the axis do not rise by the pitch a turn to the right."""
    wrong = next((r for r in runs if r.step > PITCH_WITHIN), None)
    if wrong is None:
        return []
    feed, last = wrong.feeds[0], wrong.feeds[-1]
    rise = last.height[1] - feed.height[0]
    turn = rise * math.tau / wrong.sweep if abs(wrong.sweep) > TURN_WITHIN else math.nan
    made = f"{trimmed(turn, 4)} mm a turn" if math.isfinite(turn) else "along the axis"
    hand = " to the left" if turn < 0.0 else ""
    return [
        _at(
            feed,
            "verify.thread-pitch",
            f"{feed.section.operation} mills {bore.feature} by {made}{hand}; {bore.words} has {trimmed(bore.pitch, 4)} mm to the right",
            "rise by the pitch a turn, anticlockwise seen from the spindle",
        )
    ]


def _out_of_step(bore: BoreDemand, runs: Sequence[HelixRun]) -> list[Finding]:
    """Return an error where turns cut another groove than the first."""
    if not runs:
        return []
    first = runs[0].phase(bore.pitch)
    for run in runs[1:]:
        off = math.remainder(run.phase(bore.pitch) - first, bore.pitch)
        if abs(off) > PITCH_WITHIN:
            feed = run.feeds[0]
            return [
                _at(
                    feed,
                    "verify.thread-pitch",
                    f"{feed.section.operation} mills {bore.feature} {trimmed(abs(off), 3)} mm beside the groove that is there",
                    "begin every turn in step: a pitch a turn from where the first began",
                )
            ]
    return []


def _core(bore: BoreDemand, feeds: Sequence[MillFeed], settings: ProofSettings) -> list[Finding]:
    """Return an error where the tool's core takes more off than a film on the wall: the bore is not there."""
    removed = sum(f.removed for f in feeds)
    if removed <= math.pi * bore.diameter * settings.tolerance * bore.depth:
        return []
    feed = max(feeds, key=lambda f: f.removed)
    return [
        _at(
            feed,
            "verify.thread-core",
            f"{feed.section.operation} mills the thread of {bore.feature}, whose core of D {trimmed(bore.diameter, 3)} is not bored: "
            f"{trimmed(removed, 1)} mm3 stand in it",
            "bore it to the thread's core, as deep as the thread mill goes, before its thread is milled",
        )
    ]


def _depth(bore: BoreDemand, runs: Sequence[HelixRun]) -> tuple[list[Finding], float]:
    """Return how deep a thread is full, mm, and a warning where it does not begin with its bore."""
    if not runs:
        return [], 0.0
    spans = sorted((r.middles(bore.pitch) for r in runs), key=lambda s: (-s[1], s[0]))
    high, low = spans[0][1], spans[0][0]
    for below, above in spans[1:]:
        if above < low - PITCH_WITHIN:
            break
        low = min(low, below)
    begins, made = -(high - 0.5 * bore.pitch), -(low + 0.5 * bore.pitch)
    found = []
    if begins > tolerance.SEW:
        found.append(
            warning(
                "verify.thread-depth",
                f"{bore.feature}: its thread {bore.words} begins {trimmed(begins, 2)} mm below where the bore does",
                bore.feature,
                *face_tags(bore.faces),
                remedy="go on round until the tool's teeth are half a pitch over the bore",
            )
        )
    return found, max(min(made, bore.depth), 0.0)


def _elsewhere(
    proof: SetupProof,
    section: ProgramSection,
    tool: Tool,
    row: int,
    threads: Sequence[BoreDemand],
) -> Finding:
    demanded = [
        d.words
        for d in threads
        if (feed := _feed_in(d, proof, section, tool, row)) is not None and _beyond(feed, d) <= 0.0
    ]
    return error(
        "verify.thread-elsewhere",
        f"{section.operation} mills a thread with {tool.name} at {position_text(proof.moves.end[row])}, where "
        f"{demanded[0] if demanded else 'no thread'} is demanded",
        section.operation,
        block_of(proof, section, row),
        remedy="mill only bores with a thread of the tool's pitch, or demand the thread of this bore",
    )


def _at(feed: MillFeed, code: str, words: str, remedy: str) -> Finding:
    where = block_of(feed.proof, feed.section, feed.row)
    return error(code, words, feed.section.operation, where, remedy=remedy)
