# SPDX-License-Identifier: GPL-3.0-or-later
"""The one style of all figures. Importing it selects matplotlib's Agg backend (no display), sets fonts and lines.

Sizes are print sizes: a figure is WIDTH wide and is included in a page without scaling, so 8 pt here is 8 pt on paper.
"""
import math
import os
import re
import textwrap

import matplotlib

matplotlib.use("Agg")
from matplotlib import ticker  # noqa: E402  (the backend comes first)
from matplotlib.figure import Figure  # noqa: E402

CM = 1 / 2.54
WIDTH = 17 * CM  # text width of a page, in inches
RASTER_DPI = 400  # of pictures inside a PDF; lines and letters stay vectors

# Shapes that are distinguishable at 4 pt; neighbours in the list differ most.
MARKERS = ("o", "s", "^", "D", "v", "*", "<", "p", ">", "x")

matplotlib.rcParams.update({
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.labelsize": 9,
    "legend.fontsize": 8.5,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "axes.linewidth": 0.6,
    "axes.axisbelow": True,
    "grid.color": "0.88",
    "grid.linewidth": 0.4,
    "lines.linewidth": 0.9,
    "lines.markersize": 4,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "legend.frameon": False,
    "pdf.fonttype": 42,  # TrueType, embedded: publishers refuse Type 3
    "savefig.dpi": 200,
})


def line_styles(count):
    """Keyword arguments of `plot` for `count` lines in an order that means something (coarse to fine).

    Viridis without its pale end: lightness is monotone, so the order survives greyscale and colour blindness; the
    markers distinguish the lines. Later markers are smaller, so that all of them show where lines coincide.
    """
    colours = matplotlib.colormaps["viridis"]
    styles = []
    for i in range(count):
        t = i / max(count - 1, 1)
        marker = MARKERS[i % len(MARKERS)]
        size = (5.5 - 2 * t) * (1.4 if marker == "*" else 1)  # a star of the same size looks smaller
        styles.append({"color": colours(0.8 * t), "marker": marker, "markersize": size, "markerfacecolor": "white",
                       "markeredgewidth": 0.9})
    return styles


# Colours of Okabe and Ito, which colour-blind readers can distinguish; dashes do so in greyscale.
BLUE, VERMILLION, GREEN, SKY_BLUE, ORANGE, PURPLE = "#0072B2", "#D55E00", "#009E73", "#56B4E9", "#E69F00", "#CC79A7"
DASHES = {"solid": "-", "dashed": (0, (5, 2)), "dotted": (0, (1, 1.3)), "dash-dot": (0, (6, 1.8, 1.2, 1.8)),
          "dash-dot-dot": (0, (6, 1.5, 1.2, 1.5, 1.2, 1.5)), "short": (0, (2.5, 1.5)), "long": (0, (10, 2)),
          "sparse": (0, (1, 3))}


def limit_line(axes, limit, label="", zorder=1.5):
    """A dashed line at the value that a quantity tends to, with its name on the right, on the side with more room."""
    low, high = axes.get_ylim()
    axes.axhline(limit, color="black", linewidth=0.8, linestyle=(0, (4, 2.5)), zorder=zorder, gid=f"limit {label}")
    above = high - limit > limit - low
    axes.annotate(label, (1, limit), (-8, 2.5 if above else -3), xycoords=("axes fraction", "data"),
                  textcoords="offset points", ha="right", va="bottom" if above else "top", fontsize=8.5, zorder=5,
                  bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.6})


def notice(paragraphs):
    """A figure that says in words why there is no other."""
    lines = [line for paragraph in paragraphs for line in wrap(paragraph, 110)]
    figure = Figure(figsize=(WIDTH, 0.3 + 0.18 * len(lines)))
    figure.text(0.5, 0.5, "\n".join(lines), ha="center", va="center")
    return figure


def wrap(text, width=125):
    """The text in lines of at most `width` characters, never broken inside a formula."""
    formulas = re.sub(r"\$[^$]*\$", lambda match: match[0].replace(" ", "\0"), text)
    return [line.replace("\0", " ") for line in textwrap.wrap(formulas, width)]


def power_of_ten(value):
    """A number with two digits at most times a power of ten; 1 times is left out."""
    mantissa, exponent = f"{value:.1e}".split("e")
    times = "" if mantissa == "1.0" else rf"{float(mantissa):g}\cdot "
    return f"${times}10^{{{int(exponent)}}}$"


def nodes_label(nodes):
    """The number of nodes (degrees of freedom) of a mesh as it stands in legends and headings."""
    return "$N = " + f"{nodes:,}".replace(",", "{,}") + "$"


def in_words(rows, name=None):
    """Which runs these are: "N = 342 with τ = 0.2, 0.1; ..". `name(row)` says what else tells them apart."""
    groups = {}
    for row in rows:
        mesh = nodes_label(row["nodes"]) if row.get("nodes") else f"level {row.get('level', 0)}"
        groups.setdefault(", ".join(filter(None, (name and name(row), mesh))), []).append(f"{row.get('tau', 0):.3g}")
    texts = [rf"{group} with $\tau$ = {', '.join(taus)}" for group, taus in groups.items()]
    return "; ".join(texts[:6]) + (f" and {sum(map(len, list(groups.values())[6:]))} more" if len(texts) > 6 else "")


def log_ticks(axis, low, high, length):
    """Labels a horizontal logarithmic axis over [low, high], `length` points long, with round numbers.

    When these do not fit or have too many digits, matplotlib's powers of ten stay.
    """
    for mantissas in ((1, 1.5, 2, 3, 4, 5, 7), (1, 2, 5), (1, 3), (1, 1.2, 1.5, 2, 2.5, 3, 3.5, 4, 5, 6, 7, 8, 9)):
        ticks = [m * 10.0**d for d in range(-4, 5) for m in mantissas if low <= m * 10.0**d <= high]
        if low < 1e-4 or high > 1e4 or len(ticks) < 2:
            continue
        labels = [(length * math.log(tick / low) / math.log(high / low), 2.1 * len(f"{tick:g}") + 2) for tick in ticks]
        if all(right - left >= half + other for (left, half), (right, other) in zip(labels, labels[1:])):
            axis.set_major_locator(ticker.FixedLocator(ticks))
            axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_minor_locator(ticker.NullLocator())
            return


def save(figure, stem):
    """Writes stem.pdf and stem.png, each whole or not at all; equal figures give equal bytes. Returns both names."""
    folder, name = os.path.split(os.path.abspath(stem))
    os.makedirs(folder, exist_ok=True)
    written = []
    for kind, options in (("pdf", {"dpi": RASTER_DPI, "metadata": {"CreationDate": None}}), ("png", {})):
        target = f"{stem}.{kind}"
        unfinished = os.path.join(folder, f".{name}.{kind}.{os.getpid()}.tmp")
        try:
            figure.savefig(unfinished, format=kind, **options)
            os.replace(unfinished, target)
        finally:
            if os.path.exists(unfinished):
                os.remove(unfinished)
        written.append(target)
    return written
