"""`trunnion compile`: the inner loops compiled once, ahead of the first part."""

from __future__ import annotations

import argparse
import time
from typing import Any


def add(commands: Any) -> None:
    """Add the command to the command line."""
    made = commands.add_parser(
        "compile",
        help="compile the inner loops now; else the first part takes a minute longer than the next",
    )
    made.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Compile all that is listed, on all cores, and say how long it took."""
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    from trunnion.geometry.kernels.signatures import compile_module, listed_modules

    began = time.perf_counter()
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        count = sum(pool.map(compile_module, listed_modules()))
    print(f"{count} compiled loops are ready ({time.perf_counter() - began:.0f} s)")
    return 0
