# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds places for reference slopes c x^p in a log-log panel: below the data, along the data, touching nothing.

Everything here is in points (1/72 inch) of the panel, origin at its lower left corner.
"""
from dataclasses import dataclass

import numpy as np

GRID = 1.5  # resolution of the map of distances
LINE_CLEARANCE = 6.0  # from a reference line to anything else
LABEL_CLEARANCE = 4.0  # from a label's box to anything else
LABEL_OFFSET = (3.0, 2.0)  # from a reference line to the corner of its label
BORDER = 4.0


@dataclass
class Placement:
    """A reference line from `start` to `end`, and the lower left corner of its label."""
    start: tuple
    end: tuple
    label: tuple


def place_slopes(size, polylines, slopes, label_sizes, owners=None):
    """A Placement for each of `slopes`, or None when they do not all fit.

    `size`: width and height of the panel; `polylines`: arrays (n, 2), the data; `slopes`: dy/dx in points, positive;
    `label_sizes`: width and height of each label. `owners`: for each slope the one of `polylines` below which it goes
    if there is room; None where it goes below all.
    """
    size = np.asarray(size, float)
    to_data = _distance_to(size, polylines)
    below = _below(size, polylines)
    clear = to_data  # of the data and of what has been placed
    placements = []
    for slope, label_size, owner in zip(slopes, label_sizes, owners or [None] * len(slopes)):
        if placements:
            clear = np.minimum(clear, _distances(size, taken))
        label_size = np.asarray(label_size, float)
        placement = None
        if owner is not None:
            free = np.where(_below(size, [owner]), clear, 0)
            placement = _place(size, _distance_to(size, [owner]), free, slope, label_size)
        placement = placement or _place(size, to_data, np.where(below, clear, 0), slope, label_size)
        if placement is None:
            return None
        placements.append(placement)
        box = _box_samples(np.array([placement.label]), label_size)[0]
        taken = np.concatenate([_samples(np.array([placement.start, placement.end])), box])
    return placements


def _distance_to(size, polylines):
    return _distances(size, np.concatenate([_samples(line) for line in polylines]))


def _samples(polyline):
    """Points at most GRID apart along a polyline."""
    points = [polyline[:1]]
    for a, b in zip(polyline[:-1], polyline[1:]):
        n = max(int(np.ceil(np.hypot(*(b - a)) / GRID)), 1)
        points.append(a + (b - a) * np.linspace(0, 1, n + 1)[1:, None])
    return np.concatenate(points)


def _distances(size, points):
    """Distance to the nearest of `points` on a grid over the panel; index [row of y, column of x]."""
    shape = np.ceil(size[::-1] / GRID).astype(int) + 1
    j, i = np.round(points / GRID).astype(int).T
    inside = (i >= 0) & (j >= 0) & (i < shape[0]) & (j < shape[1])
    vertical = np.full(shape, 1e9)
    vertical[i[inside], j[inside]] = 0
    for row in range(1, shape[0]):
        vertical[row] = np.minimum(vertical[row], vertical[row - 1] + 1)
    for row in range(shape[0] - 2, -1, -1):
        vertical[row] = np.minimum(vertical[row], vertical[row + 1] + 1)
    columns = np.arange(shape[1])
    dx2 = (columns[:, None] - columns)**2
    return GRID * np.sqrt([np.min(dx2 + row**2, axis=1) for row in vertical])


def _below(size, polylines):
    """Where no data lie below, on the same grid: there the curves in the asymptotic range are the neighbours."""
    x, y = (GRID * np.arange(np.ceil(length / GRID) + 1) for length in size)
    lowest = np.min([np.interp(x, *line.T, left=np.inf, right=np.inf) for line in polylines], axis=0)
    known = np.isfinite(lowest)
    if not known.any():  # every line is a point between two columns of the grid
        return y[:, None] < np.full(len(x), min(line[:, 1].min() for line in polylines))
    return y[:, None] < np.interp(x, x[known], lowest[known])


def _look_up(field, points):
    """The field at `points` (..., 2); outside the panel 0, as if something were there."""
    j, i = np.moveaxis(np.round(points / GRID).astype(int), -1, 0)
    inside = (i >= 0) & (j >= 0) & (i < field.shape[0]) & (j < field.shape[1])
    return np.where(inside, field[np.clip(i, 0, field.shape[0] - 1), np.clip(j, 0, field.shape[1] - 1)], 0.0)


def _box_samples(corners, size):
    """Points over boxes with the lower left corners (n, 2): (n, m, 2), the corners themselves included."""
    u, v = np.meshgrid(np.linspace(0, size[0], 8), np.linspace(0, size[1], 5))
    return corners[:, None, :] + np.stack([u.ravel(), v.ravel()], axis=-1)


def _place(size, to_data, free, slope, label_size):
    """The best place for one line: as long as possible, its farthest point as near to the data as possible."""
    longest = min(0.4 * size[0], 0.45 * size[1] / slope)
    best, least = None, np.inf
    for width in longest * np.array([1, 0.8, 0.6, 0.45]):
        extent = np.array([width, slope * width])
        x, y = np.meshgrid(*(np.arange(BORDER, s - e - BORDER, 2 * GRID) for s, e in zip(size, extent)))
        starts = np.stack([x.ravel(), y.ravel()], axis=-1)
        for t in np.linspace(0, 1, 25):
            starts = starts[_look_up(free, starts + t * extent) >= LINE_CLEARANCE]
        if not len(starts):
            continue
        along = starts[:, None, :] + extent * np.linspace(0, 1, 25)[:, None]
        length = np.hypot(*extent)
        costs = np.max(_look_up(to_data, along), axis=1) + 0.5 * (np.hypot(longest, slope * longest) - length)
        for fraction in (0.5, 0.35, 0.65, 0.2, 0.8):
            total = costs + 4 * abs(fraction - 0.5)  # the label near the middle
            for side in (1, -1):  # to the right below the line, to the left above it
                shift = fraction * extent + side * np.array([1, -1]) * LABEL_OFFSET
                shift -= np.array([0, label_size[1]]) if side > 0 else np.array([label_size[0], 0])
                better = np.flatnonzero(total < least)
                corner = starts[better] + shift
                better = better[np.all((corner >= BORDER) & (corner + label_size <= size - BORDER), axis=1)]
                boxes = _box_samples(starts[better] + shift, label_size)
                better = better[np.min(_look_up(free, boxes), axis=1) >= LABEL_CLEARANCE]
                if len(better):
                    k = better[np.argmin(total[better])]
                    least = total[k]
                    best = Placement(tuple(starts[k]), tuple(starts[k] + extent), tuple(starts[k] + shift))
    return best
