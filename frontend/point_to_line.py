"""Point to line, compiled: the nearest face that looks the same way, and Gauss–Newton steps on the distance to it."""

import numpy as np

from frontend.compiled import compiled
from frontend.scan import Booleans, Floats, Integers

SETTLED = 0.01  # a pass ends when a step moves no surface by more than this share of its Cauchy width
FAR = 5.0  # metres; about where the surface lies that a turn moves


@compiled
def faces_towards(points: Floats, normals: Floats, viewpoint: Floats, reach: float) -> tuple[Floats, Floats]:
    """Those of the points (k, 2) and normals (k, 2) that turn their face to a viewpoint (2,) within the reach."""
    kept = np.empty(len(points), np.int64)
    found = 0
    for i in range(len(points)):
        dx, dy = viewpoint[0] - points[i, 0], viewpoint[1] - points[i, 1]
        if dx * normals[i, 0] + dy * normals[i, 1] > 0 and dx * dx + dy * dy < reach * reach:
            kept[found] = i
            found += 1
    chosen, facing = np.empty((found, 2)), np.empty((found, 2))
    for k in range(found):
        for axis in range(2):
            chosen[k, axis], facing[k, axis] = points[kept[k], axis], normals[kept[k], axis]
    return chosen, facing


@compiled
def sort_into_cells(points: Floats, cell: float) -> tuple[Integers, Integers, Floats, int, int]:
    """Grid over points (k, 2): order (k,), start of each cell (c + 1,), corner (2,), columns, rows."""
    corner = np.array([points[:, 0].min(), points[:, 1].min()]) - 1e-9
    columns = int((points[:, 0].max() - corner[0]) / cell) + 1
    rows = int((points[:, 1].max() - corner[1]) / cell) + 1
    cells = np.empty(len(points), np.int64)
    counts = np.zeros(columns * rows + 1, np.int64)
    for i in range(len(points)):
        cells[i] = int((points[i, 0] - corner[0]) / cell) * rows + int((points[i, 1] - corner[1]) / cell)
        counts[cells[i] + 1] += 1
    first = np.cumsum(counts)
    free = first[:-1].copy()
    order = np.empty(len(points), np.int64)
    for i in range(len(points)):
        order[free[cells[i]]] = i
        free[cells[i]] += 1
    return order, first, corner, columns, rows


@compiled
def nearest_face(
    point: Floats, normal: Floats, points: Floats, normals: Floats,
    first: Integers, corner: Floats, columns: int, rows: int, limits: Floats,
) -> int:  # fmt: skip
    """Index of the nearest of the cell-sorted points (k, 2), or −1. limits: cell, reach, least cosine of normals.

    Cells are looked through ring by ring, until none farther out can hold anything nearer.
    """
    cell, alike = limits[0], limits[2]
    x, y = (point[0] - corner[0]) / cell, (point[1] - corner[1]) / cell
    u, v = int(np.floor(x)), int(np.floor(y))
    # Nothing outside a ring is nearer than the way from the point to its own cell's border, and the rings between.
    border = min(x - u, u + 1 - x, y - v, v + 1 - y) * cell
    partner, best = -1, limits[1] * limits[1]
    for ring in range(int(np.ceil(limits[1] / cell)) + 1):
        if ring > 0 and (border + (ring - 1) * cell) ** 2 >= best:
            break
        for column in range(max(u - ring, 0), min(u + ring + 1, columns)):
            stride = 1 if abs(column - u) == ring else 2 * ring
            for row in range(v - ring, v + ring + 1, stride):
                if row < 0 or row >= rows:
                    continue
                for j in range(first[column * rows + row], first[column * rows + row + 1]):
                    dx, dy = points[j, 0] - point[0], points[j, 1] - point[1]
                    d = dx * dx + dy * dy
                    if d < best and normal[0] * normals[j, 0] + normal[1] * normals[j, 1] > alike:
                        partner, best = j, d
    return partner


@compiled
def lying_on(
    placed: Floats, turned: Floats, points: Floats, normals: Floats,
    first: Integers, corner: Floats, columns: int, rows: int, limits: Floats,
) -> tuple[Booleans, Booleans]:  # fmt: skip
    """(n,) which placed points and normals (n, 2) have cell-sorted faces (k, 2) near, and which lie on the line of the
    most alike of these: the nearest by place and facing side, a unit of normal counting as a metre.

    limits: cell, metres that are near, metres across a face's line that lie on it.
    """
    near, on = np.zeros(len(placed), np.bool_), np.zeros(len(placed), np.bool_)
    cell, reach = limits[0], limits[1]
    for i in range(len(placed)):
        x, y = placed[i, 0] - corner[0], placed[i, 1] - corner[1]
        best, across = reach * reach, np.inf
        for column in range(max(int((x - reach) // cell), 0), min(int((x + reach) // cell), columns - 1) + 1):
            low, high = max(int((y - reach) // cell), 0), min(int((y + reach) // cell), rows - 1)
            if low > high:
                continue
            # The cells of a column lie behind one another.
            for j in range(first[column * rows + low], first[column * rows + high + 1]):
                dx, dy = placed[i, 0] - points[j, 0], placed[i, 1] - points[j, 1]
                apart = dx * dx + dy * dy
                if apart >= reach * reach:
                    continue
                near[i] = True
                apart += (turned[i, 0] - normals[j, 0]) ** 2 + (turned[i, 1] - normals[j, 1]) ** 2
                if apart < best:
                    best, across = apart, abs(dx * normals[j, 0] + dy * normals[j, 1])
        on[i] = across < limits[2]
    return near, on


@compiled
def linearise(
    own: Floats, own_normals: Floats, points: Floats, normals: Floats,
    first: Integers, corner: Floats, columns: int, rows: int, pose: Floats, limits: Floats,
) -> tuple[Floats, Floats, float, Integers]:  # fmt: skip
    """Information (3, 3), gradient (3,), weighted mean square and partners (n,) at `pose`.

    limits: cell, reach, least cosine of the normals, Cauchy width.
    """
    information, gradient, row = np.zeros((3, 3)), np.zeros(3), np.empty(3)
    partners = np.full(len(own), -1, np.int64)
    square, weights = 0.0, 0.0
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    placed, turned = np.empty(2), np.empty(2)
    for i in range(len(own)):
        x, y = cosine * own[i, 0] - sine * own[i, 1], sine * own[i, 0] + cosine * own[i, 1]
        placed[0], placed[1] = x + pose[0], y + pose[1]
        turned[0] = cosine * own_normals[i, 0] - sine * own_normals[i, 1]
        turned[1] = sine * own_normals[i, 0] + cosine * own_normals[i, 1]
        j = nearest_face(placed, turned, points, normals, first, corner, columns, rows, limits)
        partners[i] = j
        if j < 0:
            continue
        row[0], row[1] = normals[j, 0], normals[j, 1]
        row[2] = row[1] * x - row[0] * y
        e = row[0] * (placed[0] - points[j, 0]) + row[1] * (placed[1] - points[j, 1])
        w = 1.0 / (1.0 + (e / limits[3]) ** 2)
        for r in range(3):
            gradient[r] += w * row[r] * e
            for c in range(3):
                information[r, c] += w * row[r] * row[c]
        square += w * e * e
        weights += w
    return information, gradient, square / max(weights, 1e-12), partners


@compiled
def descend(
    own: Floats, own_normals: Floats, points: Floats, normals: Floats,
    first: Integers, corner: Floats, columns: int, rows: int,
    start: Floats, guess: Floats, prior: Floats, passes: Floats,
) -> tuple[Floats, Floats, float, Integers]:  # fmt: skip
    """Gauss–Newton from `start`, pulled to `guess` by the information `prior` (3, 3).

    passes: (p, 5) rows of cell, reach, least cosine, Cauchy width, rounds. Returns the pose (3,), the information
    (3, 3) of the surface alone for an error of one metre, the mean square error and the partners (n,) of the last pass.
    """
    pose = start.copy()
    for k in range(len(passes)):
        pull = prior * passes[k, 3] ** 2 + 1e-6 * np.eye(3)
        for _ in range(int(passes[k, 4])):
            information, gradient, _, partners = linearise(
                own, own_normals, points, normals, first, corner, columns, rows, pose, passes[k]
            )
            offset = pose - guess
            offset[2] = (offset[2] + np.pi) % (2 * np.pi) - np.pi
            move = -np.linalg.solve(information + pull, gradient + pull @ offset)
            pose = pose + move
            settled = SETTLED * passes[k, 3]
            if abs(move[0]) + abs(move[1]) < settled and abs(move[2]) < settled / FAR:
                break
    information, _, square, partners = linearise(
        own, own_normals, points, normals, first, corner, columns, rows, pose, passes[len(passes) - 1]
    )
    return pose, information, square, partners


@compiled
def in_order(points: Floats, normals: Floats, order: Integers) -> tuple[Floats, Floats]:
    """The points and normals (k, 2) in another order (k,)."""
    sorted_points, sorted_normals = np.empty_like(points), np.empty_like(normals)
    for k in range(len(order)):
        for axis in range(2):
            sorted_points[k, axis], sorted_normals[k, axis] = points[order[k], axis], normals[order[k], axis]
    return sorted_points, sorted_normals


@compiled
def paired(
    own: Floats, readings: Integers, points: Floats, normals: Floats, partners: Integers, pose: Floats, lags: int
) -> tuple[Integers, float]:
    """Pairs (p, 2) of own points (n, 2) at `pose` and partners (n,), and how many of their errors are worth one."""
    count = int(np.count_nonzero(partners >= 0))
    pairs, errors, read = np.empty((count, 2), np.int64), np.empty(count), np.empty(count, np.int64)
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    k = 0
    for i in range(len(partners)):
        j = partners[i]
        if j >= 0:
            x = cosine * own[i, 0] - sine * own[i, 1] + pose[0] - points[j, 0]
            y = sine * own[i, 0] + cosine * own[i, 1] + pose[1] - points[j, 1]
            pairs[k, 0], pairs[k, 1] = i, j
            errors[k], read[k] = x * normals[j, 0] + y * normals[j, 1], readings[i]
            k += 1
    return pairs, shared_errors(errors, read, lags)


@compiled
def shared_errors(errors: Floats, readings: Integers, lags: int) -> float:
    """How many of the errors (p,) at rising readings (p,) are worth one that is independent of all others, 1 or more.

    One and twice the sum of their correlations up to so many readings apart (Bartlett 1946).
    """
    square, shared = 0.0, 1.0
    for i in range(len(errors)):
        square += errors[i] * errors[i] / len(errors)
    for lag in range(1, lags + 1):
        product, pairs, j = 0.0, 0, 0
        for i in range(len(errors)):
            while j < len(errors) and readings[j] < readings[i] + lag:
                j += 1
            if j < len(errors) and readings[j] == readings[i] + lag:
                product += errors[i] * errors[j]
                pairs += 1
        if pairs > 0 and square > 0:
            shared += 2 * product / (pairs * square)
    return max(shared, 1.0)
