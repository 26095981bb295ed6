"""What a part file shows in its text, before the CAD kernel sees it.

The kernel's readers take damage in silence: a file cut off gives fewer faces, a number that is none may keep them for ever.
"""

from __future__ import annotations

import re

from trunnion.findings import BadInput

_STRING = re.compile(rb"'(?:[^']|'')*'")
_REMARK = re.compile(rb"/\*.*?\*/", re.DOTALL)
_DEFINED = re.compile(rb"(?:^|;)\s*#(\d+)\s*=", re.MULTILINE)
_USED = re.compile(rb"#(\d+)")
_STEP_FACE = re.compile(rb"=\s*(?:ADVANCED_FACE|FACE_SURFACE)\s*\(")
_STEP_SHAPE = re.compile(
    rb"=\s*\(?\s*(?:MANIFOLD_SOLID_BREP|BREP_WITH_VOIDS|FACETED_BREP|OPEN_SHELL|CLOSED_SHELL)\b"
)
_STEP_PMI = re.compile(
    rb"#\d+\s*=\s*(?:DIMENSIONAL_\w+|SHAPE_DIMENSION_REPRESENTATION|PLUS_MINUS_TOLERANCE|TOLERANCE_VALUE|"
    rb"\w*SHAPE_ASPECT\w*|GEOMETRIC_ITEM_SPECIFIC_USAGE|ITEM_IDENTIFIED_REPRESENTATION_USAGE|"
    rb"DRAUGHTING_MODEL_ITEM_ASSOCIATION\w*)\s*\([^;]*;"
)
"""Entities of sizes and tolerances: no shape is made of them."""
_NO_NUMBER = re.compile(
    rb"(?<![A-Z0-9_#.'$])[-+]?(?:NAN|INF(?:INITY)?|1\.#(?:IND|INF|QNAN)\w*)(?![A-Z0-9_])",
    re.IGNORECASE,
)
_IGES_LINE = re.compile(rb"[SGDPT][ 0-9]{7}$")
IGES_COLUMNS = 72
IGES_FACES = (144, 143, 510)
IGES_SURFACES = (114, 118, 120, 122, 128)
"""Entities that are a face by themselves where nothing trims them: spline, ruled, revolved and swept surfaces, and B-splines."""


def kind_of(data: bytes, name: str) -> str:
    """Return "step" or "iges" by a file's content, whatever its name says; raise `BadInput` for anything else."""
    if not data:
        raise BadInput(f"{name}: the file is empty; export the part again")
    if data[:4096].lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"ISO-10303-21"):
        return "step"
    first = next((line for line in re.split(rb"\r\n|\n|\r", data[:4096]) if line.strip()), b"")
    if _IGES_LINE.match(first[IGES_COLUMNS:].rstrip()):
        return "iges"
    raise BadInput(
        f"{name}: neither a STEP nor an IGES file; export the part as STEP (AP203, AP214, AP242) or IGES 5.3"
    )


def check_step(data: bytes, name: str) -> int:
    """Return how many faces a STEP text lists; raise `BadInput` when it is cut off, damaged or holds no shape."""
    plain = _REMARK.sub(b" ", _STRING.sub(b"''", data))
    if b"END-ISO-10303-21" not in plain[-4096:]:
        raise BadInput(
            f"{name}: the STEP file is cut off (its end mark END-ISO-10303-21 is missing); export or copy it again"
        )
    start = plain.find(b"DATA")
    body = plain[start:] if start >= 0 else b""
    defined = set(map(int, _DEFINED.findall(body)))
    if not defined:
        raise BadInput(
            f"{name}: no shape in the file (its DATA section is empty); export the part again with its solid"
        )
    wrong = _NO_NUMBER.search(body)
    if wrong:
        line = plain[: start + wrong.start()].count(b"\n") + 1
        raise BadInput(
            f"{name}: {wrong.group().decode('ascii')} in line {line} is not a number; export the part again"
        )
    missing = _missing(body, defined)
    if missing:
        # Sizes that refer to nothing are told of where they are read; the shape is whole without them.
        missing = _missing(_STEP_PMI.sub(b"", body), defined)
    if missing:
        more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
        raise BadInput(
            f"{name}: #{missing[0]}{more} is referred to but not in the file: faces would be lost; export the part again"
        )
    faces = len(_STEP_FACE.findall(body))
    if not faces and not _STEP_SHAPE.search(body):
        raise BadInput(
            f"{name}: the file holds curves or points only, no faces; export the part as a solid"
        )
    return faces


def _missing(body: bytes, defined: set[int]) -> list[int]:
    """Return the numbers that a STEP text refers to and doesn't define, ascending."""
    return sorted(set(map(int, _USED.findall(body))) - defined)


def check_iges(data: bytes, name: str) -> int:
    """Return how many trimmed faces an IGES text lists; raise `BadInput` when it is cut off, damaged or holds no face."""
    lines = [line for line in re.split(rb"\r\n|\n|\r", data) if line.strip(b" \x00\x1a")]
    for n, line in enumerate(lines, start=1):
        if not _IGES_LINE.match(line[IGES_COLUMNS:].rstrip()):
            raise BadInput(
                f"{name}: line {n} of the IGES file is cut off or damaged; export or copy it again"
            )
    counts = {
        letter: sum(line[IGES_COLUMNS : IGES_COLUMNS + 1] == letter for line in lines)
        for letter in (b"S", b"G", b"D", b"P")
    }
    last = lines[-1]
    if last[IGES_COLUMNS : IGES_COLUMNS + 1] != b"T":
        raise BadInput(
            f"{name}: the IGES file is cut off (its T section is missing); export or copy it again"
        )
    for at, letter in zip((0, 8, 16, 24), counts, strict=True):
        number_text = last[at + 1 : at + 8].strip()
        if (
            last[at : at + 1] == letter
            and number_text.isdigit()
            and int(number_text) != counts[letter]
        ):
            raise BadInput(
                f"{name}: section {letter.decode()} of the IGES file has {counts[letter]} of {int(number_text)} lines; copy it again"
            )
    numbers = b"".join(line[:64] for line in lines if line[IGES_COLUMNS : IGES_COLUMNS + 1] == b"P")
    wrong = re.search(rb"(?<=[,;])\s*[-+]?(?:NAN|INF(?:INITY)?)\s*(?=[,;])", numbers, re.IGNORECASE)
    if wrong:
        raise BadInput(
            f"{name}: {wrong.group().strip().decode('ascii')} among the parameters is not a number; export the part again"
        )
    directory = [line for line in lines if line[IGES_COLUMNS : IGES_COLUMNS + 1] == b"D"][::2]
    kinds = [int(line[:8]) for line in directory if line[:8].strip().isdigit()]
    faces = sum(kind in IGES_FACES for kind in kinds)
    if not faces:
        # Surfaces that stand alone have no trim: they end where their knots do.
        faces = (
            sum(
                kind in IGES_SURFACES and line[66:68].strip() in (b"", b"0", b"00")
                for kind, line in zip(kinds, directory, strict=True)
            )
            if len(kinds) == len(directory)
            else 0
        )
    if not faces:
        raise BadInput(
            f"{name}: the IGES file holds no trimmed surfaces (entities 144, 143 or 510); export the part's faces too"
        )
    return faces
