# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces of a run at several times: where their files are, and how pictures of them are arranged."""
import os

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

import style
from surfaces import draw_surface, extent, read_surface
from table import TableError

LABEL_WIDTH, TITLES, PANEL_GAP, T_LINE, PAGE = 0.26, 0.22, 0.10, 0.17, 8.0  # inches
LOWEST_ROW = 0.44  # its label needs as much
STRIP_GAP = 0.08


class Snapshots:
    """The snapshots of a run: [(t, path)] in the order of time. Raises TableError when an entry is incomplete."""

    def __init__(self, row, folder, stem):
        """`folder` is the table's, where cells/`stem`/CELL/ has the files."""
        self.folder = os.path.join(folder, "cells", stem, str(row.get("cell")))
        try:
            self.files = sorted((float(entry["t"]), self.path(entry["file"]))
                                for entry in row.get("snapshots") or [])
        except (KeyError, TypeError, ValueError) as error:
            raise TableError(f"{row.get('cell', '?')}: snapshots are no list of {{t, file}}") from error
        self.tau = row["tau"]

    def path(self, file):
        """Of a file of the run."""
        return os.path.join(self.folder, file)

    def at(self, t, tau=None):
        """The snapshot closest to t, at most half a step `tau` (the run's own by default) away, or None."""
        near = [file for file in self.files if abs(file[0] - t) <= 0.501 * (tau or self.tau)]
        return min(near, key=lambda file: abs(file[0] - t), default=None)

    def last(self):
        return self.files[-1] if self.files else None


def shared_times(runs):
    """[(t, the snapshot of each run or None)], the times of runs whose steps differ taken together."""
    tau = max(run.tau for run in runs)
    times = []
    for t in sorted(t for run in runs for t, _ in run.files):
        if not times or t - times[-1] > 0.501 * tau:
            times.append(t)
    return [(t, [run.at(t, tau) for run in runs]) for t in times]


def evenly(items, most):
    """`most` of the items at most, the first and the last among them."""
    if len(items) <= most:
        return list(items)
    return [items[i] for i in np.linspace(0, len(items) - 1, most).round().astype(int)]


# --- A grid: a row for each time, a column for each run

def surface_grid(boxes, labels, titles, heading, *, own_scales=False, foot=0.0):
    """(figure, axes[row][column]): panels as high as what they show, and a bar for the scale.

    boxes[row][column]: the `extent` of a surface, or None; every row has one. One scale for all panels, or
    `own_scales` for the columns. `foot`: inches that stay free below the panels.
    """
    columns = len(titles)
    width = (style.WIDTH - LABEL_WIDTH - (columns - 1) * PANEL_GAP) / columns
    widest = np.array([max((row[i][1] - row[i][0] for row in boxes if row[i]), default=0) for i in range(columns)])
    scales = 0.98 * width / (np.where(widest > 0, widest, widest.max()) if own_scales
                             else np.full(columns, widest.max()))
    heights = np.array([1.02 * max(scale * (box[3] - box[2]) for scale, box in zip(scales, row) if box)
                        for row in boxes])
    shrink = min(1.0, (PAGE - foot) / heights.sum())
    scales, heights = shrink * scales, np.maximum(shrink * heights, LOWEST_ROW)
    height = 2 * TITLES + sum(heights) + PANEL_GAP * (len(boxes) - 1) + T_LINE + 0.03 + foot
    figure = Figure(figsize=(style.WIDTH, height))
    figure.text(LABEL_WIDTH / style.WIDTH, 1 - 0.03 / height, heading, va="top")
    for i, title in enumerate(titles):
        x = LABEL_WIDTH + i * (width + PANEL_GAP)
        across, aligned = (x, "left") if own_scales else (x + width / 2, "center")
        figure.text(across / style.WIDTH, 1 - (2 * TITLES - 0.05) / height, title, ha=aligned, va="bottom")
        if own_scales:
            _scale_bar(figure, x + width, 2 * TITLES - 0.11, scales[i], 0.4)
    if not own_scales:
        _scale_bar(figure, style.WIDTH, 0.11, scales[0], 0.55)
    grid, y = [], height - 2 * TITLES
    for row, row_height, label in zip(boxes, heights, labels):
        y -= row_height
        figure.text(0.03 / style.WIDTH, (y + row_height / 2) / height, label, rotation=90, ha="left", va="center",
                    fontsize=8.5)
        grid.append([])
        for column, scale in enumerate(scales):
            x = LABEL_WIDTH + column * (width + PANEL_GAP)
            axes = figure.add_axes([x / style.WIDTH, y / height, width / style.WIDTH, row_height / height])
            axes.set_axis_off()
            box = row[column] or next(filter(None, row))
            middle = (box[0] + box[1]) / 2, (box[2] + box[3]) / 2
            axes.set_xlim(middle[0] - width / scale / 2, middle[0] + width / scale / 2)
            axes.set_ylim(middle[1] - row_height / scale / 2, middle[1] + row_height / scale / 2)
            grid[-1].append(axes)
        y -= PANEL_GAP
    return figure, grid


def _scale_bar(figure, right, below_top, scale, longest):
    """A bar that ends `right` inches from the left, `below_top` inches from the top; `scale` in inches per length."""
    length = max((m * 10.0**d for d in range(-4, 5) for m in (1, 2, 5) if m * 10.0**d * scale <= longest), default=1.0)
    y = 1 - below_top / figure.get_size_inches()[1]
    right, left = (right - 0.03) / style.WIDTH, (right - 0.03 - length * scale) / style.WIDTH
    figure.add_artist(Line2D([left, right], [y, y], color="black", linewidth=0.8, marker="|", markersize=5))
    figure.text(left - 0.06 / style.WIDTH, y, f"{length:g}", ha="right", va="center", fontsize=8)


# --- A strip: all times side by side

class Strip:
    """Surfaces at several times, side by side in one scale, with their times below; sizes in inches."""

    def __init__(self, files, rotation, width):
        """`files`: [(t, path)]; `width` of the whole strip."""
        self.times = [t for t, _ in files]
        self.surfaces = [read_surface(path) for _, path in files]
        self.rotation = rotation
        self.boxes = [extent(surface, rotation) for surface in self.surfaces]
        free = width - STRIP_GAP * (len(files) - 1)
        self.scale = min(free / sum(box[1] - box[0] for box in self.boxes), 2.0 / self._tallest())
        self.left = (free - self.scale * sum(box[1] - box[0] for box in self.boxes)) / 2
        self.pictures = self.scale * self._tallest()
        self.height = self.pictures + T_LINE + 0.08

    def _tallest(self):
        return max(box[3] - box[2] for box in self.boxes)

    def draw(self, figure, left, bottom, **options):
        """Draws the strip with its lower left corner there; `options` of draw_surface, but `colours(surface)`, and
        `label(t)`, what is written below the surface at time t."""
        colours = options.pop("colours", lambda surface: None)
        label = options.pop("label", lambda t: f"$t = {t:.3g}$")
        height, x = figure.get_size_inches()[1], left + self.left
        for t, surface, box in zip(self.times, self.surfaces, self.boxes):
            wide, high = self.scale * (box[1] - box[0]), self.scale * (box[3] - box[2])
            y = bottom + self.height - self.pictures / 2 - high / 2
            axes = figure.add_axes([x / style.WIDTH, y / height, wide / style.WIDTH, high / height])
            axes.set(xlim=box[:2], ylim=box[2:])
            axes.set_axis_off()
            draw_surface(axes, surface, self.rotation, colours=colours(surface), **options)
            figure.text((x + wide / 2) / style.WIDTH, bottom / height, label(t), ha="center", va="bottom", fontsize=8.5)
            x += wide + STRIP_GAP
