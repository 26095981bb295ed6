"""The signature of a part: what similar parts have in common, as counts, sizes and words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from trunnion.model.feature import Feature
from trunnion.model.material import Machine, Material

OUTLINE = "outline"
"""The attribute of features that tells features of one kind apart, where a family gives it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PartSignature:
    """What a part is compared by.

    `features` count its features by kind, those with an outline by kind and outline (`KIND OUTLINE`); `sizes` are its principal sizes in mm
    by name, all above 0; `material` and `material_group` (ISO 513) are the blank's, `machine` the kind of machine in words.
    """

    family: str
    features: Mapping[str, int]
    sizes: Mapping[str, float]
    material: str
    material_group: str
    machine: str

    def as_dict(self) -> dict[str, object]:
        """Return the signature as JSON has it."""
        return {
            "family": self.family,
            "features": dict(sorted(self.features.items())),
            "sizes": dict(sorted(self.sizes.items())),
            "material": self.material,
            "material_group": self.material_group,
            "machine": self.machine,
        }


def part_signature(
    family: str,
    features: Iterable[Feature],
    sizes: Mapping[str, float],
    material: Material,
    machine: Machine,
) -> PartSignature:
    """Return the signature of a part with these features and principal sizes (mm) for a material and a machine."""
    return PartSignature(
        family=family,
        features=dict(sorted(Counter(map(kind_words, features)).items())),
        sizes={name: value for name, value in sorted(sizes.items()) if value > 0.0},
        material=material.name,
        material_group=material.iso_group,
        machine=machine_words(machine),
    )


def kind_words(feature: Feature) -> str:
    """Return what a feature is counted as: its kind, with its outline where it has one."""
    outline = feature.attributes.get(OUTLINE, "")
    return f"{feature.kind} {outline}" if isinstance(outline, str) and outline else feature.kind


def machine_words(machine: Machine) -> str:
    """Return the kind of a machine in words: its number of axes, and whether it turns too."""
    turns = " that turns" if machine.work_spindle is not None else ""
    return f"{len(machine.axes)}-axis mill{turns}"
