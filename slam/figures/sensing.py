"""What one scan went through: the beam that heard it, its codes, its boundary before and after, and its scale space."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from frontend.contour import Contour, ContourKind, EdgeKind
from frontend.landmarks import LandmarkSettings, thresholds
from frontend.primal_sketch import PrimalSketch, chains
from frontend.scale_space import ScaleSpace, scale_space, track_paths
from frontend.scan import Booleans, Floats, Integers, Sensor
from frontend.sensors.sonar import half_beam_at
from frontend.sensors.transducer import Transducer, one_way_power, two_way_power
from slam.perception import Percept

INK, FAINT, FAKE, OPENED, FAR = "#1b1b1b", "#9a9a9a", "#d98c00", "#009e73", "#0b62a8"
EVERY = 4  # readings between two codes written beside the boundary
FLOOR = -60.0  # decibels


def sensing_figures(percepts: Sequence[Percept]) -> dict[str, Figure]:
    """By name, the figures that this recording allows; of the view with the most openings, then with the most knots."""
    if not percepts:
        return {}
    view = max(percepts, key=lambda percept: (len(percept.fused.openings), len(percept.knots.positions)))
    found = {"8c_before_and_after": before_and_after(view), "8d_scale_space": scale_space_tracks(view)}
    if view.scan.sensor.kind == "sonar_infrared":
        found["8a_beam"] = beam_pattern(view.scan.sensor)
    if view.scan.infrared is not None:
        found["8b_codes"] = infrared_codes(view)
    return found


def beam_pattern(sensor: Sensor) -> Figure:
    """Power over the angle off the axis, of a tone and of the whole chirp, and how far off the axis a wall is heard."""
    figure = Figure(figsize=(12, 4.6), layout="constrained")
    lobes, reach = figure.subplots(1, 2)
    transducer, angles = Transducer(), np.radians(np.arange(-60.0, 60.01, 0.1))
    tone = transducer.chirp[-1][1]
    for power, ink, label in (
        (one_way_power(transducer, angles, tone), FAINT, f"one way, {tone / 1e3:.1f} kHz alone"),
        (np.sqrt(two_way_power(transducer, angles)), INK, "one way, summed over the chirp"),
        (two_way_power(transducer, angles), FAR, "there and back, summed over the chirp"),
    ):
        lobes.plot(np.degrees(angles), 10 * np.log10(np.maximum(power, 1e-9)), color=ink, linewidth=1.2, label=label)
    lobes.axhline(-3, color=FAKE, linewidth=0.8, linestyle="dashed", label="−3 dB")
    lobes.set(title="beam of the sonar", xlabel="off the axis (°)", ylabel="power (dB)", ylim=(FLOOR, 20))
    lobes.legend(fontsize=8, loc="upper right")
    ranges = np.linspace(max(sensor.min_range, 0.2), sensor.max_range, 200)
    reach.plot(ranges, np.degrees(half_beam_at(ranges, transducer)), color=INK, label="a rough wall is heard")
    stated = np.degrees([sensor.half_beam_at(metres) for metres in ranges])
    reach.plot(ranges, stated, color=OPENED, linestyle="dashed", label="what the recording states, and is undone")
    reach.set(title="effective half-beam", xlabel="range (m)", ylabel="off the axis (°)", ylim=(0, None))
    reach.legend(fontsize=8)
    return figure


def infrared_codes(percept: Percept) -> Figure:
    """The boundary as the sonar read it, joined by filler points, with the infrared's code beside each few readings."""
    figure = Figure(figsize=(9, 8), layout="constrained")
    axes = figure.subplots()
    contour, scan, codes = percept.contour, percept.scan, percept.scan.infrared
    if codes is None:
        raise ValueError("this scan has no infrared codes")
    ends = percept.raw_ends
    axes.plot(*np.vstack([ends, ends[:1]]).T, "-", color=FAINT, linewidth=0.7, label="joined readings")
    silent = np.isin(codes, (30, 40))
    axes.plot(*ends[~silent].T, ".", color=INK, markersize=4, label="infrared detects")
    axes.plot(*ends[silent].T, ".", color=FAKE, markersize=4, label="infrared detects nothing")
    filler = contour.points[contour.kinds == ContourKind.FILLER]
    axes.plot(*filler.T, "+", color=FAR, markersize=3, label="filler points of the redrawn boundary")
    for edge in percept.fused.edges:
        reach = scan.sensor.infrared_range or scan.sensor.max_range
        far = percept.fused.origin + reach * np.array([np.cos(edge.bearing), np.sin(edge.bearing)])
        axes.plot(*np.vstack([percept.fused.origin, far]).T, "--", color=OPENED, linewidth=0.9)
    outward = ends * (1 + 0.18 / np.maximum(np.hypot(*ends.T), 1e-9))[:, None]
    for place, code in zip(outward[::EVERY], codes[::EVERY], strict=True):
        axes.annotate(f"{code:02d}", place, fontsize=5.5, ha="center", va="center", color=INK)
    axes.plot(0, 0, "o", color=FAR, markersize=6)
    _room(axes, f"infrared codes; {len(percept.fused.edges)} valid edges dashed")
    axes.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return figure


def before_and_after(percept: Percept) -> Figure:
    """The boundary as the sensor read it, and after fusion: surface, lines of sight and the arcs of openings."""
    figure = Figure(figsize=(13, 6), layout="constrained")
    before, after = figure.subplots(1, 2, sharex=True, sharey=True)
    ends = percept.raw_ends
    before.fill(*ends.T, facecolor="#dce9f5", edgecolor=INK, linewidth=0.9)
    _room(before, "before")
    contour = percept.contour
    after.fill(*contour.points.T, facecolor="#dce9f5", edgecolor="none")
    for kind, ink, style, label in (
        (EdgeKind.REAL, INK, "solid", "surface"),
        (EdgeKind.OCCLUSION, FAKE, "dotted", "line of sight"),
        (EdgeKind.NO_RETURN, FAINT, "dotted", "no return, or inferred"),
        (EdgeKind.DOOR_ARC, OPENED, "solid", "arc of an opening"),
    ):
        pieces = edges_of_kind(contour, kind)
        if len(pieces):
            after.add_collection(
                LineCollection(list(pieces), colors=ink, linestyles=style, linewidths=1.5, label=label)
            )
    _room(after, f"after, openings redrawn: {len(percept.fused.openings)}")
    after.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return figure


def scale_space_tracks(percept: Percept) -> Figure:
    """The surface of a view with the most knots, and its turns at every scale with the tracks of its knots."""
    figure = Figure(figsize=(13, 5), layout="constrained")
    place, scales = figure.subplots(1, 2, width_ratios=(1, 1.6))
    traced, settings = percept.outline, percept.settings.sketch.landmarks
    vertices = traced.vertices
    points = traced.points[vertices]
    found = [chain for chain in chains(traced.edge_kinds[vertices]) if chain.size >= 2 * settings.least_points]
    if not found:
        place.set(title="no surface long enough for a scale space")
        return figure
    chain = max(found, key=lambda one: (np.sum(_knots_on(one, percept.sketch, points)), _length(points[one])))
    noise = float(np.mean(traced.spread[vertices[chain]]))
    _draw_scale_space(scales, points[chain], noise, settings)
    _draw_chain(place, points, chain, percept.sketch)
    return figure


def _draw_scale_space(axes: Axes, chain: Floats, noise: float, settings: LandmarkSettings) -> None:
    """Turns over arc length and scale, finer scales than the search uses in between, with the tracks."""
    sigmas = settings.finest * np.sqrt(2.0) ** np.linspace(0, settings.scales - 1, 8 * settings.scales - 7)
    space = scale_space(chain, sigmas, settings.spacing)
    turns = np.degrees(space.turns)
    image = axes.pcolormesh(space.arc_length, sigmas, turns, cmap="RdBu_r", vmin=-100, vmax=100, shading="nearest")
    axes.figure.colorbar(image, ax=axes, label="turn of a corner there (°)")
    floors = thresholds(sigmas, noise, _length(chain) / (len(chain) - 1), settings.limits)
    for path in _long_tracks(space, floors):
        axes.plot(space.arc_length[path[:, 1]], sigmas[path[:, 0]], "-", color=INK, linewidth=1.4)
        axes.plot(space.arc_length[path[0, 1]], sigmas[path[0, 0]], "o", color=INK, markersize=5)
    axes.set(title="its scale space, with the tracks of the knots", xlabel="along the surface (m)", ylabel="σ (m)")
    axes.set_yscale("log")
    axes.set_yticks(settings.sigmas, [f"{sigma:.2f}" for sigma in settings.sigmas])
    axes.minorticks_off()


def _long_tracks(space: ScaleSpace, floors: Floats) -> list[Integers]:
    """Tracks that outlive noise: over at least a factor √2 of scale."""
    return [path for path in track_paths(space, floors) if space.sigmas[path[-1, 0]] >= 1.4 * space.sigmas[path[0, 0]]]


def _draw_chain(axes: Axes, points: Floats, chain: Integers, sketch: PrimalSketch) -> None:
    axes.plot(*points.T, ".", color=FAINT, markersize=3)
    axes.plot(*points[chain].T, "-", color=INK, linewidth=1.5)
    axes.plot(*points[chain[0]], "s", color=FAR, markersize=10, label="the surface begins")
    inside = _knots_on(chain, sketch, points)
    axes.plot(*sketch.positions[inside].T, "o", color="#c23b80", markersize=6, label="landmark knots")
    _room(axes, "the surface with the most knots")
    axes.legend(fontsize=8)


def _knots_on(chain: Integers, sketch: PrimalSketch, points: Floats) -> Booleans:
    """Which landmark knots (k,) lie on a chain of the vertices."""
    return np.isin(np.floor(sketch.readings).astype(np.int64) % len(points), chain) & sketch.landmark


def _length(chain: Floats) -> float:
    return float(np.sum(np.hypot(*np.diff(chain, axis=0).T)))


def edges_of_kind(contour: Contour, kind: EdgeKind) -> Floats:
    """(e, 2, 2) the contour's edges of one kind."""
    starts = np.flatnonzero(contour.edge_kinds == kind)
    return np.stack([contour.points[starts], contour.points[(starts + 1) % len(contour.points)]], axis=1)


def _room(axes: Axes, title: str) -> None:
    axes.set(title=title, aspect="equal", xlabel="x (m)", ylabel="y (m)")
