"""Writes the lists of what kernels are called with (`signatures.txt` beside them) from numba's caches, for `trunnion compile`.

    make test && python tests/list_signatures.py

The caches tell what kernels were called with since their files changed: run the tests before, in a tree whose caches were cleaned.
Kernels that only other kernels call are left out: they are compiled with those.
"""

from __future__ import annotations

import pkgutil
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

from numba import types
from numba.core.dispatcher import Dispatcher

from trunnion.geometry.kernels.signatures import LIST, PACKAGES


def lines(package: str) -> Iterator[str]:
    """Yield a line for each signature that the caches of a package know."""
    top = import_module(package)
    for found in pkgutil.walk_packages(top.__path__, f"{package}."):
        module = import_module(found.name)
        for name, kernel in sorted(vars(module).items()):
            if (
                isinstance(kernel, Dispatcher)
                and kernel.__module__ == found.name
                and not name.startswith("_")
            ):
                short = found.name.removeprefix(f"{package}.")
                for signature in _cached(kernel):
                    if not any(isinstance(t, types.Literal) for t in signature):
                        yield f"{short}.{name}({', '.join(map(word, signature))})"


def _cached(kernel: Any) -> list[tuple[types.Type, ...]]:
    """Return the argument types that the cache of a kernel knows; the index has no public way in."""
    index = getattr(kernel._cache, "_cache_file", None)
    known = {getattr(key[0], "args", key[0]) for key in (index._load_index() if index else ())}
    return sorted(known, key=str)


def word(kind: Any) -> str:
    """Return a type as the lists have it."""
    if isinstance(kind, types.Array):
        rows = ", ".join([":"] * (kind.ndim - 1) + ["::1" if kind.layout == "C" else ":"])
        plain = f"{_name(kind.dtype)}[{rows}]"
        return plain if kind.mutable else f"readonly({plain})"
    if isinstance(kind, types.BaseNamedTuple):
        return f"{kind.instance_class.__name__}({', '.join(map(word, kind))})"
    if isinstance(kind, types.BaseTuple):
        return f"({', '.join(map(word, kind))})"
    return _name(kind)


def _name(kind: Any) -> str:
    return "boolean" if isinstance(kind, types.Boolean) else str(kind)


def main() -> None:
    """Write the lists."""
    for package in PACKAGES:
        folder = Path(str(import_module(package).__file__)).parent
        found = list(dict.fromkeys(lines(package)))
        (folder / LIST).write_text("".join(f"{line}\n" for line in found), encoding="utf-8")
        print(f"{package}: {len(found)} signatures")


if __name__ == "__main__":
    main()
