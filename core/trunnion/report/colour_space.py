"""Colours as people see them: sRGB and OKLab, where equal distances look equally large, and sight without one kind of cone.

OKLab: B. Ottosson, "A perceptual color space for image processing", 2020. Sight without long (protanopia) or medium cones (deuteranopia):
G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, "A physiologically-based model for simulation of color vision deficiency", IEEE TVCG 15,
2009, at full severity. Contrast: WCAG 2.
"""

from __future__ import annotations

import numpy as np

from trunnion.geometry.arrays import Bools, Floats

BITS = 255.0
"""The largest value of a channel."""
TO_LINEAR, FROM_LINEAR = 0.04045, 0.0031308
"""Where sRGB's curve begins, as written and as light (IEC 61966-2-1)."""
CONES = np.array(
    [
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ]
)
"""Light in sRGB's primaries to OKLab's cones."""
OPPONENTS = np.array(
    [
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ]
)
"""Cube roots of the cones to lightness, green to red, blue to yellow."""
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
"""Of the primaries."""
GLARE = 0.05
"""Light that a screen gives back of itself, in WCAG's contrast."""
SIGHTS = {
    "full": np.eye(3),
    "protanopia": np.array(
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ]
    ),
    "deuteranopia": np.array(
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ]
    ),
}
"""What light looks like with all cones, without the long and without the medium ones: matrices on sRGB's primaries."""


def light(colours: Floats) -> Floats:
    """Return colours (k, 3) of 0 to 255 as light, 0 to 1."""
    written = np.asarray(colours, dtype=np.float64) / BITS
    return np.where(
        written <= TO_LINEAR, written / 12.92, ((np.maximum(written, 0.0) + 0.055) / 1.055) ** 2.4
    )


def written(light: Floats) -> Floats:
    """Return light (k, 3) as colours of 0 to 255, beyond these where no screen shows it."""
    bright = np.maximum(light, FROM_LINEAR)
    return BITS * np.where(
        light <= FROM_LINEAR, 12.92 * light, 1.055 * bright ** (1.0 / 2.4) - 0.055
    )


def oklab(light: Floats) -> Floats:
    """Return light (k, 3) as lightness, green to red, blue to yellow."""
    return np.asarray(np.cbrt(light @ CONES.T) @ OPPONENTS.T)


def light_of(lab: Floats) -> Floats:
    """Return OKLab colours (k, 3) as light, below 0 or above 1 where no screen shows it."""
    return np.asarray((lab @ np.linalg.inv(OPPONENTS).T) ** 3 @ np.linalg.inv(CONES).T)


def seen(colours: Floats) -> Floats:
    """Return colours (k, 3) of 0 to 255 in OKLab (sights, k, 3), as each of `SIGHTS` sees them."""
    through = light(colours)
    return np.stack([oklab(np.clip(through @ sight.T, 0.0, 1.0)) for sight in SIGHTS.values()])


def distances(a: Floats, b: Floats) -> Floats:
    """Return the distances (k, m) of colours as they are seen, (sights, k, 3) and (sights, m, 3): by the sight that parts them least."""
    return np.asarray(np.linalg.norm(a[:, :, None] - b[:, None], axis=3).min(axis=0))


def contrast(colours: Floats, background: Floats) -> Floats:
    """Return the contrast (k,) of colours (k, 3) of 0 to 255 with a background (3,): 1 for none."""
    own, behind = light(colours) @ LUMINANCE + GLARE, light(background) @ LUMINANCE + GLARE
    return np.asarray(np.maximum(own, behind) / np.minimum(own, behind))


def on_screen(colours: Floats) -> Bools:
    """Return which colours (k, 3) a screen shows."""
    return np.asarray(((colours >= 0.0) & (colours <= BITS)).all(axis=1))
