"""Kernels compiled before they are needed: what they are called with is listed in a `signatures.txt` beside them.

A line is a call with types instead of values, read as Python writes it: `heightfield.zmap_cut(float64[:, ::1], readonly(int64[::1]))`.
Named tuples are called by their class, as the kernel's module knows it. The lists are written by `tests/list_signatures.py`.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cached_property
from importlib import import_module
from importlib.resources import files
from typing import Any

from numba import types

PACKAGES = ("trunnion.geometry.kernels", "trunnion.verify.kernels")
LIST = "signatures.txt"


class Signature:
    """A kernel by its module and name, and the types that it is called with: a line of a list."""

    def __init__(self, package: str, line: str) -> None:
        call = ast.parse(line, mode="eval").body
        if not isinstance(call, ast.Call):
            raise ValueError(f"{line!r} is no call of a kernel")
        module, _, self.name = ast.unparse(call.func).rpartition(".")
        self.module, self._call = f"{package}.{module}", call

    @cached_property
    def kernel(self) -> Any:
        """The kernel, compiled for what it was called with so far."""
        return getattr(import_module(self.module), self.name)

    @property
    def types(self) -> tuple[types.Type, ...]:
        """What the kernel is called with, as numba's types."""
        known = vars(types) | vars(import_module(self.module))
        return tuple(_type(argument, known) for argument in self._call.args)

    def compile(self) -> None:
        """Compile the kernel, and what it calls; from the cache where that has it."""
        # A kernel with types of its own was compiled when its module was loaded, and for nothing else.
        if self.types not in self.kernel.signatures:
            self.kernel.compile(self.types)


def signatures_of(package: str) -> Iterator[Signature]:
    """Yield the signatures that a package of kernels lists."""
    for line in files(package).joinpath(LIST).read_text(encoding="utf-8").splitlines():
        yield Signature(package, line)


def listed_modules() -> list[str]:
    """Return the modules of kernels that lists name, those with most text first: they take longest, and none is left to the end."""
    found = {s.module for package in PACKAGES for s in signatures_of(package)}
    return sorted(found, key=lambda m: (-len(_source(m)), m))


def compile_module(module: str) -> int:
    """Compile all that is listed of a module of kernels, and return how many signatures that is."""
    package = next(p for p in PACKAGES if module.startswith(p))
    listed = [s for s in signatures_of(package) if s.module == module]
    for signature in listed:
        signature.compile()
    return len(listed)


def _source(module: str) -> str:
    package, _, name = module.rpartition(".")
    return files(package).joinpath(f"{name}.py").read_text(encoding="utf-8")


def _type(word: ast.expr, known: dict[str, Any]) -> Any:
    """Return the type that an expression of a list stands for."""
    if isinstance(word, ast.Name):
        return known[word.id]
    if isinstance(word, ast.Subscript):
        return _type(word.value, known)[
            tuple(_dimension(d) for d in word.slice.elts)
            if isinstance(word.slice, ast.Tuple)
            else _dimension(word.slice)
        ]
    if isinstance(word, ast.Tuple):
        return types.Tuple([_type(w, known) for w in word.elts])
    if isinstance(word, ast.Call) and isinstance(word.func, ast.Name):
        inner = [_type(w, known) for w in word.args]
        if word.func.id == "readonly":
            return inner[0].copy(readonly=True)
        return types.NamedTuple(inner, known[word.func.id])
    raise ValueError(f"{ast.unparse(word)!r} is no type of a list of signatures")


def _dimension(word: ast.expr) -> slice:
    """Return one dimension of an array: `::1` where its rows lie one behind the other, `:` where they may not."""
    return slice(None, None, 1) if isinstance(word, ast.Slice) and word.step else slice(None)
