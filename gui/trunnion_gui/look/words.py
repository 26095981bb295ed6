"""How numbers, kinds and times read in the window."""

from __future__ import annotations

from collections.abc import Sequence

from trunnion.model.feature import Size
from trunnion.units import several, trimmed

_ANGLES = ("lean", "angle", "taper", "theta", "tilt")
_PLAIN = ("count_", "n_")
_MOST_NAMED = 3
"""Faces that a label names at most."""


def kind_words(kind: str) -> str:
    """Return a kind as a person reads it.

    >>> kind_words("open_pocket")
    'open pocket'
    """
    return kind.replace("_", " ").replace(".", " ")


def sentence(words: str) -> str:
    """Return words with a capital first letter."""
    return words[:1].upper() + words[1:]


def message_sentence(words: str) -> str:
    """Return a message with a capital first letter, unless it begins with the name of a file, a part, an operation or a setting.

    >>> message_sentence("the part is open"), message_sentence("tray.step: no solid"), message_sentence("op-03 must wait"),
    message_sentence("blade: no faces") ('The part is open', 'tray.step: no solid', 'op-03 must wait', 'blade: no faces')
    """
    first = words.partition(" ")[0]
    is_name = first.endswith(":") or any(letter in "._/" or letter.isdigit() for letter in first)
    return words if is_name else sentence(words)


def faces_named(tags: Sequence[int]) -> str:
    """Return the numbers of some faces for a label, the first three where there are more."""
    more = "…" if len(tags) > _MOST_NAMED else ""
    return ", ".join(map(str, tags[:_MOST_NAMED])) + more


def counted(number: int, kind: str) -> str:
    """Return a number of things in words; only English ones have an s when there are several.

    >>> counted(13, "pocket"), counted(1, "open_pocket"), counted(13, "型腔")
    ('13 pockets', '1 open pocket', '13 型腔')
    >>> counted(6, "boss")
    '6 bosses'
    """
    words = kind_words(kind)
    return (
        f"{number} {words}" if number == 1 or not words.isascii() else f"{number} {several(words)}"
    )


def over_bound(times: float) -> str:
    """Return how many times its bound a time is; a dash where that isn't known.

    >>> over_bound(1.8125), over_bound(0.0)
    ('1.81 ×', '–')
    """
    return f"{times:.2f} ×" if times > 0.0 else "–"


def duration(seconds: float) -> str:
    """Return a time as short as it can be read.

    >>> duration(0.034), duration(12.3), duration(754), duration(8040)
    ('0.03 s', '12.3 s', '12 min 34 s', '2 h 14 min')
    """
    if seconds < 1:
        return f"{seconds:.2f} s"
    if seconds < 60:
        return f"{seconds:.1f} s"
    if seconds < 3600:
        return f"{int(seconds) // 60} min {int(seconds) % 60} s"
    return f"{int(seconds) // 3600} h {int(seconds) % 3600 // 60} min"


def amount(value: Size, decimals: int = 3) -> str:
    """Return a size without its unit."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        return ", ".join(amount(v, decimals) for v in value)
    return trimmed(float(value), decimals) if isinstance(value, (int, float)) else str(value)


def size_unit(name: str, value: Size) -> str:
    """Return the unit of a feature's size by its name.

    >>> size_unit("depth", 30.0), size_unit("lean", 3.0), size_unit("area", 1800.0), size_unit("size_ratio", 0.9), size_unit("count", 4)
    ('mm', '°', 'mm²', '', '')
    >>> size_unit("counterbore_depth", 12.0), size_unit("countersink_angle", 90.0)
    ('mm', '°')
    """
    if (
        isinstance(value, (bool, str))
        or name.startswith(_PLAIN)
        or name.endswith(("count", "ratio"))
    ):
        return ""
    if name.endswith("area"):
        return "mm²"
    return "°" if any(word in name for word in _ANGLES) else "mm"


def share(value: float) -> str:
    """Return a share in per cent, never rounded up to a hundred.

    >>> share(0.9964), share(1.0), share(0.99999)
    ('99.6 %', '100 %', '99.9 %')
    """
    if value >= 1.0:
        return "100 %"
    return f"{int(value * 1000) / 10:.1f} %"


def clock(seconds: float) -> str:
    """Return a time as a clock shows it.

    >>> clock(74.6), clock(3725)
    ('1:14', '1:02:05')
    """
    whole = int(seconds)
    hours, minutes = divmod(whole // 60, 60)
    return f"{hours}:{minutes:02d}:{whole % 60:02d}" if hours else f"{minutes}:{whole % 60:02d}"


def grouped(number: int) -> str:
    """Return a whole number with its thousands apart.

    >>> grouped(6526)
    '6 526'
    """
    return f"{number:,}".replace(",", " ")


def fine_amount(millimetres: float) -> str:
    """Return a small length with its sign, in the unit it reads best in.

    >>> fine_amount(0.0124), fine_amount(-0.05), fine_amount(1.5)
    ('+12 µm', '-50 µm', '+1.50 mm')
    """
    microns = millimetres * 1000.0
    if abs(microns) < 9.95:
        return f"{microns:+.1f} µm" if abs(microns) >= 0.05 else "0 µm"
    return f"{microns:+.0f} µm" if abs(microns) < 999.5 else f"{millimetres:+.2f} mm"
