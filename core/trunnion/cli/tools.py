"""`trunnion tools`: the catalogue's tools listed, tool libraries of other programs taken over and written, and the tools in machines."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trunnion import registry
from trunnion.cli.common import (
    check_output,
    exit_code,
    folder_named,
    show_findings,
    show_json,
    table,
)
from trunnion.findings import BadCall, BadInput
from trunnion.units import trimmed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from trunnion.shop.crib import Crib
    from trunnion.shop.cutters import Cutter
    from trunnion.shop.exchange import Loss

_UNITS = ("mm", "inch")


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = commands.add_parser(
        "tools",
        help="the catalogue's tools: list them, import and export tool libraries, keep which are in a machine",
        description="Tool libraries of other programs are read and written with a list of what was lost on the way.",
    )
    kinds = made.add_subparsers(dest="what", metavar="WHAT", required=True)
    one = kinds.add_parser("list", help="tools of the catalogue by kind, diameter and words")
    _add_choice(one)
    _add_common(one)
    one.set_defaults(run=run_list)

    one = kinds.add_parser(
        "import",
        help="a tool library of another program as catalogue files",
        description="Writes the tools as tables [tool.NAME]; without -o they are printed.",
    )
    one.add_argument("file", type=Path, metavar="FILE", help="tool library of another program")
    one.add_argument(
        "-o",
        "--output",
        type=folder_named,
        default=None,
        metavar="TO",
        help="a shop's own folder (made when missing), or a file that ends in .toml",
    )
    one.add_argument(
        "--holder", default="", metavar="NAME", help="holder of tools that come without one"
    )
    _add_format(one, "unit of files that name none (default: mm)")
    _add_common(one)
    one.set_defaults(run=run_import)

    one = kinds.add_parser(
        "export",
        help="tools of the catalogue, or of a project's plan, as a tool library of another program",
    )
    one.add_argument(
        "-o", "--output", type=Path, required=True, metavar="FILE", help="file to write"
    )
    one.add_argument(
        "--tool",
        action="append",
        default=[],
        metavar="NAME",
        dest="names",
        help="a tool by its name; may be repeated (default: all that the other options choose)",
    )
    one.add_argument(
        "--project",
        type=Path,
        default=None,
        metavar="FILE",
        help="the tools of this project's plan (.trunnion), with their numbers",
    )
    _add_choice(one)
    _add_format(one, "unit to write in (default: mm)")
    _add_common(one)
    one.set_defaults(run=run_export)

    one = kinds.add_parser(
        "crib",
        help="the tools in a machine: list them, put tools in, take them out, keep their wear",
        description="Keeps T number, pocket and wear of the tools in each machine in the user's folder, crib/MACHINE.toml.",
    )
    one.add_argument("--machine", default="", metavar="NAME", help="machine (default: list all)")
    for option, metavar, words in (
        ("--put", "NAME=T[:POCKET]", "put a tool in, or give it another T number and pocket"),
        ("--take", "NAME", "take a tool out"),
        ("--wear", "NAME=LENGTH,RADIUS", "measured wear in mm, below 0: worn away"),
    ):
        one.add_argument(
            option, action="append", default=[], metavar=metavar, help=f"{words}; may be repeated"
        )
    _add_common(one)
    one.set_defaults(run=run_crib)


def _add_choice(made: argparse.ArgumentParser) -> None:
    made.add_argument(
        "--kind",
        default="",
        metavar="KIND",
        help="only tools of a kind or form, such as drill or ball",
    )
    made.add_argument(
        "--diameter",
        default="",
        metavar="MM[-MM]",
        help="only tools of a diameter, or from one to another",
    )
    made.add_argument(
        "--text",
        default="",
        metavar="WORDS",
        help="only tools with these words in name, title, use or holder",
    )


def _add_format(made: argparse.ArgumentParser, unit: str) -> None:
    made.add_argument(
        "--format",
        default="",
        metavar="NAME",
        help=f"format of the file (default: by its ending): {', '.join(registry.names(registry.TOOL_FORMATS))}",
    )
    made.add_argument("--unit", choices=_UNITS, default="mm", help=unit)


def _add_common(made: argparse.ArgumentParser) -> None:
    made.add_argument(
        "--user-folder",
        type=folder_named,
        default=None,
        metavar="DIR",
        help="a shop's own tools and holders",
    )
    made.add_argument("--json", action="store_true", help="print the result as JSON")
    made.add_argument("--quiet", action="store_true", help="print results only, no findings")


def run_list(options: argparse.Namespace) -> int:
    """Print the tools of the catalogue that are requested for."""
    from trunnion.shop.cutters import load_cutters, load_holders
    from trunnion.shop.user_folder import shop_folder

    _check_folder(options.user_folder)
    folder = shop_folder(options.user_folder)
    found = selected(options, load_cutters(load_holders(folder), folder))
    if options.json:
        show_json({"tools": [_as_dict(c) for c in found]})
    elif not found:
        print("no such tools")
    else:
        print(tools_table(found))
    return 0


def run_import(options: argparse.Namespace) -> int:
    """Take a library over and print what was written, or the tables where nothing is."""
    from trunnion.shop.exchange import findings_of
    from trunnion.shop.user_folder import shop_folder
    from trunnion.store.tool_library import exchange_context, import_tools

    _check_folder(options.user_folder)
    output = options.output
    if output is not None:
        check_output(output.parent if output.suffix.lower() == ".toml" else output)
    is_folder = output is not None and output.suffix.lower() != ".toml" and output.is_dir()
    folder = (
        output if is_folder and options.user_folder is None else shop_folder(options.user_folder)
    )
    open_ends = exchange_context(folder, unit=options.unit, holder=options.holder)
    done = import_tools(options.file, open_ends, named=options.format, output=output)
    findings = findings_of(done.losses)
    if options.json:
        show_json(
            {
                "file": str(options.file),
                "format": done.format,
                "files": [str(f) for f in done.files],
                "tools": [_as_dict(c) for c in done.cutters],
                **_reported(done.losses),
            }
        )
    elif done.files:
        print(f"{_tools(len(done.cutters))} of {options.file} written to {_joined(done.files)}")
    else:
        print(done.text, end="")
    show_findings(options, findings)
    return exit_code(findings)


def run_export(options: argparse.Namespace) -> int:
    """Write tools as a library of another program."""
    from trunnion.shop.exchange import findings_of
    from trunnion.shop.user_folder import shop_folder
    from trunnion.store.tool_library import exchange_context, export_tools, tools_of_project

    _check_folder(options.user_folder)
    if not options.output.parent.is_dir():
        raise BadInput(f"{options.output}: there is no folder {options.output.parent}")
    check_output(options.output.parent)
    open_ends = exchange_context(shop_folder(options.user_folder), unit=options.unit)
    cutters: Sequence[Cutter] = open_ends.cutters
    losses: Sequence[Loss] = ()
    if options.project is not None:
        cutters, losses = tools_of_project(options.project, open_ends.cutters)
    done = export_tools(
        selected(options, _named(cutters, options.names)),
        options.output,
        open_ends,
        named=options.format,
        losses=losses,
    )
    findings = findings_of(done.losses)
    if options.json:
        show_json(
            {
                "format": done.format,
                "files": [str(f) for f in done.files],
                "count": done.count,
                **_reported(done.losses),
            }
        )
    else:
        print(f"{_tools(done.count)} written to {_joined(done.files)}")
    show_findings(options, findings)
    return exit_code(findings)


def run_crib(options: argparse.Namespace) -> int:
    """Change the crib of a machine and print it; without a machine print all cribs."""
    from trunnion.shop import load_shop
    from trunnion.shop.user_folder import shop_folder
    from trunnion.store.tool_crib import put_tool, set_wear, take_tool

    _check_folder(options.user_folder)
    folder = shop_folder(options.user_folder)
    shop = load_shop(folder)
    machine = options.machine
    if machine:
        shop.machine(machine)
    elif options.put or options.take or options.wear:
        raise BadCall("--put, --take and --wear want a machine: --machine NAME")
    for name in options.take:
        take_tool(folder, machine, name)
    for name, number, pocket in [_put_words(w) for w in options.put]:
        put_tool(folder, shop, machine, name, number=number, pocket=pocket)
    for name, length, radius in [_wear_words(w) for w in options.wear]:
        set_wear(folder, machine, name, length, radius)
    cribs = load_shop(folder).cribs
    found = [cribs[m] for m in sorted(cribs) if machine in ("", m)]
    if options.json:
        tools = {c.machine: [t.as_dict() for t in c.tools] for c in found}
        show_json({"machines": tools})
    else:
        print(crib_table(found) if any(c.tools for c in found) else "no tools in the machine")
    return 0


def _put_words(words: str) -> tuple[str, int, int]:
    """Return name, T number and pocket of `NAME=T[:POCKET]`."""
    name, _, numbers = words.rpartition("=")
    number, _, pocket = numbers.partition(":")
    if not (name and number.isdecimal() and (pocket or "0").isdecimal() and int(number)):
        raise BadCall(f"--put wants NAME=T or NAME=T:POCKET, whole numbers from 1, not {words}")
    return name, int(number), int(pocket or 0)


def _wear_words(words: str) -> tuple[str, float, float]:
    """Return name, length and radius in mm of `NAME=LENGTH,RADIUS`."""
    name, _, numbers = words.rpartition("=")
    length, _, radius = numbers.partition(",")
    try:
        found = float(length), float(radius)
    except ValueError:
        raise BadCall(f"--wear wants NAME=LENGTH,RADIUS in mm, not {words}") from None
    if not name:
        raise BadCall(f"--wear wants NAME=LENGTH,RADIUS in mm, not {words}")
    return name, *found


def crib_table(cribs: Sequence[Crib]) -> str:
    """Return the tools in some machines as aligned text, wear in mm."""
    rows = [("machine", "T", "pocket", "tool", "wear L", "wear R")]
    rows += [
        (
            crib.machine,
            str(tool.number),
            str(tool.pocket or ""),
            tool.name,
            trimmed(tool.wear_length, 4),
            trimmed(tool.wear_radius, 4),
        )
        for crib in cribs
        for tool in crib.tools
    ]
    return table(rows, right=(1, 2, 4, 5))


def selected(options: argparse.Namespace, cutters: Sequence[Cutter]) -> tuple[Cutter, ...]:
    """Return the cutters that the options of `_add_choice` ask for; raise `BadCall` for an unknown kind or no diameter."""
    from trunnion.model.tool import FORMS
    from trunnion.shop.cutters import END_MILL
    from trunnion.shop.exchange.fields import kind_of

    if options.kind and options.kind not in (END_MILL, *FORMS):
        raise BadCall(f"unknown kind {options.kind}; known: {', '.join((END_MILL, *FORMS))}")
    low, high = _range(options.diameter)
    words = options.text.lower().split()
    return tuple(
        c
        for c in cutters
        if options.kind in ("", c.tool.form, kind_of(c.tool.form))
        and low <= c.tool.diameter <= high
        and all(w in _searched(c) for w in words)
    )


def _range(words: str) -> tuple[float, float]:
    """Return the lowest and the highest diameter of `12` or `6-12`."""
    if not words:
        return 0.0, float("inf")
    low, _, high = words.partition("-")
    try:
        found = float(low), float(high or low)
    except ValueError:
        raise BadCall(f"--diameter wants mm, as in 12 or 6-12, not {words}") from None
    return found


def _searched(cutter: Cutter) -> str:
    tool = cutter.tool
    return " ".join((tool.name, tool.description, tool.holder.name, *cutter.use)).lower()


def _named(cutters: Sequence[Cutter], names: Sequence[str]) -> Sequence[Cutter]:
    """Return the cutters with names, in the order of the names; all where none is given."""
    known = {c.tool.name: c for c in cutters}
    for name in names:
        if name not in known:
            raise BadInput(f"unknown tool {name}: `trunnion tools list` has the names")
    return [known[name] for name in names] if names else cutters


def _check_folder(folder: Path | None) -> None:
    if folder is not None and not folder.is_dir():
        raise BadInput(f"{folder}: no such folder of tools and holders")


def _as_dict(cutter: Cutter) -> dict[str, object]:
    from trunnion.shop.exchange.fields import fields_of

    return fields_of(cutter)


def _reported(losses: Sequence[Loss]) -> dict[str, object]:
    from trunnion.shop.exchange import findings_of

    return {
        "losses": [loss.as_dict() for loss in losses],
        "findings": [finding.as_dict() for finding in findings_of(losses)],
    }


def _tools(count: int) -> str:
    return "1 tool" if count == 1 else f"{count} tools"


def _joined(files: Sequence[Path]) -> str:
    return str(files[0]) if len(files) == 1 else f"{files[-1]} and {len(files) - 1} more"


def tools_table(cutters: Sequence[Cutter]) -> str:
    """Return tools as aligned text, lengths in mm."""
    rows = [("tool", "form", "D", "R", "flutes", "stickout", "teeth", "use", "holder")]
    rows += [
        (
            t.name,
            t.form,
            trimmed(t.diameter, 3),
            trimmed(t.corner_radius, 3),
            trimmed(t.flute_length, 3),
            trimmed(t.stickout, 3),
            str(t.teeth),
            ", ".join(c.use),
            t.holder.name,
        )
        for c in cutters
        for t in [c.tool]
    ]
    return table(rows, right=(2, 3, 4, 5, 6))
