"""What kind of part a part is taken for, and the recognition as the family that serves the kind.

Left to itself (`recognize.family = auto`) recognition takes the best kind of all that are registered, says how sure it is and why, and
stops the steps after it where no family serves the kind or the family explains less than half of the part. A family that a person
chose is never stopped.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from trunnion import registry
from trunnion.findings import Finding, error, info, warning
from trunnion.geometry.facegraph import FaceGraph
from trunnion.model.feature import Recognition, TakenFor
from trunnion.model.session import Session
from trunnion.pipeline.context import Context
from trunnion.progress import Progress
from trunnion.recognize.contract import Suitability
from trunnion.registry import FAMILIES, PART_KINDS
from trunnion.settings import checked, choose, setting, settings
from trunnion.units import percent

AUTOMATIC = "auto"
ENOUGH = 0.5
"""Share of the area that recognition must explain, and score of a kind that no family serves, from which on it counts."""
SCORE_DECIMALS = 3
"""Scores that agree to so many decimals are equal: below that they are noise of the samples on curved faces."""


@settings("recognize")
class RecognizeSettings:
    """Which family of parts the recogniser looks for."""

    family: str = setting(
        AUTOMATIC,
        label="Family",
        help="Family of parts, or auto: the one that suits the part best. Where that explains "
        "less than half of the part, auto stops after recognition, a chosen family doesn't.",
        choices=(AUTOMATIC, *registry.names(FAMILIES)),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Rated:
    """A kind of part by its registered name, whether a family serves it, and how well it suits a part."""

    name: str
    kind: Any
    served: bool
    suits: Suitability

    @property
    def rank(self) -> tuple[float, float, bool, str]:
        """What better kinds have more of: score, explained area, a family that serves them, and at last the name, to be the same always."""
        return (
            round(self.suits.score, SCORE_DECIMALS),
            round(self.suits.explained, SCORE_DECIMALS),
            self.served,
            self.name,
        )

    def taken(self) -> TakenFor:
        """Return the kind as what a part is taken for."""
        return TakenFor(
            kind=self.name, noun=self.kind.noun, score=self.suits.score, reason=self.suits.reason
        )


def ratings(graph: FaceGraph) -> tuple[Rated, ...]:
    """Return all registered kinds of part with how well they suit a part, the best first. A kind that no family serves is among them when
    it is likely."""
    found = [
        Rated(
            name=name,
            kind=(kind := registry.get(group, name)()),
            served=group == FAMILIES,
            suits=kind.suits(graph),
        )
        for group in (FAMILIES, PART_KINDS)
        for name in registry.names(group)
    ]
    return tuple(
        sorted(
            (r for r in found if r.served or r.suits.score >= ENOUGH),
            key=lambda r: r.rank,
            reverse=True,
        )
    )


def recognised(session: Session, context: Context, progress: Progress) -> Recognition:
    """Return what is recognised on the part of a session as the chosen family, or as the one that suits it best.

    Raises `BadInput` when the family can't work on the part, `Cancelled` when a person asked to stop.
    """
    wanted = checked(choose(RecognizeSettings, session.choices)).family
    progress.at(0.0, "looking for the family")
    graph = context.part.graph()
    rated = progress.aside(lambda _: ratings(graph))
    best = (
        rated[0] if wanted == AUTOMATIC else next(r for r in rated if r.name == wanted and r.served)
    )
    unserved = () if rated[0].served else (_no_family(rated[0]),)
    if not best.served:
        return _nothing(best, context, unserved)
    settings = checked(choose(best.kind.settings, session.choices))
    found: Recognition = best.kind.recognize(graph, context.part, settings, progress)
    poor = _unexplained(best, found)
    if wanted == AUTOMATIC:
        return _stopped(
            replace(
                found, taken_for=best.taken(), findings=(*found.findings, _choice_finding(best))
            ),
            poor,
        )
    return replace(
        found,
        taken_for=best.taken(),
        findings=(*found.findings, *(_milder(f) for f in (*unserved, *poor))),
    )


def _nothing(best: Rated, context: Context, why: Sequence[Finding]) -> Recognition:
    """Return the recognition of a part that no family serves: every face unexplained."""
    found = Recognition(
        family=best.name,
        unexplained=tuple(context.part.tags),
        unexplained_share=1.0,
        taken_for=best.taken(),
        findings=(_choice_finding(best),),
    )
    return _stopped(found, why)


def _stopped(found: Recognition, why: Sequence[Finding]) -> Recognition:
    """Return a recognition that keeps the steps after it from going on for some reasons, as it was when there are none."""
    return replace(
        found,
        findings=(*found.findings, *why),
        doubt="; ".join(f"{f.text}: {f.remedy}" for f in why),
    )


def _choice_finding(best: Rated) -> Finding:
    return info("recognize.family", f"taken for {best.taken()}")


def _no_family(best: Rated) -> Finding:
    return error(
        "recognize.no-family",
        f"the part looks like {best.taken()}; no family of parts serves these yet",
        remedy=f"choose recognize.family = {' or '.join(registry.names(FAMILIES))} to go on with one of the families there are",
    )


def _unexplained(best: Rated, found: Recognition) -> tuple[Finding, ...]:
    """Return the finding that recognition explains less than half of the area, none when it explains more."""
    if found.unexplained_share <= ENOUGH:
        return ()
    others = [name for name in registry.names(FAMILIES) if name != best.name]
    instead = f", or {' or '.join(others)} to try another one" if others else ""
    return (
        error(
            "recognize.unexplained",
            f"{percent(found.unexplained_share)} of the area is explained by no feature; the part was taken "
            f"for {best.taken()}",
            remedy=f"choose recognize.family = {best.name} to go on with it{instead}",
        ),
    )


def _milder(finding: Finding) -> Finding:
    """Return an error as a warning, for a person who chose the family."""
    return warning(
        finding.code,
        finding.text,
        *finding.where,
        remedy="check what was recognised; the family was chosen by hand",
    )
