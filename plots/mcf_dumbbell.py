# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures 13.3-13.6 of Kovács, Li, Lubich (2019): mean curvature flow of a dumbbell up to the pinch.

Usage: python3 plots/mcf_dumbbell.py results/paper/mcf_dumbbell.json figures
Writes figures/kll19/fig13_3 .. fig13_6.{pdf,png}, and fig13_3_good_start: the surfaces as in Figure 13.3, but with
accurate starting values, a small step size, and the method of Barrett, Garcke and Nürnberg (BGN) beside the others.
"""
import json
import math
import os
from dataclasses import dataclass

import numpy as np
from matplotlib import ticker
from matplotlib.figure import Figure

import style
import time_series
from script import run
from snapshots import Snapshots, surface_grid
from surfaces import draw_surface, extent, read_surface, smallest_angles, view
from table import TableError, has_series, label_of, series

REFERENCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "reference", "independent",
                         "dumbbell_axisymmetric.json")
STEM = "mcf_dumbbell"
PAPER_TAU = 0.003
TIMES = (0, 0.03, 0.06, 0.072, 0.075, 0.078, 0.084, 0.09)  # of Figure 13.3, up to and beyond the pinch
SMALL_ANGLE = 15  # degrees: elements with a smaller one are orange
ZOOM = 0.07  # where the blow-up begins

LABELS = {"dziuk": "Dziuk", "kll": "(5.1)", "kll_normalised": r"(5.1), $\nu_h$ normalised",
          "kll_alpha1": r"(5.1), $\alpha = 1$", "kll_alpha10": r"(5.1), $\alpha = 10$",
          "kll_alpha100": r"(5.1), $\alpha = 100$", "bgn": "BGN", "bgn_p1": "BGN, linear elements",
          "kll_interpolated": "(5.1), $v_h$ interpolated"}
LINES = {"dziuk": {"color": style.VERMILLION, "linestyle": style.DASHES["dashed"]},
         "kll": {"color": style.BLUE, "linestyle": style.DASHES["solid"], "zorder": 1.9},  # below the others' dashes
         "kll_normalised": {"color": style.GREEN, "linestyle": style.DASHES["dash-dot"]},
         "kll_alpha1": {"color": style.SKY_BLUE, "linestyle": style.DASHES["short"]},
         "kll_alpha10": {"color": style.ORANGE, "linestyle": style.DASHES["dash-dot-dot"]},
         "kll_alpha100": {"color": "#7A6A00", "linestyle": style.DASHES["long"]},
         "bgn": {"color": style.PURPLE, "linestyle": style.DASHES["dotted"]},
         "bgn_p1": {"color": "#8F4B73", "linestyle": style.DASHES["sparse"]},
         "kll_interpolated": {"color": "#555555", "linestyle": (0, (3, 2.5))}}
for line, marker in zip(LINES.values(), ("o", "s", "^", "v", "D", "p", "*", "x", "<")):
    line.update(linewidth=1.15, marker=marker, markersize=5 if marker == "*" else 3.6, markerfacecolor="white",
                markeredgewidth=0.8)
REFERENCE_LINE = {"color": "black", "linewidth": 0.7}
STARTS = {"cascade": "first step by backward Euler", "exact": "exact starting values"}


def method_of(row):
    """The name in LABELS of the method of a run: a flow, with its variant or degree."""
    flow = label_of(row, "flow")
    if flow == "mean_curvature":
        variant = label_of(row, "variant")
        return "kll" if variant == "plain" else f"kll_{variant}"
    return "bgn_p1" if flow == "bgn" and label_of(row, "degree") == 1 else flow


@dataclass
class Setting:
    """Runs of different methods with the same mesh, step size and starting procedure."""
    start: str
    tau: float
    nodes: int
    runs: dict  # method -> row; those of BGN may have another step size

    def steps(self):
        """Step size and start."""
        substeps = self.start.partition("substeps:")[2]
        start = f"start with {substeps} substeps a step" if substeps else STARTS.get(self.start, self.start)
        return rf"$\tau = {self.tau:.3g}$, {start}"

    def heading(self, methods):
        """Mesh, step size and start, and the numbers of those methods that have others."""
        others = ""
        for method, row in self.runs.items():
            nodes = "" if row["nodes"] == self.nodes else style.nodes_label(row["nodes"])
            tau = "" if _same(row["tau"], self.tau) else rf"$\tau = {row['tau']:.3g}$"
            if method in methods and (nodes or tau):
                others += f"; {LABELS[method]}: " + ", ".join(filter(None, (nodes, tau)))
        return f"{style.nodes_label(self.nodes)}, {self.steps()}{others}"


def paper_setting(rows):
    """The runs of the paper: one backward Euler step at the start, tau = 0.003, the finest mesh; None if none are."""
    candidates = _finest(rows, "cascade")
    if not candidates:
        return None
    tau = min((row["tau"] for row in candidates), key=lambda tau: abs(math.log(tau / PAPER_TAU)))
    return _setting(rows, candidates, tau, bgn_tau=tau)


def good_setting(rows):
    """The runs with accurate starting values on the finest mesh, with the smallest tau that most methods have."""
    candidates = _finest(rows, "substeps")
    if not candidates:
        return None
    count = {row["tau"]: sum(_same(row["tau"], other["tau"]) for other in candidates) for row in candidates}
    return _setting(rows, candidates, min(tau for tau in count if count[tau] == max(count.values())), bgn_tau=0)


def _same(a, b):
    return math.isclose(a, b, rel_tol=1e-6)


def _finest(rows, start):
    """Without BGN's scheme: it is a one-step method, and needs no starting procedure."""
    found = [row for row in rows if has_series(row) and method_of(row) in LABELS and label_of(row, "flow") != "bgn"
             and label_of(row, "start", "").startswith(start)]
    return [row for row in found if row.get("level", 0) == max(other.get("level", 0) for other in found)]


def _setting(rows, candidates, tau, bgn_tau):
    """The candidates with step size tau, and the runs of BGN at that level whose step size is closest to bgn_tau."""
    runs = {method_of(row): row for row in candidates if _same(row["tau"], tau)}
    for method in ("bgn", "bgn_p1"):
        others = [row for row in rows if has_series(row) and method_of(row) == method
                  and row.get("level", 0) == candidates[0].get("level", 0)]
        if others and method not in runs:
            runs[method] = min(others, key=lambda row: abs(row["tau"] - bgn_tau))
    first = next(row for row in candidates if _same(row["tau"], tau))
    return Setting(label_of(first, "start"), first["tau"], first["nodes"], {m: runs[m] for m in LABELS if m in runs})


# --- Figure 13.3: the surfaces

def surfaces_figure(setting, methods, folder):
    """A grid of surfaces, a column for each method that has snapshots, a row for each time; None without any.

    One scale for all panels. The last panel of a run that becomes singular is the surface at which it stops.
    """
    found = {method: Snapshots(setting.runs[method], folder, STEM) for method in methods if method in setting.runs}
    found = {method: snapshots for method, snapshots in found.items() if snapshots.files}
    if not found:
        return None
    columns = [_surfaces_at(TIMES, setting.runs[method], snapshots) for method, snapshots in found.items()]
    rows = [(t, files) for t, *files in zip(TIMES, *columns) if any(files)]
    rotation = view(18)
    surfaces = [[file and read_surface(file[1]) for file in files] for _, files in rows]
    boxes = [[surface and extent(surface, rotation) for surface in row] for row in surfaces]
    notes = [rf"Orange: elements with an angle below {SMALL_ANGLE}°."]
    if any("singular_surface" in setting.runs[method] for method in found):
        notes = [notes[0] + " A column ends with the surface at which its run stops: the computed one, or the one",
                 "extrapolated for the next step, where that is already degenerate."]
    figure, grid = surface_grid(boxes, [f"$t = {t:g}$" for t, _ in rows], [LABELS[method] for method in found],
                                setting.heading(found), foot=time_series.LINE * len(notes))
    for axes_row, (_, files), surface_row in zip(grid, rows, surfaces):
        for axes, file, surface in zip(axes_row, files, surface_row):
            if surface is None:
                continue
            draw_surface(axes, surface, rotation, facets_per_side=2, marked=smallest_angles(surface) < SMALL_ANGLE)
            if file[2]:
                axes.text(0.5, 0, file[2], transform=axes.transAxes, ha="center", va="top", fontsize=8)
    time_series.add_notes(figure, notes)
    return figure


def _surfaces_at(times, row, snapshots):
    """For each time (t, path, what is written below) or None; the surface at which the run stops has the next time."""
    last = row.get("singular_surface")
    found = []
    for before, t in zip((-1, *times), times):
        file = snapshots.at(t)
        if file:
            found.append((*file, ""))
        elif last and before + 1e-9 < last["t"] <= t + 1e-9:
            kind = "extrapolated, " if last["extrapolated"] else ""
            found.append((last["t"], snapshots.path(last["file"]), f"stops: {kind}$t = {last['t']:.5g}$"))
        else:
            found.append(None)
    return found


# --- Figure 13.4: the neck

NECK_WINDOW = 0.36, 0.105  # half the length and half the height of the close-up


def neck_figure(panels, folder):
    """Close-ups of the last surface of runs: panels is [(heading, row)]; None when none has a snapshot."""
    panels = [(heading, row, Snapshots(row, folder, STEM).last()) for heading, row in panels]
    panels = [panel for panel in panels if panel[2]]
    if not panels:
        return None
    left, right, title, gap, below = 0.5, 0.06, 0.2, 0.08, 0.36
    width = style.WIDTH - left - right
    panel_height = width * NECK_WINDOW[1] / NECK_WINDOW[0]
    height = len(panels) * (title + panel_height + gap) + below
    figure = Figure(figsize=(style.WIDTH, height))
    for i, (heading, row, (t, path)) in enumerate(panels):
        y = height - (i + 1) * (title + panel_height) - i * gap
        axes = figure.add_axes([left / style.WIDTH, y / height, width / style.WIDTH, panel_height / height])
        surface = read_surface(path)
        window = (-NECK_WINDOW[0], NECK_WINDOW[0], -NECK_WINDOW[1], NECK_WINDOW[1])
        draw_surface(axes, surface, view(0), facets_per_side=8, linewidth=0.5, window=window)
        axes.set_xlim(window[:2])
        axes.set_ylim(window[2:])
        axes.set_ylabel("$x_1$", labelpad=1)
        radius = _value_at(row, "neck_radius", t)
        neck = "" if radius is None else f", neck radius {radius:.3g}"
        axes.set_title(f"{heading}: $t = {t:.5g}${neck}", loc="left", pad=3)
        if i < len(panels) - 1:
            axes.tick_params(labelbottom=False)
    axes.set_xlabel("$x_3$", labelpad=1)
    return figure


def _value_at(row, name, t):
    found = series(row, name)
    return None if found is None else found[1][np.argmin(abs(found[0] - t))]


# --- Figures 13.5 and 13.6: curvature, mesh quality and length of the normal over time

def reference_curvature(start):
    """(t, max H, pinch time T) of the axisymmetric reference from a time `start` on.

    Between its rows, H at the neck times sqrt(T - t), which varies slowly, is interpolated; so is max H as long as it
    is attained elsewhere.
    """
    with open(REFERENCE, encoding="utf-8") as file:
        reference = json.load(file)
    columns = dict(zip(reference["columns"], np.array(reference["rows"]).T))
    pinch = reference["pinch"]
    remaining = np.geomspace(pinch - start, pinch - columns["t"][-1], 500)
    t = pinch - remaining
    scaled = columns["H_neck"] * np.sqrt(pinch - columns["t"])
    neck = np.interp(-np.log(remaining), -np.log(pinch - columns["t"]), scaled) / np.sqrt(remaining)
    elsewhere = columns["z_of_Hmax"] > 0
    times, values = columns["t"][elsewhere], columns["Hmax"][elsewhere]
    slope = (values[-1] - values[-2]) / (times[-1] - times[-2])
    bulge = np.interp(t, times, values) + slope * np.clip(t - times[-1], 0, None)
    return t, np.maximum(neck, bulge), pinch


def _legend(settings, names):
    """{label: line style} of the methods that have one of these series."""
    shown = [method for method in LABELS
             if any(method in setting.runs and any(series(setting.runs[method], name) for name in names)
                    for setting in settings)]
    return {LABELS[method]: LINES[method] for method in shown}


def _end(settings, name, pinch):
    """The last time of all runs that have a series, the pinch at least."""
    found = [series(row, name) for setting in settings for row in setting.runs.values()]
    return max([pinch] + [t[-1] for t, _ in filter(None, found)])


def curvature_figure(settings, notes):
    """Figure 13.5: max H of all methods, its blow-up beside the axisymmetric reference, and below the smallest angle.

    None without such series.
    """
    legend = _legend(settings, ("max_H", "worst_angle"))
    if not legend:
        return None
    headings = [[setting.heading(setting.runs), ""] for setting in settings]
    headings.append([setting.steps() for setting in settings])
    t, H, pinch = reference_curvature(ZOOM)
    legend[f"axisymmetric reference, pinch at $t = {pinch:.4f}$"] = REFERENCE_LINE
    figure, grid = time_series.panels(headings, legend, notes)
    end = _end(settings, "max_H", pinch)
    for setting, (whole, blow_up) in zip(settings, grid):
        time_series.scale(whole, _draw_runs(whole, setting, "max_H", (0, end)), logarithmic=True)
        values = _draw_runs(blow_up, setting, "max_H", (ZOOM, end))
        shown = H <= 1.5 * max(values, default=20)
        blow_up.plot(t[shown], H[shown], **REFERENCE_LINE)
        time_series.scale(blow_up, np.append(values, H[shown]), logarithmic=True)
        _limit_times(whole, blow_up, end)
        blow_up.axvline(pinch, color="0.5", linewidth=0.6, zorder=0)
        whole.set_ylabel(r"$\max\,|H_h|$", labelpad=2)
    for setting, axes in zip(settings, grid[-1]):
        _draw_runs(axes, setting, "worst_angle", (0, end))
        axes.set_xlim(0, 1.02 * end)
        axes.set_ylim(0, None)
    grid[-1][0].set_ylabel("smallest angle (degrees)", labelpad=4)
    return figure


KINDS = {"max": ("maximum", style.DASHES["solid"]), "min": ("minimum", style.DASHES["dashed"])}


def normals_figure(settings, notes):
    """Figure 13.6: min and max of the length of the computed normal, and their blow-up; None without such series."""
    names = [f"{kind}_nu" for kind in KINDS]
    legend = {label: {**line, "linestyle": "none"} for label, line in _legend(settings, names).items()}
    legend |= {label: {"color": "black", "linestyle": dashes, "linewidth": 1.15} for label, dashes in KINDS.values()}
    settings = [setting for setting in settings if _legend([setting], names)]
    if not settings:
        return None
    notes = [f"The vertical axes are linear within {NEAR_ONE:g} of one, logarithmic beyond.", *notes]
    figure, grid = time_series.panels([[setting.heading(()), ""] for setting in settings], legend, notes)
    end = _end(settings, "max_nu", reference_curvature(ZOOM)[2])
    for setting, (whole, blow_up) in zip(settings, grid):
        for axes, start in ((whole, 0), (blow_up, ZOOM)):
            values = np.concatenate([_draw_runs(axes, setting, f"{kind}_nu", (start, end), linestyle=dashes)
                                     for kind, (_, dashes) in KINDS.items()])
            _scale_about_one(axes, values)
        _limit_times(whole, blow_up, end)
        whole.set_ylabel(r"$\min\,|\nu_h|$ and $\max\,|\nu_h|$", labelpad=2)
    return figure


NEAR_ONE = 0.02  # lengths closer to one are on a linear scale, others on a logarithmic one


def _scale_about_one(axes, lengths):
    """Fits the vertical axis to lengths about one, and spreads those close to one."""
    def spread(length):
        return np.arcsinh((length - 1) / NEAR_ONE)

    axes.set_yscale("function", functions=(spread, lambda y: 1 + NEAR_ONE * np.sinh(y)))
    low, high = spread(min(lengths, default=1)) - 0.3, spread(max(lengths, default=1)) + 0.3
    axes.set_ylim(*(1 + NEAR_ONE * np.sinh([low, high])))
    ticks = [0.3, 0.5, 0.8, 0.9, 0.95, 0.98, 1, 1.02, 1.05, 1.1, 1.2, 1.5, 2, 3, 5]
    axes.set_yticks([tick for tick in ticks if low <= spread(tick) <= high])
    axes.yaxis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_locator(ticker.NullLocator())


def _draw_runs(axes, setting, name, span, **look):
    """Draws a quantity of all runs; returns the values in `span`.

    Marks of lines that coincide lie side by side, and those of runs that end early on top.
    """
    values = []
    for k, (method, row) in enumerate(sorted(setting.runs.items(), key=lambda run: -run[1]["series"]["t"][-1])):
        inside = np.flatnonzero((np.array(row["series"]["t"]) >= span[0]) & (np.array(row["series"]["t"]) <= span[1]))
        every = max(len(inside) // 4, 1)
        marks = [*inside[k * every // len(setting.runs)::every], *inside[-1:]]
        values.append(time_series.draw_series(axes, row, name, {**LINES[method], "markevery": list(marks), **look}, span))
    return np.concatenate(values)


def _limit_times(whole, blow_up, end):
    whole.set_xlim(0, 1.02 * end)
    blow_up.set_xlim(ZOOM, end + 0.03 * (end - ZOOM))


def draw(table, folder):
    """Yields (name, figure) for what the table has; `folder` is the table's. TableError when there is nothing."""
    rows = table["rows"]
    paper, good = paper_setting(rows), good_setting(rows)
    settings = [setting for setting in (paper, good) if setting]
    if not settings:
        raise TableError("no runs with the start \"cascade\" or \"substeps:K\"")
    columns = ("dziuk", "kll", "kll_normalised")
    close_ups = [(LABELS["kll_normalised"] + ", " + setting.steps(), setting.runs["kll_normalised"])
                 for setting in settings if "kll_normalised" in setting.runs]
    close_ups += [(rf"BGN, $\tau = {setting.runs['bgn']['tau']:.3g}$", setting.runs["bgn"])
                  for setting in settings[-1:] if "bgn" in setting.runs]
    notes = time_series.failure_notes(rows, lambda row: LABELS.get(method_of(row), ""))
    if any(row["status"] != "ok" for setting in settings for row in setting.runs.values()):
        notes = ["Lines end at the last step before the run stops as singular.", *notes]
    make = {
        "kll19/fig13_3": lambda: paper and surfaces_figure(paper, columns, folder),
        "kll19/fig13_3_good_start": lambda: good and surfaces_figure(good, (*columns, "bgn"), folder),
        "kll19/fig13_4": lambda: neck_figure(close_ups, folder),
        "kll19/fig13_5": lambda: curvature_figure(settings, notes),
        "kll19/fig13_6": lambda: normals_figure(settings, notes),
    }
    nothing = True
    for name, figure in ((name, make[name]()) for name in make):
        if figure:
            nothing = False
            yield name, figure
    if nothing:
        raise TableError("no series and no snapshots of these runs")


if __name__ == "__main__":
    run(STEM, draw, __doc__)
