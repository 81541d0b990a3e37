# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of triangulated surfaces: snapshots read from VTU files, drawn in orthographic projection.

Back faces are left out, and the rest is painted from back to front, element edges among the faces.
"""
import os
from dataclasses import dataclass

import meshio
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap, to_rgb

import style
from table import TableError

LIGHT = np.array([-0.35, 0.50, 0.79])  # from the left, from above, from the front
EDGE_TONE = 0.1
RIM, MARKED_RIM = 0.2, 0.7  # of a facet, in points; thin elements that are marked stay visible
SHADE_OF_PLAIN = 0.75  # of facets in full light: a field's colour shows unchanged there
TONES = 96  # few colours make small files
# Tones are drawn in grey and coloured afterwards, from dark (edges) over blue (faces) to white (highlights).
RAMP = LinearSegmentedColormap.from_list("surface", [(0, "#000814"), (0.15, "#1d2b40"), (0.36, "#577294"),
                                                     (0.75, "#b9cee6"), (1, "#ffffff")], N=TONES)


@dataclass
class Surface:
    """points (N, 3); triangles (E, 3) or (E, 6), node order 0, 1, 2, 01, 12, 20; data: name -> nodal values."""
    points: np.ndarray
    triangles: np.ndarray
    data: dict


def read_surface(path):
    """The triangulated surface of a VTU file with its nodal fields. Raises TableError that names the file."""
    if not os.path.isfile(path):
        raise TableError(f"{path}: no such snapshot")
    try:
        mesh = meshio.vtu.read(path)
    except Exception as error:  # a damaged file is an error of XML, of zlib, of numpy or of meshio
        reason = " ".join(str(error).split()) or type(error).__name__
        raise TableError(f"{path}: no whole VTU file: {reason}") from error
    blocks = [block.data for kind in ("triangle6", "triangle") for block in mesh.cells if block.type == kind]
    if not blocks:
        raise TableError(f"{path}: cells are {', '.join(block.type for block in mesh.cells) or 'missing'}, "
                         "expected triangles of degree 1 or 2")
    return Surface(np.asarray(mesh.points, float), blocks[0], dict(mesh.point_data))


def view(turn, tilt=0.0, up=1):
    """The rotation (3, 3) to picture coordinates: to the right, upwards, towards the viewer.

    `up` names the vertical axis, the next one (cyclically) comes to the viewer: for x1 upwards, x3 goes to the right.
    `turn` > 0 (degrees) shows the lower end of the axis to the right, `tilt` > 0 the surface from above.
    """
    turn, tilt = np.radians([turn, tilt])
    across = np.eye(3)[[(up + 1) % 3, up - 1, up % 3]]
    about_vertical = np.array([[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]])
    about_horizontal = np.array([[1, 0, 0], [0, np.cos(tilt), -np.sin(tilt)], [0, np.sin(tilt), np.cos(tilt)]])
    return about_horizontal @ about_vertical @ across


def upright_view(surface, tilt):
    """The view with x3 upwards in which the longer one of the surface's horizontal axes is nearly across."""
    lengths = np.ptp(surface.points, axis=0)
    return view(25 if lengths[1] > lengths[0] else -65, tilt, up=3)


def shape_functions(xi, count):
    """Linear (`count` 3) or quadratic (6) shape functions at points (m, 2) of the reference triangle: (m, count)."""
    b = np.column_stack([1 - xi.sum(axis=1), xi])
    if count == 3:
        return b
    return np.hstack([b * (2 * b - 1), 4 * b * np.roll(b, -1, axis=1)])


def shape_gradients(xi, count):
    """Their derivatives with respect to both reference coordinates: (m, 2, count)."""
    b = np.column_stack([1 - xi.sum(axis=1), xi])
    slopes = np.array([[-1.0, 1, 0], [-1, 0, 1]])
    if count == 3:
        return np.broadcast_to(slopes, (len(xi), 2, 3))
    corners = (4 * b - 1)[:, None, :] * slopes
    sides = 4 * (b[:, None, :] * np.roll(slopes, -1, axis=1) + np.roll(b, -1, axis=1)[:, None, :] * slopes)
    return np.concatenate([corners, sides], axis=2)


def lattice(n):
    """The reference triangle in n*n small ones: points (m, 2), triangles (n*n, 3), and the pieces of its sides.

    A piece is (small triangle, its first point, its second point, side of the reference triangle, number on the side).
    """
    numbers = {}
    for j in range(n + 1):
        for i in range(n + 1 - j):
            numbers[i, j] = len(numbers)
    triangles, pieces = [], []
    for j in range(n):
        for i in range(n - j):
            corners = (i, j), (i + 1, j), (i, j + 1)
            sides = [(j == 0, 0, i), (i + j == n - 1, 1, j), (i == 0, 2, n - 1 - j)]
            for k, (outer, side, number) in enumerate(sides):
                if outer:
                    pieces.append((len(triangles), numbers[corners[k]], numbers[corners[(k + 1) % 3]], side, number))
            triangles.append([numbers[corner] for corner in corners])
            if i + j < n - 1:
                triangles.append([numbers[corner] for corner in ((i + 1, j), (i + 1, j + 1), (i, j + 1))])
    return np.array(list(numbers)) / n, np.array(triangles), np.array(pieces)


@dataclass
class Facets:
    """A surface in small flat triangles, E*n*n of them, in picture coordinates (to the right, up, to the viewer)."""
    corners: np.ndarray  # (F, 3, 3)
    normals: np.ndarray  # (F, 3): of the element map, at the middle
    edges: np.ndarray    # (S, 2, 3): pieces of element edges, each once for each of its two elements
    edge_facet: np.ndarray  # (S,)
    edge_key: np.ndarray    # (S, 3): end nodes and number of the piece, equal for both elements


def facets(surface, rotation, n):
    """Splits each element into n*n facets on its (quadratic) map and turns them by `rotation`."""
    points = surface.points @ rotation.T
    nodes = surface.triangles.shape[1]
    xi, small, pieces = lattice(n)
    places = np.einsum("ma,eax->emx", shape_functions(xi, nodes), points[surface.triangles])
    middles = xi[small].mean(axis=1)
    tangents = np.einsum("mda,eax->emdx", shape_gradients(middles, nodes), points[surface.triangles])
    normals = np.cross(tangents[:, :, 0], tangents[:, :, 1]).reshape(-1, 3)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = normals / np.where(lengths > 0, lengths, 1)
    owner, first, second, side, number = pieces.T
    ends = surface.triangles[:, np.stack([side, (side + 1) % 3])]  # (E, 2, 3n)
    number = np.where(ends[:, 0] < ends[:, 1], number, n - 1 - number)
    key = np.stack([ends.min(axis=1), ends.max(axis=1), number], axis=-1).reshape(-1, 3)
    edge_facet = (np.arange(len(places))[:, None] * len(small) + owner).ravel()
    edges = np.stack([places[:, first], places[:, second]], axis=2).reshape(-1, 2, 3)
    return Facets(places[:, small].reshape(-1, 3, 3), normals, edges, edge_facet, key)


def faces_viewer(corners):
    """Which flat triangles (F, 3, 3), counterclockwise seen from outside, show their outer side."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] > 0


def shade(normals):
    """Tones (F,) between 0 (black) and 1 (white), in diffuse light with a soft highlight; normals (F, 3)."""
    light = LIGHT / np.linalg.norm(LIGHT)
    halfway = (light + [0, 0, 1]) / np.linalg.norm(light + [0, 0, 1])
    diffuse, highlight = (np.clip(normals @ direction, 0, None) for direction in (light, halfway))
    return np.clip(0.36 + 0.44 * diffuse + 0.16 * highlight**30, 0, 1)


def _colour_tones(image, _dpi):
    """A picture (height, width, 4) with its greys in the colours of RAMP. The seams between facets become opaque."""
    grey = np.ptp(image[..., :3], axis=2) < 0.02
    image[grey, :3] = RAMP(image[grey, 0])[:, :3]
    image[..., 3][image[..., 3] > 0.8] = 1
    return image, 0, 0


def extent(surface, rotation):
    """(left, right, low, high) of the surface's nodes in the picture."""
    points = surface.points @ rotation[:2].T
    return points[:, 0].min(), points[:, 0].max(), points[:, 1].min(), points[:, 1].max()


def facet_values(surface, values, n):
    """A nodal field (N,) in the middles of the n*n facets of each element: (E*n*n,), in the order of `facets`."""
    xi, small, _ = lattice(n)
    middles = xi[small].mean(axis=1)
    return (values[surface.triangles] @ shape_functions(middles, surface.triangles.shape[1]).T).ravel()


def smallest_angles(surface):
    """The smallest angle of each flat triangle between the corners of an element, in degrees: (E,)."""
    corners = surface.points[surface.triangles[:, :3]]
    sides = np.roll(corners, -1, axis=1) - corners
    sides /= np.linalg.norm(sides, axis=2, keepdims=True)
    cosines = -np.einsum("eki,eki->ek", sides, np.roll(sides, 1, axis=1))
    return np.degrees(np.arccos(np.clip(cosines.max(axis=1), -1, 1)))


def draw_surface(axes, surface, rotation, *, facets_per_side=3, linewidth=0.2, window=None, colours=None,
                 marked=None):
    """Draws the surface with its element edges into `axes`, in the surface's units.

    `linewidth` of the edges in points, 0: none. `window` (left, right, low, high): draws no facets that are out of it.
    `colours`: (nodal values, ScalarMappable) for a surface coloured by a field; else it is blue, but the elements
    `marked` (E,) are orange, without edges.
    The picture is a raster image in a PDF, too.
    """
    split = facets(surface, rotation, facets_per_side)
    front = faces_viewer(split.corners)
    if window is not None:
        low, high = split.corners.min(axis=1), split.corners.max(axis=1)
        front &= (high[:, 0] >= window[0]) & (low[:, 0] <= window[1])
        front &= (high[:, 1] >= window[2]) & (low[:, 1] <= window[3])
    shown = split.corners[front]
    depth = shown[..., 2].mean(axis=1)

    sizes = np.linalg.norm(split.corners - np.roll(split.corners, 1, axis=1), axis=2).max(axis=1)
    marks = np.repeat(marked, facets_per_side**2) if marked is not None else np.zeros(len(front), bool)
    seen = np.flatnonzero((front & ~marks)[split.edge_facet]) if linewidth > 0 else np.empty(0, int)
    seen = seen[np.unique(split.edge_key[seen], axis=0, return_index=True)[1]] if len(seen) else seen
    edges = split.edges[seen]
    # An edge is painted after the facets that it belongs to, whose middles may be nearer by their size.
    edge_depth = edges[..., 2].mean(axis=1) + sizes[split.edge_facet[seen]]

    order = np.argsort(np.concatenate([depth, edge_depth]), kind="stable")
    polygons = np.concatenate([shown, edges[:, [0, 1, 1]]])[order, :, :2]
    tones = np.concatenate([shade(split.normals[front]), np.full(len(edges), EDGE_TONE)])[order]
    # A facet has a rim of its own colour: else the background shines through between two of them.
    widths = RIM  # one number is drawn faster than many
    if linewidth != RIM or marks.any():
        rims = np.where(marks[front], MARKED_RIM, RIM)
        widths = np.concatenate([rims, np.full(len(edges), linewidth)])[order]
    if colours is None:
        faces = np.tile(tones[:, None], 3)
        is_marked = np.concatenate([marks[front], np.zeros(len(edges), bool)])[order]
        faces[is_marked] = np.clip(0.5 + 0.7 * faces[is_marked], 0, 1) * to_rgb(style.VERMILLION)
    else:
        values, mappable = colours
        field = mappable.to_rgba(facet_values(surface, values, facets_per_side)[front])[:, :3]
        field *= 0.45 + 0.55 * np.clip(shade(split.normals[front]) / SHADE_OF_PLAIN, 0, 1)[:, None]
        faces = np.concatenate([field, np.full((len(edges), 3), EDGE_TONE)])[order]
    axes.add_collection(PolyCollection(polygons, facecolors=faces, edgecolors=faces, linewidths=widths, rasterized=True,
                                       agg_filter=_colour_tones if colours is None else None))
