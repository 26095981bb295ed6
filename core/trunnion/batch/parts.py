"""Which parts a batch is of: files, folders and patterns, and the folder that each part gets below the batch's."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from glob import glob, has_magic
from itertools import count
from pathlib import Path

from trunnion.findings import BadInput
from trunnion.part.read.part_file import SUFFIXES, part_name
from trunnion.store.project_file import PROJECT_SUFFIX

_GZIPPED = ".gz"


@dataclass(frozen=True, slots=True, kw_only=True)
class BatchPart:
    """A part of a batch: `part` as it was named, `file` (absolute), `folder` the name of its folder below the batch's."""

    part: str
    file: Path
    folder: str


def part_files(words: Iterable[str]) -> tuple[str, ...]:
    """Return the files that words name, each once, in the order of the words: a file, the part files in a folder by name, or those that
    a pattern meets by path (`**` stands for any folders).

    A file that is not there is among them: it will be refused by itself. Raises `BadInput` for a folder or a pattern without part files.
    """
    found: dict[str, str] = {}
    for word in words:
        for file in _files_of(word):
            if any("\ud800" <= c <= "\udfff" for c in file):
                raise BadInput(f"{file!a}: the name is no UTF-8 text; rename the file")
            found.setdefault(os.path.realpath(file), file)
    return tuple(found.values())


def _files_of(word: str) -> Sequence[str]:
    path = Path(word)
    if path.is_dir():
        files = sorted(str(f) for f in path.iterdir() if f.is_file() and is_part_file(f.name))
        if not files:
            raise BadInput(f"{word}: no STEP or IGES file in this folder")
        return files
    if path.exists() or not has_magic(word):
        return (word,)
    files = sorted(f for f in glob(word, recursive=True) if Path(f).is_file() and is_part_file(f))
    if not files:
        raise BadInput(f"{word}: no STEP or IGES file is named so")
    return files


def is_part_file(name: str) -> bool:
    """Return whether a file's name ends as those of part files do.

    >>> is_part_file("rib.STP"), is_part_file("rib.step.gz"), is_part_file("rib.txt")
    (True, True, False)
    """
    return name.lower().removesuffix(_GZIPPED).endswith(SUFFIXES)


def batch_parts(files: Sequence[str], known: Mapping[str, str]) -> tuple[BatchPart, ...]:
    """Return the parts of some files with their folders: `known` has those of an earlier run by the files' real paths.

    A folder is called as its part. Where that name is another part's too, folders of the path are put before it, as few as tell them
    apart; where it is taken by a part that is not among these, a number is put behind it. Names that differ in capitals only are the same.
    """
    paths = [Path(os.path.realpath(f)) for f in files]
    fresh = [p for p in paths if str(p) not in known]
    taken = {name.casefold() for name in known.values()}
    names = {str(p): n for p, n in zip(fresh, _names(fresh), strict=True)}
    folders: dict[str, str] = {}
    for path in paths:
        key = str(path)
        folder = known.get(key) or _free(names[key], taken)
        taken.add(folder.casefold())
        folders[key] = folder
    return tuple(
        BatchPart(part=f, file=p, folder=folders[str(p)]) for f, p in zip(files, paths, strict=True)
    )


def _names(paths: Sequence[Path]) -> list[str]:
    """Return names of parts: with the file's ending behind where one folder has several so called, and with as many folders of the path
    before as tell them apart."""
    own = [name_in(p) for p in paths]
    beside = _double([str(p.with_name(name)) for p, name in zip(paths, own, strict=True)])
    for n in beside:
        own[n] = f"{own[n]}-{paths[n].name[len(own[n]) :].strip('.').replace('.', '-')}"
    names, deepest = list(own), max((len(p.parts) for p in paths), default=0)
    for depth in range(1, deepest):
        for n in _double(names):
            folders = paths[n].parent.parts[1:]
            names[n] = "-".join((*folders[-depth:], own[n]))
    return names


def name_in(file: Path) -> str:
    """Return the name of the part in a part or project file.

    >>> name_in(Path("parts/rib.stp.gz")), name_in(Path("rib.trunnion"))
    ('rib', 'rib')
    """
    return part_name(file.name.removesuffix(PROJECT_SUFFIX))


def _double(names: Sequence[str]) -> list[int]:
    """Return the positions of names that others have too."""
    counted = Counter(name.casefold() for name in names)
    return [n for n, name in enumerate(names) if counted[name.casefold()] > 1]


def _free(name: str, taken: Iterable[str]) -> str:
    if name.casefold() not in taken:
        return name
    return next(made for k in count(2) if (made := f"{name}-{k}").casefold() not in taken)
