"""Tool libraries of other programs on the disk: taken over into a shop's own folder, and written from the catalogue or a plan."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from trunnion.findings import BadInput
from trunnion.model.tool import Tool
from trunnion.shop.cutters import Cutter, load_cutters, load_holders
from trunnion.shop.exchange import ExchangeContext, Loss, LossKind, ReadTools, format_of
from trunnion.shop.exchange.catalogue_text import foreign_holders, holders_text, tools_text
from trunnion.shop.exchange.contract import WHOLE_TOOL
from trunnion.shop.exchange.numbering import FreeNames
from trunnion.shop.reading import SUFFIX
from trunnion.store.atomic import write_bytes, write_text
from trunnion.store.project import load_project

_NO_NUMBERS = "the catalogue has no numbers: a plan gives its tools theirs"
_NAMED = "the catalogue has another tool of its name"
_TURNING = "a turning tool: only rotating tools are exchanged"


@dataclass(frozen=True, slots=True, kw_only=True)
class ImportedTools:
    """What was taken over: the format it was in, the tools, the files written, and what was lost."""

    format: str
    cutters: tuple[Cutter, ...]
    text: str
    files: tuple[Path, ...]
    losses: tuple[Loss, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportedTools:
    """What was written: the format, the files, how many tools they hold, and what was lost."""

    format: str
    files: tuple[Path, ...]
    count: int
    losses: tuple[Loss, ...]


def exchange_context(
    user_folder: Path | None, *, unit: str = "mm", holder: str = ""
) -> ExchangeContext:
    """Return what a file may leave open, by the catalogue with a shop's own folder over it."""
    holders = load_holders(user_folder)
    cutters = load_cutters(holders, user_folder)
    return ExchangeContext(holders=holders, cutters=cutters, unit=unit, holder=holder)


def import_tools(
    path: Path, context: ExchangeContext, *, named: str = "", output: Path | None = None
) -> ImportedTools:
    """Read a library and write its tools as catalogue files: into the folders `tools` and `holders` of a shop's own, or into one file.

    Without an output nothing is written. Raises `BadInput` where a file would be written over.
    """
    form = format_of(path, named)
    found = form.read(path, context)
    cutters, renamed = _free_names(found.cutters, context.cutters)
    reported = (*_reported(found, cutters), *renamed, *_numbers(cutters))
    text = tools_text(cutters, reported, path.name)
    files = {} if output is None else _catalogue_files(output, path, text, cutters, context)
    for file in files:
        if file.exists():
            raise BadInput(f"{file}: is there already: remove it, or write to another file")
    for file, words in files.items():
        make_folder(file.parent)
        write_text(file, words)
    return ImportedTools(
        format=form.name, cutters=cutters, text=text, files=tuple(files), losses=reported
    )


def _catalogue_files(
    output: Path,
    source: Path,
    text: str,
    cutters: Sequence[Cutter],
    context: ExchangeContext,
) -> Mapping[Path, str]:
    holders = foreign_holders(cutters, context.holders)
    if output.suffix.lower() == SUFFIX:
        if holders:
            raise BadInput(
                f"{output}: {len(holders)} holders come with the tools and stand in a file of their own: give a folder"
            )
        return {output: text}
    files = {output / "tools" / f"{source.stem}{SUFFIX}": text}
    if holders:
        files[output / "holders" / f"{source.stem}{SUFFIX}"] = holders_text(holders, source.name)
    return files


def make_folder(folder: Path) -> None:
    """Make a folder with those above it where it is not there; raise `BadInput` where it can't be made."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as reason:
        raise BadInput(f"{folder}: can't be made: {reason.strerror or reason}") from None


def _free_names(
    cutters: Iterable[Cutter], known: Iterable[Cutter]
) -> tuple[tuple[Cutter, ...], tuple[Loss, ...]]:
    """Return cutters under names that the catalogue doesn't have, and which got another one."""
    names = FreeNames(c.tool.name for c in known)
    free, losses = [], []
    for cutter in cutters:
        name = names.take(cutter.tool.name)
        free.append(replace(cutter, tool=replace(cutter.tool, name=name)))
        if name != cutter.tool.name:
            losses.append(
                Loss(kind=LossKind.ASSUMED, tool=name, field="name", value=name, why=_NAMED)
            )
    return tuple(free), tuple(losses)


def _reported(found: ReadTools, cutters: Sequence[Cutter]) -> tuple[Loss, ...]:
    """Return the losses of a reading under the names that its tools have now."""
    names = {old.tool.name: new.tool.name for old, new in zip(found.cutters, cutters, strict=True)}
    return tuple(replace(loss, tool=names.get(loss.tool, loss.tool)) for loss in found.losses)


def _numbers(cutters: Iterable[Cutter]) -> tuple[Loss, ...]:
    return tuple(
        Loss(
            kind=LossKind.LOST,
            tool=c.tool.name,
            field="number",
            value=c.tool.number,
            why=_NO_NUMBERS,
        )
        for c in cutters
        if c.tool.number
    )


def export_tools(
    cutters: Sequence[Cutter],
    path: Path,
    context: ExchangeContext,
    *,
    named: str = "",
    losses: Sequence[Loss] = (),
) -> ExportedTools:
    """Write tools as a library of another program; `losses` came before. Raises `BadInput` where there is nothing to write."""
    form = format_of(path, named)
    if not cutters:
        raise BadInput(f"{path}: there is no tool to write")
    done = form.write(cutters, path, context)
    left = sum(1 for loss in done.losses if loss.kind is LossKind.OMITTED)
    if left == len(cutters):
        why = next(loss.why for loss in done.losses if loss.kind is LossKind.OMITTED)
        raise BadInput(f"{path}: none of the tools can be written: {why}")
    for file, data in done.files.items():
        write_bytes(file, data)
    return ExportedTools(
        format=form.name,
        files=tuple(done.files),
        count=len(cutters) - left,
        losses=(*losses, *done.losses),
    )


def tools_of_project(
    path: Path, catalogue: Iterable[Cutter]
) -> tuple[tuple[Cutter, ...], tuple[Loss, ...]]:
    """Return the tools of a project's plan with their numbers, and those that are left out.

    What a tool is for stands in the catalogue; one that isn't there any more is for nothing. Raises `BadInput` where there is no plan.
    """
    session, _, _ = load_project(path)
    if session.process is None:
        raise BadInput(f"{path}: the project has no plan yet: route it first")
    known = {c.tool.name: c for c in catalogue}
    cutters, losses = [], []
    for tool in session.process.tools():
        if isinstance(tool, Tool):
            like = known.get(tool.name)
            cutters.append(
                Cutter(tool=tool, suits=like.suits if like else (), use=like.use if like else ())
            )
        else:
            losses.append(
                Loss(
                    kind=LossKind.OMITTED,
                    tool=tool.name,
                    field=WHOLE_TOOL,
                    value="",
                    why=_TURNING,
                )
            )
    return tuple(cutters), tuple(losses)
