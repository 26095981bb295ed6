"""What the commands share: their options, opening a part, showing progress, and turning findings into an exit code."""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trunnion.findings import BadCall, BadInput, Finding, Severity, has_errors
from trunnion.progress import Progress, Report
from trunnion.script import open_part

if TYPE_CHECKING:
    from trunnion.model.session import Session
    from trunnion.pipeline import Engine
    from trunnion.report.picture_process import Ahead
    from trunnion.script.program import PartProgram


def part_command(
    commands: Any, name: str, help: str, description: str = ""
) -> argparse.ArgumentParser:
    """Return the parser of a command that works on one part or project, with the options all of them have."""
    made: argparse.ArgumentParser = commands.add_parser(
        name, help=help, description=description or help
    )
    made.add_argument(
        "part",
        metavar="PART",
        help="part file (.step, .stp, .stpz, .igs, .iges) or project (.trunnion)",
    )
    add_options(made)
    return made


def add_options(made: argparse.ArgumentParser) -> None:
    """Add the options that every command has."""
    made.add_argument(
        "--set",
        action="append",
        default=[],
        metavar="KEY=VALUE",
        dest="words",
        help="change a setting (`trunnion settings` lists them); may be repeated",
    )
    made.add_argument(
        "--solid",
        type=int,
        default=None,
        metavar="N",
        help="which solid of a file with several (1-based)",
    )
    made.add_argument(
        "--fixture",
        action="append",
        default=[],
        metavar="[SETUP=]FILE",
        dest="fixtures",
        help="STEP, IGES or STL file of what holds the part, in the part's coordinates; may be repeated",
    )
    made.add_argument(
        "--user-folder",
        type=folder_named,
        default=None,
        metavar="DIR",
        help="a shop's own tools, materials, machines and plans",
    )
    made.add_argument("--json", action="store_true", help="print the result as JSON")
    made.add_argument(
        "--quiet", action="store_true", help="print results only, no progress and no findings"
    )


def folder_named(word: str) -> Path:
    """Return the folder that a word on the command line names; an empty word would be taken for the current folder."""
    if not word.strip():
        raise argparse.ArgumentTypeError("the name of a folder is empty")
    return Path(word)


def add_output(made: argparse.ArgumentParser) -> None:
    """Add the option that says where to write."""
    made.add_argument(
        "-o",
        "--output",
        type=folder_named,
        required=True,
        metavar="DIR",
        help="folder to write to (made when missing)",
    )


def check_output(folder: Path) -> None:
    """Raise `BadInput` when a folder can't be written to or made, before anything is computed; nothing is made yet."""
    there = next((f for f in (folder, *folder.absolute().parents) if f.exists()), folder)
    if not there.is_dir():
        raise BadInput(f"{folder}: can't be written to: {there} is not a folder")
    if not os.access(there, os.W_OK | os.X_OK):
        raise BadInput(f"{folder}: can't be written to: no permission in {there}")


def words_of(options: argparse.Namespace) -> dict[str, str]:
    """Return the settings given with `--set` by key."""
    return pairs_of(options.words, "--set")


def pairs_of(words: Iterable[str], option: str) -> dict[str, str]:
    """Return what an option gives as KEY=VALUE, by key; raise `BadCall` for other words."""
    pairs = {}
    for word in words:
        key, equals, value = word.partition("=")
        if not equals or not key.strip():
            raise BadCall(f"{option} wants KEY=VALUE, not {word}")
        pairs[key.strip()] = value.strip()
    return pairs


def tags_in(words: str) -> list[int]:
    """Return the face numbers of an option's value, which commas part; none where one of them is no number."""
    given = listed(words)
    return [int(w) for w in given] if all(w.isdecimal() for w in given) else []


def face_tags_of(words: str, option: str) -> list[int]:
    """Return the face numbers that an option gives, none where it is not given; raise `BadCall` for other words."""
    tags = tags_in(words)
    if words and not tags:
        raise BadCall(f"{option} wants face numbers with commas, as in 12,13, not {words}")
    return tags


def progress_of(options: argparse.Namespace) -> Progress:
    """Return progress that shows itself on a terminal's standard error, one line rewritten, and nothing elsewhere."""
    return Progress(_report_of(options))


def _report_of(options: argparse.Namespace) -> Report | None:
    if options.quiet or not sys.stderr.isatty():
        return None

    def show(fraction: float, text: str) -> None:
        end = "\n" if fraction >= 1.0 else ""
        print(f"\r\x1b[K{fraction:4.0%} {text}", end=end, file=sys.stderr, flush=True)

    return show


def open_session(
    options: argparse.Namespace,
    until: str | None,
    ahead: Ahead | None = None,
    running: ExitStack | None = None,
) -> tuple[Engine, Session]:
    """Return the engine and the session of the part, with every step up to `until` done; `ahead` draws the plan's pictures.

    The process that reads the part stays while the caller is `running`, and does work on it beside.
    """
    progress = progress_of(options)
    engine, session = open_part.open_part(
        options.part,
        settings=words_of(options),
        solid=options.solid,
        fixtures=options.fixtures,
        user_folder=options.user_folder,
        progress=progress.part(0.0, 0.1),
        running=running,
    )
    if until is not None:
        session = engine.run(session, until, progress.part(0.1, 1.0), ahead)
    return engine, session


def add_record(made: argparse.ArgumentParser) -> None:
    """Add the option that records what a command does as a script."""
    made.add_argument(
        "--record",
        type=script_named,
        default=None,
        metavar="FILE.py",
        help="append what is done to a Python script that does it again (docs/scripts.md)",
    )


def script_named(word: str) -> Path:
    """Return the script that a word on the command line names."""
    if not word.endswith(".py"):
        raise argparse.ArgumentTypeError(f"a script's name ends in .py, not {word}")
    return Path(word)


def open_program(options: argparse.Namespace, running: ExitStack | None = None) -> PartProgram:
    """Return the program of the part, recorded where a script is named; `running` as in `open_session`."""
    if options.record is not None:
        check_output(options.record.parent)
    program = open_part.open_program(
        options.part,
        settings=words_of(options),
        solid=options.solid,
        fixtures=options.fixtures,
        user_folder=options.user_folder,
        report=_report_of(options),
        running=running,
    )
    if options.record is not None:
        program.record(options.record)
    return program


def given(**words: str) -> dict[str, str]:
    """Return the words that are not empty."""
    return {name: word for name, word in words.items() if word}


def add_manual_edits(made: argparse.ArgumentParser) -> None:
    """Add the options that change groups of patches by hand."""
    made.add_argument(
        "--local",
        metavar="ID,...",
        default="",
        help="groups that are local features (group-05,group-06)",
    )
    made.add_argument("--not-local", metavar="ID,...", default="", help="groups that are none")
    made.add_argument(
        "--move",
        metavar="FACE,...=ID",
        action="append",
        default=[],
        dest="moves",
        help="move faces to a group, or with =new to a new one; may be repeated",
    )


def do_manual_edits(options: argparse.Namespace, program: PartProgram) -> None:
    """Make the changes to a program that the options of `add_manual_edits` say."""
    for word in options.moves:
        faces, equals, group = word.partition("=")
        if not equals or not all(f.isdecimal() for f in listed(faces)):
            raise BadCall(f"--move wants FACE,...=ID, not {word}")
        program.move_faces(map(int, listed(faces)), "" if group == "new" else group)
    for ids, value in ((options.local, True), (options.not_local, False)):
        if ids:
            program.set_local(listed(ids), value)


def dropped_words(tags: Sequence[int]) -> str:
    """Return the patches that are in no group in words, each by its number.

    >>> dropped_words([12]), dropped_words([3, 9])
    ('1 dropped patch (face 12)', '2 dropped patches (faces 3, 9)')
    """
    patches, faces = ("patch", "face") if len(tags) == 1 else ("patches", "faces")
    return f"{len(tags)} dropped {patches} ({faces} {', '.join(map(str, tags))})"


def listed(words: str) -> tuple[str, ...]:
    """Return the words that commas part.

    >>> listed("group-05, group-06")
    ('group-05', 'group-06')
    """
    return tuple(w.strip() for w in words.split(",") if w.strip())


def show_json(data: Any) -> None:
    """Print data as JSON on standard output."""
    print(json.dumps(data, indent=1, ensure_ascii=False))


def show_findings(options: argparse.Namespace, findings: Iterable[Finding]) -> None:
    """Print findings on standard error, one a line, unless told to be quiet by --quiet or to print JSON; what only informs is counted."""
    if options.quiet or options.json:
        return
    notes = 0
    for finding in findings:
        if finding.severity is Severity.INFO:
            notes += 1
        else:
            print(str(finding), file=sys.stderr)
    if notes:
        words = (
            "1 note that asks for nothing stands"
            if notes == 1
            else f"{notes} notes that ask for nothing stand"
        )
        print(f"{words} in --json and in the report", file=sys.stderr)


def table(rows: Sequence[tuple[str, ...]], right: tuple[int, ...] = ()) -> str:
    """Return rows (the first one is the head) as aligned text; the columns in `right` are set flush right."""
    widths = [max(len(row[n]) for row in rows) for n in range(len(rows[0]))]
    lines = [
        "  ".join(
            c.rjust(w) if n in right else c.ljust(w)
            for n, (c, w) in enumerate(zip(row, widths, strict=True))
        ).rstrip()
        for row in rows
    ]
    return "\n".join(lines)


def exit_code(findings: Iterable[Finding]) -> int:
    """Return 1 when any finding is an error, 0 otherwise."""
    return 1 if has_errors(findings) else 0
