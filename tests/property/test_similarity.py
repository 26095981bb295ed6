"""Similarity of parts: symmetric, 1 for equal parts, between 0 and 1, and less with every feature that is taken away."""

from __future__ import annotations

from dataclasses import replace

from hypothesis import assume, given, settings
from hypothesis import strategies as st

from trunnion.shop.library import PartSignature, similarity

KINDS = st.dictionaries(
    st.sampled_from(["pocket", "rib", "hole", "boss circle", "boss lobe"]),
    st.integers(1, 40),
    max_size=5,
)
SIZES = st.dictionaries(
    st.sampled_from(["length", "width", "height", "wall_thickness"]), st.floats(0.01, 1e4)
)
SIGNATURES = st.builds(
    PartSignature,
    family=st.sampled_from(["one", "two"]),
    features=KINDS,
    sizes=SIZES,
    material=st.sampled_from(["a", "b"]),
    material_group=st.sampled_from(["N", "S"]),
    machine=st.sampled_from(["3-axis mill", "5-axis mill"]),
)


@settings(deadline=None)
@given(SIGNATURES, SIGNATURES)
def test_it_is_symmetric_and_between_nothing_and_one(one, other):
    value = similarity(one, other).value
    assert value == similarity(other, one).value
    assert 0.0 <= value <= 1.0


@settings(deadline=None)
@given(SIGNATURES)
def test_a_part_is_wholly_like_itself(one):
    assert similarity(one, one).value == 1.0


@settings(deadline=None)
@given(SIGNATURES, SIGNATURES)
def test_parts_of_different_families_are_not_alike(one, other):
    assume(one.family != other.family)
    assert similarity(one, other).value == 0.0


@settings(deadline=None)
@given(SIGNATURES, st.data())
def test_it_falls_with_every_feature_that_is_taken_away(one, data):
    assume(one.features)
    before, left = 1.0, dict(one.features)
    while left:
        kind = data.draw(st.sampled_from(sorted(left)))
        left = {k: n - (k == kind) for k, n in left.items() if n > (k == kind)}
        value = similarity(one, replace(one, features=left)).value
        assert value < before
        before = value


@settings(deadline=None)
@given(SIGNATURES, st.floats(1.05, 3.0), st.floats(1.05, 3.0))
def test_it_falls_as_a_size_goes_away_in_either_direction(one, first, second):
    assume(one.sizes)
    name = min(one.sizes)

    def scaled(factor):
        return similarity(
            one, replace(one, sizes={**one.sizes, name: factor * one.sizes[name]})
        ).value

    assert scaled(first * second) < scaled(first) < 1.0
    assert scaled(1.0 / (first * second)) < scaled(1.0 / first) < 1.0
