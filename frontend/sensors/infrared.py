"""The infrared detector: four LEDs fired one after another, four comparators polled (Flynn 1988, §2.2).

A code's first digit says how many LEDs were fired when an echo came, the second which comparator felt it: 1 is the
most sensitive, 0 is none. Weak to strong at three LEDs is 30 < 31 < 32 < 33 < 34. The range must never be read from a
code: 11 comes from a dark surface at 1.5 ft and from a bright one at 8.2 ft.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from frontend.scan import Floats
from frontend.sensors.rays import cast, incidence_cosines
from frontend.sensors.surfaces import Surfaces
from frontend.sensors.transducer import FOOT


@dataclass(frozen=True)
class InfraredDetector:
    """The proximity detector of the paper.

    reach: metres at which the brightest wall is just felt with one, two, three and four LEDs. The paper gives the last
    two and one point for the first; no power law fits them, so they are constants of the calibration.
    comparators: signal, in units of the weakest that is felt, at which each of the four responds (chosen: each
    halves the reach). leds: how many of the four work. spot: half-width of the dish, radians. flicker: relative noise.
    """

    reach: tuple[float, ...] = (8.3 * FOOT, 9.2 * FOOT, 10.0 * FOOT, 18.0 * FOOT)
    comparators: tuple[float, ...] = (1.0, 4.0, 16.0, 64.0)
    leds: int = 3
    brightest: float = 0.8
    spot: float = np.radians(0.25)
    flicker: float = 0.03


def infrared_codes(
    surfaces: Surfaces, pose: Floats, bearings: Floats, detector: InfraredDetector, rng: np.random.Generator
) -> NDArray[np.int16]:
    """Two-digit codes (n,) at bearings (n,) from a head standing at `pose` (3,)."""
    across = np.linspace(-detector.spot, detector.spot, 5)
    angles = (pose[2] + bearings[:, None] + across).ravel()
    brightness = _brightness(surfaces, pose[:2], angles).reshape(bearings.size, across.size).mean(axis=1)
    return codes_of(brightness * (1 + detector.flicker * rng.normal(size=bearings.size)), detector)


def codes_of(brightness: Floats, detector: InfraredDetector) -> NDArray[np.int16]:
    """Codes (n,) of surfaces that return `brightness` (n,): reflectance over squared distance, in m⁻²."""
    codes = np.full(brightness.shape, 10 * detector.leds, np.int16)
    for leds in range(detector.leds, 0, -1):
        signal = brightness * detector.reach[leds - 1] ** 2 / detector.brightest
        felt = np.searchsorted(detector.comparators, signal, side="right")
        codes = np.where(felt > 0, 10 * leds + felt, codes).astype(np.int16)
    return codes


def _brightness(surfaces: Surfaces, place: Floats, angles: Floats) -> Floats:
    """Oren and Nayar's rough diffuse reflector looked at from where the light comes: brighter than Lambert's aslant."""
    distances, hits = cast(surfaces, place, angles)
    cosine = incidence_cosines(surfaces, angles, hits)
    spread = surfaces.facets[hits] ** 2
    flat, grain = 1 - 0.5 * spread / (spread + 0.33), 0.45 * spread / (spread + 0.09)
    lobe = (flat * cosine + grain * (1 - cosine**2)) / flat
    return np.asarray(np.where(hits >= 0, surfaces.reflectance[hits] * lobe, 0.0) / distances**2)
