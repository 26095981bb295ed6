"""`trunnion batch`: program many parts, each in a process and a folder of its own, and show a line for each as it comes."""

from __future__ import annotations

import argparse
import sys
from typing import Any

from trunnion.cli.common import add_options, add_output, check_output, words_of
from trunnion.findings import BadCall
from trunnion.model.part_result import WITHOUT_VERDICT, PartResult
from trunnion.store.ledger import LEDGER_FILE, PAGE_FILE
from trunnion.units import seconds_of


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = commands.add_parser(
        "batch",
        help="program many parts",
        description="Programs many parts, each in a process of its own and into a folder named after it. What was done is kept in "
        f"{LEDGER_FILE} of the folder: the same call goes on where a batch was stopped. {PAGE_FILE} shows all parts.",
    )
    made.add_argument(
        "parts",
        nargs="+",
        metavar="PART",
        help='part files, folders of them, or patterns such as "parts/**/*.step"',
    )
    add_output(made)
    add_options(made)
    made.add_argument(
        "--jobs",
        type=whole_number,
        default=0,
        metavar="N",
        help="parts at once on this computer (default: one for two cores)",
    )
    made.add_argument(
        "--scheduler",
        default="",
        metavar="ADDRESS",
        help="program on the workers of a Dask scheduler, as in tcp://10.0.0.5:8786",
    )
    made.add_argument(
        "--memory",
        type=whole_number,
        default=0,
        metavar="MB",
        help="memory that a part's processes may hold together (default: its share of the computer's)",
    )
    made.add_argument(
        "--time-limit",
        type=time_limit,
        default=0.0,
        metavar="TIME",
        help='how long a part may take, in seconds or as in "1 h 30 min" (default: as long as it needs)',
    )
    made.add_argument(
        "--again", action="store_true", help="program parts again whose results are there already"
    )
    made.set_defaults(run=run)


def whole_number(word: str) -> int:
    """Return a number from 1 that a word on the command line gives."""
    if not word.isdecimal() or not int(word):
        raise argparse.ArgumentTypeError(f"must be a whole number from 1, not {word}")
    return int(word)


def time_limit(word: str) -> float:
    """Return the seconds, above 0, that words on the command line give."""
    try:
        seconds = seconds_of(word)
    except ValueError as reason:
        raise argparse.ArgumentTypeError(str(reason)) from None
    if not seconds > 0.0:
        raise argparse.ArgumentTypeError("must be longer than 0 s")
    return seconds


def run(options: argparse.Namespace) -> int:
    """Program the parts, print a line for each as it comes, and how many are released."""
    if sys.platform == "win32":
        raise BadCall("batches run on Linux and macOS so far: program the parts one by one")
    if options.scheduler and options.jobs:
        raise BadCall("--jobs is of this computer: with --scheduler its workers say how many")
    check_output(options.output)
    words = words_of(options)
    from trunnion.batch.parts import part_files
    from trunnion.batch.run import Batch, run_batch
    from trunnion.cli.programs.batch_table import BatchTable

    files = part_files(options.parts)
    shown = BatchTable(files, options)
    batch = Batch(
        files=files,
        output=options.output,
        settings=words,
        solid=options.solid,
        fixtures=tuple(options.fixtures),
        user_folder=options.user_folder,
        jobs=options.jobs,
        scheduler=options.scheduler,
        memory=options.memory,
        seconds=options.time_limit,
        again=options.again,
    )
    try:
        results = run_batch(batch, shown.add, shown.progress)
    except KeyboardInterrupt:
        shown.clear()
        print(
            f"trunnion: {shown.n_done} of {len(files)} parts are done; the same call goes on with the others",
            file=sys.stderr,
        )
        raise
    shown.end(results)
    return max((_code(r) for r in results), default=0)


def _code(result: PartResult) -> int:
    """Return the exit code that `trunnion program` has for such a part."""
    return 2 if result.verdict in WITHOUT_VERDICT else int(result.has_problem)
