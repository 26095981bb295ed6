"""Random cutters of every kind that the catalogue knows, valid by its own rules."""

from __future__ import annotations

import math
from typing import Any

from hypothesis import strategies as st

from own_shop import own_shop
from trunnion.model.tool import BORING_BAR, BUTTON, REAMER, TAP, THREAD_MILL, Holder, Tool
from trunnion.model.tool.drill import point_height
from trunnion.model.tool.lead import basic_minor_diameter
from trunnion.shop.cutters import ISO_GROUPS, USES, Cutter, load_holders
from trunnion.shop.exchange import ExchangeContext

SHOP = own_shop()
HOLDERS = load_holders(None)
CONTEXT = ExchangeContext(holders=HOLDERS, cutters=SHOP.cutters)
FORMS = (
    *("flat", "bull", "ball", "taper", "barrel", "t-slot", "drill", REAMER, BORING_BAR, TAP),
    *(THREAD_MILL, BUTTON, "form", "cone"),
)
"""Forms, an end mill's each for itself, and outlines that are cones apart from others."""


def mm(low: float, high: float) -> st.SearchStrategy[float]:
    """Lengths in whole micrometres."""
    return st.integers(round(low * 1000), round(high * 1000)).map(lambda n: n / 1000)


def share(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high)


def of(value: float) -> float:
    """Return a length in whole micrometres."""
    return round(value, 3)


names = st.one_of(
    st.text(st.characters(exclude_categories=("C", "Z")), min_size=1, max_size=12),
    st.text(st.sampled_from("AB 1.5x\"\\'é½径;#=[]"), min_size=1, max_size=50)
    .map(lambda t: " ".join(t.split()))
    .filter(bool),
)
subsets = st.lists(st.sampled_from(ISO_GROUPS), min_size=1, unique=True).map(tuple)
uses = st.lists(st.sampled_from(USES), min_size=1, max_size=3, unique=True).map(tuple)


@st.composite
def holders(draw: st.DrawFn) -> Holder:
    """Holders of the catalogue, and others."""
    if draw(st.booleans()):
        return draw(st.sampled_from(sorted(HOLDERS.values(), key=lambda h: h.name)))
    rows, z = [], 0.0
    for _ in range(draw(st.integers(1, 4))):
        top = of(z + draw(mm(1, 60)))
        rows.append((z, draw(mm(2, 40)), top, draw(mm(2, 40))))
        z = top
    return Holder(name=draw(names), rows=tuple(rows))


@st.composite
def cutters(draw: st.DrawFn, forms: tuple[str, ...] = FORMS) -> Cutter:
    """A cutter that a `[tool.NAME]` table can hold."""
    form = draw(st.sampled_from(forms))
    own = draw(_own(form))
    flutes, diameter = own["flute_length"], own["diameter"]
    neck_length = draw(st.one_of(st.just(flutes), mm(0, 80).map(lambda d: of(flutes + d))))
    thickest = own.pop("thickest", diameter)
    stickout = of(neck_length + draw(mm(0, 60)))
    holder = draw(holders())
    tool = Tool(
        number=draw(st.one_of(st.just(0), st.integers(1, 400))),
        name=draw(names),
        neck_diameter=of(thickest * draw(share(0.2, 0.99))),
        neck_length=neck_length,
        shank_diameter=draw(mm(1, 40)),
        stickout=stickout,
        gauge_length=stickout + holder.length,
        teeth=own.pop("teeth", None) or draw(st.integers(1, 12)),
        centre_cutting=draw(st.booleans()),
        helix_angle=float(draw(st.integers(0, 60))),
        holder=holder,
        description=draw(names),
        **own,
    )
    return Cutter(tool=tool, suits=draw(subsets), use=draw(uses))


@st.composite
def _own(draw: st.DrawFn, form: str) -> dict[str, Any]:
    """Return what a form needs, in the order of its checks."""
    diameter = draw(mm(1, 60))
    own: dict[str, Any] = {"form": form, "diameter": diameter, "corner_radius": 0.0}
    flutes = draw(mm(1, 60))
    if form == "bull":
        own["corner_radius"] = of(draw(share(0.05, 0.9)) * diameter / 2) or 0.001
    elif form in ("ball", BUTTON):
        own["corner_radius"] = diameter / 2
    elif form == "taper":
        own |= {
            "corner_radius": draw(st.sampled_from((diameter / 2, of(diameter / 5), 0.0))),
            "taper_angle": float(draw(st.integers(1, 40))),
        }
    elif form == "barrel":
        flank = of(diameter * draw(share(1.0, 20.0)))
        tip = of(diameter * draw(share(0.05, 0.4)))
        own |= {"corner_radius": tip, "barrel_radius": flank}
        widest = tip + math.sqrt((flank - tip) ** 2 - (flank - diameter / 2) ** 2)
        flutes = of(
            widest + draw(share(0.05, 0.5)) * math.sqrt(flank**2 - (flank - diameter / 2) ** 2)
        )
    elif form == "t-slot":
        own["corner_radius"] = of(draw(share(0.0, 0.45)) * min(flutes, diameter))
    elif form == "drill":
        own["point_angle"] = float(draw(st.integers(60, 180)))
        flutes = of(point_height(diameter, own["point_angle"]) + draw(mm(0.1, 60)))
    elif form == REAMER:
        own |= {
            "lead": of(diameter * draw(share(0.05, 0.45))),
            "fit": draw(st.sampled_from(("H7", "H8", "F7"))),
        }
        flutes = of(own["lead"] + draw(mm(0.1, 60)))
    elif form == BORING_BAR:
        smallest = of(diameter * draw(share(0.5, 1.0)))
        own |= {"lead": of(smallest * draw(share(0.01, 0.2))) or 0.001, "smallest": smallest}
        own |= {"thickest": smallest}
        flutes = of(own["lead"] + draw(mm(0.1, 10)))
    elif form == TAP:
        pitch = of(diameter * draw(share(0.05, 0.3)))
        own |= {"pitch": pitch, "lead": of(pitch * draw(share(1.0, 5.0)))}
        own |= {"thickest": basic_minor_diameter(diameter, pitch)}
        flutes = of(own["lead"] + draw(mm(0.1, 40)))
    elif form == THREAD_MILL:
        pitch = of(diameter * draw(share(0.05, 0.2)))
        if draw(st.booleans()):
            own |= {"pitch": pitch}
        else:
            own |= {"pitch_low": of(pitch * draw(share(0.4, 1.0))), "pitch_high": pitch}
        own |= {"thickest": 0.6 * diameter}
        flutes = of(1.5 * pitch + draw(mm(0, 20)))
    elif form == "cone":
        tip = of(diameter * draw(share(0.0, 0.8)))
        height = of((diameter - tip) / 2 / math.tan(math.radians(draw(st.integers(40, 150)) / 2)))
        flutes = of(max(height, 0.001) + draw(st.one_of(st.just(0.0), mm(0.5, 10))))
        rows = [(tip / 2, 0.0, 0.0), (diameter / 2, max(height, 0.001), 0.0)]
        own |= {
            "form": "form",
            "outline": tuple(
                rows if flutes == rows[1][1] else [*rows, (diameter / 2, flutes, 0.0)]
            ),
        }
    elif form == "form":
        middle = (of(diameter * draw(share(0.1, 0.45))), of(flutes / 2), draw(share(-0.5, 0.5)))
        own["outline"] = ((0.0, 0.0, 0.2), middle, (diameter / 2, flutes, 0.0))
    if form in ("flat", "bull", "ball", BUTTON, "taper"):
        flutes = max(flutes, of(own["corner_radius"] + 0.001))
    return own | {"flute_length": flutes, "teeth": 1 if form == BUTTON else None}
