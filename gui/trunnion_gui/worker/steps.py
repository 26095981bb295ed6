"""The steps of the work as the window shows them: which panel runs which steps of the pipeline."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

STEPS = ("recognize", "size", "blank", "route", "optimize", "toolpath", "verify", "repair")
"""The pipeline's steps in order (the window's process does not import the pipeline; a test compares)."""

TITLES = {
    "recognize": "Recognize",
    "size": "Size analysis",
    "blank": "Blank",
    "route": "Process route",
    "optimize": "Optimize",
    "toolpath": "Toolpaths",
    "verify": "Verify and post",
    "repair": "Repair",
}
"""What a person calls each step; the pipeline's own titles."""

SHARES = {
    "recognize": 0.08,
    "size": 0.02,
    "blank": 0.02,
    "route": 0.08,
    "optimize": 0.05,
    "toolpath": 0.35,
    "verify": 0.35,
    "repair": 0.05,
}
"""About which share of a whole run each step takes, for the progress bar."""

_WORST = ("problem", "running", "stale", "empty", "done")


@dataclass(frozen=True, slots=True)
class PanelStage:
    """One foldout panel: its name, title and the steps it represents."""

    name: str
    title: str
    steps: tuple[str, ...]


STAGES = (
    PanelStage("recognize", "Recognize", ("recognize",)),
    PanelStage("size", "Size analysis", ("size",)),
    PanelStage("blank", "Blank", ("blank",)),
    PanelStage("route", "Process route", ("route",)),
    PanelStage("optimize", "Optimize", ("optimize",)),
    PanelStage("generate", "Generate", ("toolpath", "verify", "repair")),
)


def until(step: str) -> tuple[str, ...]:
    """Return the steps up to and including one."""
    return STEPS[: STEPS.index(step) + 1]


def share(step: str, steps: Sequence[str]) -> tuple[float, float]:
    """Return from where to where a step fills the bar of a run of some steps."""
    total = sum(SHARES[s] for s in steps)
    before = sum(SHARES[s] for s in steps[: list(steps).index(step)])
    return before / total, (before + SHARES[step]) / total


def joined_state(states: Mapping[str, str], steps: Sequence[str]) -> str:
    """Return the state of a panel that represents several steps: the one that needs most attention."""
    own = [states.get(s, "empty") for s in steps]
    if "done" in own and "empty" in own:
        return "stale" if "problem" not in own else "problem"
    return min(own, key=_WORST.index)
