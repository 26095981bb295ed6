"""Cylinders that a STEP file draws by curves: a circle, or most of one, and lines along its axis.

So the supplemental geometry of AP242 has threads ("Thread Cylinder"): the hole is modelled at another diameter, and the size of the
thread is tied to a `geometric_curve_set` about its axis (ISO 10303-42; CAx-IF recommended practices for supplemental geometry).
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from trunnion import tolerance
from trunnion.geometry.arrays import Floats
from trunnion.part.read.step_aspects import USAGES
from trunnion.part.read.step_measures import MEASURE_TYPES, unit_of
from trunnion.part.read.step_text import BadEntity, EntityRecord, StepText, numbers_in

_REPRESENTATIONS = (
    "CONSTRUCTIVE_GEOMETRY_REPRESENTATION",
    "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION",
    "SHAPE_REPRESENTATION",
)
_TYPES = (
    *MEASURE_TYPES,
    *USAGES,
    *_REPRESENTATIONS,
    "GLOBAL_UNIT_ASSIGNED_CONTEXT",
    "GEOMETRIC_CURVE_SET",
    "TRIMMED_CURVE",
    "CIRCLE",
    "LINE",
    "VECTOR",
    "AXIS2_PLACEMENT_3D",
    "CARTESIAN_POINT",
    "DIRECTION",
)


@dataclass(frozen=True, slots=True, eq=False)
class DrawnThread:
    """A cylinder in mm, part frame: a point (3,) of its axis, the axis (3,) of length 1, radius, and its ends along the axis from there."""

    point: Floats
    axis: Floats
    radius: float
    low: float
    high: float


def cylinders_in(data: bytes, numbers: Collection[int]) -> dict[int, DrawnThread]:
    """Return the cylinders that sets of curves draw, by the numbers of their entities; sets that draw none are left out."""
    text = StepText(data, _TYPES)
    within = text.links(4, 3, *USAGES)
    found = {}
    for number in numbers:
        if number in text:
            try:
                found[number] = _cylinder(text, number, _unit(text, within.get(number, [])))
            except BadEntity:
                continue
    return found


def _unit(text: StepText, representations: list[int]) -> float:
    """Return how many mm the unit of length of a representation's context is."""
    for representation in representations:
        context = numbers_in(text.entity(representation).parameters(*_REPRESENTATIONS))[-1:]
        units = (
            text.entity(context[0]).parameters("GLOBAL_UNIT_ASSIGNED_CONTEXT") if context else ()
        )
        for number in numbers_in(units):
            if number in text and text.entity(number).parameters("LENGTH_UNIT") is not None:
                return unit_of(text, number)
    raise BadEntity("the representation has no unit of length")


def _cylinder(text: StepText, number: int, unit: float) -> DrawnThread:
    circles, ends = [], []
    for item in numbers_in(text.entity(number).parameters("GEOMETRIC_CURVE_SET")):
        curve = text.entity(item)
        trimmed = curve.parameters("TRIMMED_CURVE")
        if trimmed is None or len(trimmed) < 4:
            raise BadEntity(f"#{item} is not trimmed")
        basis = text.entity((numbers_in(trimmed[1]) or [0])[0])
        circle, line = basis.parameters("CIRCLE"), basis.parameters("LINE")
        if circle is not None:
            circles.append(_circle(text, circle))
        elif line is not None:
            ends += [_on_line(text, line, _trim(p)) for p in trimmed[2:4]]
    if len(circles) != 1 or not ends:
        raise BadEntity(f"#{number} is no circle with lines along its axis")
    point, axis, radius = circles[0]
    offsets = np.array(ends) - point
    along = offsets @ axis
    away = np.linalg.norm(offsets - along[:, None] * axis, axis=1)
    if np.any(np.abs(away - radius) * unit > tolerance.FITTED):
        raise BadEntity(f"#{number} has lines off its circle")
    return DrawnThread(
        unit * point, axis, unit * radius, unit * float(along.min()), unit * float(along.max())
    )


def _circle(text: StepText, parameters: tuple[object, ...]) -> tuple[Floats, Floats, float]:
    """Return centre, axis and radius of a circle, in the file's unit."""
    placement = text.entity((numbers_in(parameters) or [0])[0]).parameters("AXIS2_PLACEMENT_3D")
    named = numbers_in(placement)
    radius = parameters[-1]
    if len(named) < 2 or not isinstance(radius, float) or radius <= 0.0:
        raise BadEntity("a circle has no axis or no radius")
    return _triple(text, named[0]), _unit_vector(text, named[1]), radius


def _on_line(text: StepText, parameters: tuple[object, ...], parameter: float) -> Floats:
    """Return the point of a line at a parameter."""
    named = numbers_in(parameters)
    if len(named) != 2:
        raise BadEntity("a line has no point or no direction")
    vector = text.entity(named[1]).parameters("VECTOR") or ()
    length = vector[-1] if vector else None
    direction = numbers_in(vector)
    if not direction or not isinstance(length, float):
        raise BadEntity("a vector has no direction or no length")
    return _triple(text, named[0]) + parameter * length * _unit_vector(text, direction[0])


def _trim(parameter: object) -> float:
    """Return the parameter value that trims a curve."""
    for value in parameter if isinstance(parameter, tuple) else ():
        if isinstance(value, EntityRecord) and value.type == "PARAMETER_VALUE":
            (number, *_) = (*value.parameters, None)
            if isinstance(number, float):
                return number
    raise BadEntity("a curve is not trimmed by parameters")


def _triple(text: StepText, number: int) -> Floats:
    parameters = text.entity(number).parameters("CARTESIAN_POINT", "DIRECTION") or ()
    values = parameters[-1] if parameters else None
    found = np.array(
        [v for v in values if isinstance(v, float)] if isinstance(values, tuple) else []
    )
    if found.shape != (3,) or not np.isfinite(found).all():
        raise BadEntity(f"#{number} has not three coordinates")
    return found


def _unit_vector(text: StepText, number: int) -> Floats:
    found = _triple(text, number)
    length = float(np.linalg.norm(found))
    if length == 0.0:
        raise BadEntity(f"#{number} is no direction")
    return found / length
