"""Two clocks in one log: how late the scans are against the wheels, and a scan straightened for the turn of its sweep.

A scanner's lines reach the computer later than the wheels' do. The turn between two scans shows in the scans alone, as
a shift of their profiles along the bearings; the lag is the one at which the wheels turned the same way.
"""

import numpy as np

from frontend.scan import Floats

WIDEST_LAG = 1.0  # seconds that are searched on either side
LAG_STEP = 0.02
FAR_APART = 0.3  # metres past which two readings just differ
WIDEST_TURN = 0.35  # radians between two scans that are searched on either side


def turns_seen(ranges: Floats, beam_step: float) -> Floats:
    """Turn (n − 1,) in radians between successive profiles (n, b): the shift at which they differ least."""
    widest = min(int(WIDEST_TURN / beam_step), (ranges.shape[1] - 1) // 3)
    shifts = np.arange(-widest, widest + 1)
    middle = slice(widest, ranges.shape[1] - widest)
    turns = np.empty(len(ranges) - 1)
    for i in range(len(turns)):
        moved = np.lib.stride_tricks.sliding_window_view(ranges[i], ranges.shape[1] - 2 * widest)
        apart = np.minimum(np.abs(moved - ranges[i + 1, middle]), FAR_APART)
        misfits = np.where(np.isnan(apart), FAR_APART, apart).mean(axis=1)
        turns[i] = shifts[int(np.argmin(misfits))] * beam_step
    return turns


def lag(times: Floats, turns: Floats, wheel_times: Floats, wheel_headings: Floats) -> float:
    """Seconds that scans at `times` (n,) come late: so much earlier, the wheels' turns correlate best with theirs.

    turns: (n − 1,) as seen in the scans; wheel_headings: (m,) unwrapped. 0 where the robot or the scans never turn.
    """
    lags = np.arange(-WIDEST_LAG, WIDEST_LAG + LAG_STEP / 2, LAG_STEP)
    wheels = np.array([np.diff(np.interp(times - late, wheel_times, wheel_headings)) for late in lags])
    lengths = np.linalg.norm(wheels, axis=1) * np.linalg.norm(turns)
    if len(turns) < 2 or not lengths.all():
        return 0.0
    return float(lags[int(np.argmax(wheels @ turns / lengths))])


def straighten(
    bearings: Floats, ranges: Floats, sweep_poses: Floats, pose: Floats, ahead: float
) -> tuple[Floats, Floats]:
    """Bearings (b,) and ranges (b,) as if all had been read at `pose` (3,).

    sweep_poses: (b, 3) odometry at each reading's own time. ahead: metres of the scanner before the axle.
    """
    x, y = ranges * np.cos(bearings) + ahead, ranges * np.sin(bearings)
    turned = sweep_poses[:, 2] - pose[2]
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    shift = (sweep_poses[:, :2] - pose[:2]) @ np.array([[cosine, -sine], [sine, cosine]])
    forward = np.cos(turned) * x - np.sin(turned) * y + shift[:, 0] - ahead
    left = np.sin(turned) * x + np.cos(turned) * y + shift[:, 1]
    unseen = ~np.isfinite(ranges)
    straight = np.where(unseen, bearings + turned, np.arctan2(left, forward))
    # Near a depth step two beams may cross: order is kept, by less than a beam.
    order = np.maximum.accumulate(straight + 1e-9 * np.arange(len(straight)))
    return order, np.where(unseen, ranges, np.hypot(forward, left))
