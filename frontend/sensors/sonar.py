"""The sonar: of all echoes a head hears in one direction, the first over the threshold gives the range."""

from typing import NamedTuple

import numpy as np
from numba import njit

from frontend.scan import Floats, Sensor
from frontend.sensors.echoes import Echoes, echoes_around
from frontend.sensors.surfaces import MATERIALS, Surfaces
from frontend.sensors.transducer import FOOT, INCH, Transducer, pattern_tables

STEP = 0.001  # metres of range per step of the energy detector: a third of the quantum


def half_beam_at(ranges: Floats, transducer: Transducer, albedo: float = MATERIALS["rough"].albedo) -> Floats:
    """How far off the axis (n,) a rough surface at ranges (n,) is still heard, radians: the effective half-beam.

    The surface fills the beam from that angle outwards. Spreading and absorption narrow the beam with the range.
    """
    azimuths, _, of_wall = pattern_tables(transducer)
    beyond = np.cumsum((of_wall * np.diff(azimuths, append=azimuths[-1]))[::-1])[::-1]
    needed = transducer.threshold * np.pi / albedo * ranges**2 * np.exp(2 * transducer.decay * ranges)
    return np.asarray(np.interp(-needed, -beyond, azimuths, left=0.0))


# Blanking, reach and resolution are the paper's. The constant half-beam is what is left of it 3.5 m away.
BEAM_RANGES = (0.3, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0)
# Range by range it holds for surfaces 6 dB fainter than a rough wall: speckle fades echoes, and materials differ.
FAINTER = MATERIALS["rough"].albedo / 4
BEAMS = tuple(zip(BEAM_RANGES, half_beam_at(np.array(BEAM_RANGES), Transducer(), FAINTER).tolist(), strict=True))
SONAR = Sensor(
    kind="sonar_infrared",
    min_range=0.9 * FOOT,
    max_range=35 * FOOT,
    half_beam=np.radians(8.0),
    range_noise=0.01,
    quantum=0.12 * INCH,
    infrared_range=10 * FOOT,
    half_beams=BEAMS,
)


class Gate(NamedTuple):
    """What the detector needs: metres of blanking, of reach and of chirp, and the least energy that is heard."""

    blanking: float
    reach: float
    chirp: float
    threshold: float


def sonar_ranges(
    surfaces: Surfaces, pose: Floats, bearings: Floats, transducer: Transducer, rng: np.random.Generator
) -> Floats:
    """Ranges (n,) read at bearings (n,) by a head standing at `pose` (3,); `inf` where no echo came within reach."""
    echoes = echoes_around(surfaces, pose[:2], transducer, rng)
    ranges = first_echoes(echoes, pose[2] + bearings, transducer) * transducer.stretch
    noisy = ranges + rng.normal(0.0, SONAR.range_noise, ranges.size)
    read = np.round(noisy / SONAR.quantum) * SONAR.quantum
    return np.asarray(np.where(read <= SONAR.max_range, np.maximum(read, SONAR.min_range), np.inf))


def first_echoes(echoes: Echoes, headings: Floats, transducer: Transducer) -> Floats:
    """Ranges (n,) without noise at which a head turned to headings (n,) in the room first hears enough; inf if never.

    The detector adds up what arrives during one chirp, so a weak echo is found late: by up to 7.2 in (§2.1).
    """
    _, of_point, of_wall = pattern_tables(transducer)
    # All the fainter echoes of a place together stay below a hundredth of the threshold.
    faintest = 0.01 * transducer.threshold / max(1, echoes.energies.size)
    audible = echoes.energies * np.where(echoes.tall, of_wall.max(), of_point.max()) > faintest
    columns = np.stack([echoes.directions, echoes.lengths, echoes.energies, echoes.tall], axis=1)[audible]
    gate = Gate(SONAR.min_range, SONAR.max_range, transducer.chirp_length, transducer.threshold)
    return np.asarray(_crossings(headings, columns, np.stack([of_point, of_wall]), gate))


@njit(cache=True)  # type: ignore[untyped-decorator]
def _crossings(headings: Floats, echoes: Floats, power: Floats, gate: Gate) -> Floats:
    per_radian = (power.shape[1] - 1) / (np.pi / 2)
    steps, span = int(np.ceil(gate.reach / STEP)) + 1, round(gate.chirp / STEP)
    found = np.empty(headings.size)
    for h in range(headings.size):
        change = np.zeros(steps + 1)
        for e in range(echoes.shape[0]):
            turn = echoes[e, 0] - headings[h]
            off = abs(turn - 2 * np.pi * np.rint(turn / (2 * np.pi))) * per_radian
            cell = int(off)
            if cell >= power.shape[1] - 1 or echoes[e, 1] >= gate.reach:
                continue
            kind = int(echoes[e, 3])
            heard = echoes[e, 2] * (power[kind, cell] + (off - cell) * (power[kind, cell + 1] - power[kind, cell]))
            start = int(echoes[e, 1] / STEP)
            change[start] += heard / span
            change[min(start + span, steps)] -= heard / span
        found[h] = _first_crossing(change, span, gate.blanking, gate.threshold)
    return found


@njit(cache=True)  # type: ignore[untyped-decorator]
def _first_crossing(change: Floats, span: int, blanking: float, threshold: float) -> float:
    """Range at which the energy of the last `span` steps first exceeds the threshold; infinite if it never does."""
    arriving, energy = 0.0, 0.0
    history = np.zeros(change.size)
    for s in range(change.size):
        arriving += change[s]
        if s * STEP < blanking:
            continue
        history[s] = max(arriving, 0.0)
        gained = history[s] - (history[s - span] if s >= span else 0.0)
        if energy + gained >= threshold:
            crossing: float = (s + (threshold - energy) / gained) * STEP
            return crossing
        energy += gained
    return np.inf
