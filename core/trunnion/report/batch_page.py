"""The page of a batch: a table of its parts with verdicts and pictures, how many are released, and why the others are not."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from urllib.parse import quote

from trunnion.model.part_result import PartResult
from trunnion.report.html import duration, share
from trunnion_resources import folder as resource_folder


@dataclass(frozen=True, slots=True, kw_only=True)
class Rejection:
    """Why parts are not released: a finding's code or what is in the place of a verdict, how often it was found, and in which parts."""

    code: str
    n_findings: int
    parts: tuple[PartResult, ...]


def batch_page(results: Sequence[PartResult], n_parts: int) -> str:
    """Return the page of the parts that are done, of `n_parts` in all; files are linked below the page's folder."""
    from jinja2 import Environment, StrictUndefined

    template = (resource_folder("report") / "batch.html").read_text(encoding="utf-8")
    page = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    ).from_string(template)
    return page.render(
        results=results,
        n_parts=n_parts,
        released=sum(r.is_released for r in results),
        verdicts=sorted(Counter(r.verdict for r in results).items()),
        reasons=rejections(results),
        machining=sum(r.machining_time_s or 0.0 for r in results if r.is_released),
        duration=duration,
        share=share,
        link=link,
    )


def rejections(results: Sequence[PartResult]) -> tuple[Rejection, ...]:
    """Return the reasons of parts that are not released, those of most parts first, then by code."""
    counts, parts = Counter[str](), dict[str, list[PartResult]]()
    for result in results:
        if result.is_released:
            continue
        for code, n in (result.reasons or {result.verdict: 1}).items():
            counts[code] += n
            parts.setdefault(code, []).append(result)
    made = (
        Rejection(code=code, n_findings=counts[code], parts=tuple(found))
        for code, found in parts.items()
    )
    return tuple(sorted(made, key=lambda r: (-len(r.parts), r.code)))


def link(result: PartResult, file: str) -> str:
    """Return the address of a part's file from the page's folder.

    >>> link(PartResult(part="a b.step", folder="a b", verdict="passed"), "a b.report.html")
    'a%20b/a%20b.report.html'
    """
    return quote(str(PurePosixPath(result.folder, file)))
