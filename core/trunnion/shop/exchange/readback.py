"""What a written file loses, found by reading it again: nothing is listed that comes back, and nothing that doesn't is left out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from trunnion.shop.cutters import Cutter
from trunnion.shop.exchange.assumptions import ToolResult
from trunnion.shop.exchange.contract import WHOLE_TOOL, Loss, LossKind
from trunnion.shop.exchange.fields import fields_of, is_same, plain


def lost(
    written: Sequence[Cutter],
    again: Sequence[ToolResult],
    title: str,
    reasons: Mapping[str, str] | None = None,
) -> Iterator[Loss]:
    """Yield the fields of written tools that reading them `again` doesn't give back as they were, or has to assume.

    `reasons` say why a field is lost, where it is not that the format (`title`) has no place for it.
    """
    for cutter, done in zip(written, again, strict=True):
        name = cutter.tool.name
        if done.cutter is None:
            why = f"what {title} can hold of it makes no tool: {done.why}"
            yield Loss(kind=LossKind.LOST, tool=name, field=WHOLE_TOOL, value="", why=why)
            continue
        assumed = {loss.field for loss in done.losses if loss.kind is LossKind.ASSUMED}
        theirs = fields_of(done.cutter)
        for field, value in fields_of(cutter).items():
            if field in assumed or not is_same(value, theirs.get(field)):
                why = (reasons or {}).get(field, f"{title} has no place for it")
                yield Loss(kind=LossKind.LOST, tool=name, field=field, value=plain(value), why=why)


def not_written(cutter: Cutter, why: str) -> Loss:
    """Return the loss of a tool that a format can't hold at all."""
    return Loss(kind=LossKind.OMITTED, tool=cutter.tool.name, field=WHOLE_TOOL, value="", why=why)
