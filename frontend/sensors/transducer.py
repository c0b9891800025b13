"""The transducer: a round piston that sends a chirp and listens, and the air in between (Flynn 1988, §2.1).

The paper's figures that do not follow from its own data: the chirp lasts 1.067 ms, which is 7.2 in one way and not 3;
the wavelength is 0.27 in, not ½ in. The physics is kept.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.special import j1

from frontend.scan import Floats

FOOT = 0.3048
INCH = FOOT / 12


def speed_of_sound(celsius: float) -> float:
    """Metres per second in dry air: 331.3 at 0 °C, growing with the root of the absolute temperature."""
    return 331.3 * float(np.sqrt(1 + celsius / 273.15))


def absorption(frequency: float, celsius: float, humidity: float) -> float:
    """What air at sea level takes from a tone, decibels per metre (ISO 9613-1). humidity: percent."""
    kelvin = celsius + 273.15
    warmth = kelvin / 293.15
    vapour = humidity * 10 ** (4.6151 - 6.8346 * (273.16 / kelvin) ** 1.261)
    oxygen = 24 + 4.04e4 * vapour * (0.02 + vapour) / (0.391 + vapour)
    nitrogen = warmth**-0.5 * (9 + 280 * vapour * np.exp(-4.17 * (warmth ** (-1 / 3) - 1)))
    relaxing = 0.01275 * np.exp(-2239.1 / kelvin) / (oxygen + frequency**2 / oxygen)
    relaxing += 0.1068 * np.exp(-3352.0 / kelvin) / (nitrogen + frequency**2 / nitrogen)
    return float(8.686 * frequency**2 * (1.84e-11 * np.sqrt(warmth) + warmth**-2.5 * relaxing))


@dataclass(frozen=True)
class Transducer:
    """A Polaroid ranger and the air around it.

    piston: radius, metres. chirp: pulses and their frequency in hertz. threshold: least echo energy that is heard,
    as a share of what arrives at one metre on the axis. celsius, assumed_celsius: of the air, and what the range
    is computed with. height: of the head above the floor, metres (a slat throws the beam there).
    """

    piston: float = 0.019
    chirp: tuple[tuple[int, float], ...] = ((8, 60e3), (8, 56e3), (16, 52.5e3), (24, 49.41e3))
    # One constant holds both claims of the paper: a 1-inch pole 2½ ft away is heard 40° off the axis, and plasterboard
    # 3 ft away is lost where the head is aimed at less than 25° from it.
    threshold: float = 10**-8.6
    celsius: float = 20.0
    assumed_celsius: float = 20.0
    humidity: float = 50.0
    height: float = 4 * FOOT

    @property
    def chirp_seconds(self) -> float:
        """How long the chirp lasts: 1.067 ms."""
        return sum(pulses / frequency for pulses, frequency in self.chirp)

    @property
    def chirp_length(self) -> float:
        """Range by which an echo's end lies behind its beginning, metres."""
        return self.chirp_seconds * speed_of_sound(self.celsius) / 2

    @property
    def mean_frequency(self) -> float:
        """Pulses over their duration, hertz."""
        return sum(pulses for pulses, _ in self.chirp) / self.chirp_seconds

    @property
    def wavelength(self) -> float:
        """At the mean frequency, metres."""
        return speed_of_sound(self.celsius) / self.mean_frequency

    @property
    def decay(self) -> float:
        """Share of the power lost per metre travelled, as an exponent: power falls with exp(−decay·distance)."""
        return absorption(self.mean_frequency, self.celsius, self.humidity) * float(np.log(10)) / 10

    @property
    def stretch(self) -> float:
        """Reported range over true range: the assumed speed of sound over the real one."""
        return speed_of_sound(self.assumed_celsius) / speed_of_sound(self.celsius)


def one_way_power(transducer: Transducer, angles: Floats, frequency: float) -> Floats:
    """Power (…) at angles off the axis, 1 on it: (2J₁(x)/x)² with x = ka·sin θ, and a free head's obliquity.

    The obliquity ((1 + cos θ)/2)² is that of a piston in open air (Kirchhoff); nothing is heard from behind.
    """
    x = 2 * np.pi * frequency / speed_of_sound(transducer.celsius) * transducer.piston * np.sin(np.abs(angles))
    amplitude = np.where(x < 1e-6, 1.0, 2 * j1(x) / np.where(x < 1e-6, 1.0, x))
    power = (amplitude * (1 + np.cos(angles)) / 2) ** 2
    return np.asarray(np.where(np.abs(angles) < np.pi / 2, power, 0.0))


def two_way_power(transducer: Transducer, angles: Floats) -> Floats:
    """Power (…) sent and received at angles off the axis, summed over the chirp: the sum fills the nulls."""
    total = sum(
        pulses / frequency * one_way_power(transducer, angles, frequency) ** 2 for pulses, frequency in transducer.chirp
    )
    return np.asarray(total / transducer.chirp_seconds)


@lru_cache(maxsize=8)
def pattern_tables(transducer: Transducer) -> tuple[Floats, Floats, Floats]:
    """Angles (t,) off the axis in the horizontal plane, and the two-way power there: of a point, and of a wall.

    A wall is tall: its power is the integral over elevation, in steradians per radian of azimuth.
    """
    azimuths = np.radians(np.arange(0.0, 90.01, 0.1))
    elevations = np.radians(np.arange(-60.0, 60.01, 0.5))
    off_axis = np.arccos(np.clip(np.cos(azimuths)[:, None] * np.cos(elevations), -1.0, 1.0))
    tall = two_way_power(transducer, off_axis) @ np.cos(elevations) * np.radians(0.5)
    return azimuths, two_way_power(transducer, azimuths), tall
