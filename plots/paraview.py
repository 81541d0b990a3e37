# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of a snapshot by ParaView: the surface on its curved elements, coloured by a nodal field.

pvpython (Debian: packages paraview and python3-paraview) runs it:
  pvpython plots/paraview.py build/dumbbell/surfaces.pvd
  pvpython plots/paraview.py build/dumbbell/surfaces.pvd --time 0.05 --field nu --output nu.png
and where there is no display (Debian: packages xvfb and xauth)
  xvfb-run -a -s -noreset pvpython plots/paraview.py build/dumbbell/surfaces.pvd
Without -noreset Xvfb starts anew when ParaView closes its first connection, and may refuse the second one.
"""
import argparse
import os
import sys

SUBDIVISIONS = 4  # ParaView's most: each element side in 2^4 pieces
SIZE = 1600, 1200  # pixels
TURN, TILT = 0.45, 0.35  # of the direction to the viewer, against the axis along which the surface is thinnest


class InputError(Exception):
    """What was found, where, and what was expected, in one line."""


def parse_arguments():
    parser = argparse.ArgumentParser(prog="pvpython plots/paraview.py", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("snapshots", metavar="FILE", help="run.pvd, or one snapshot run_0003.vtu")
    parser.add_argument("--field", default="H", help="nodal field; of a vector its length (default: H)")
    parser.add_argument("--time", default="last", metavar="T",
                        help="of the run; the snapshot nearest to it is drawn (default: last)")
    parser.add_argument("--output", metavar="PICTURE.png", help="default: FILE with .png instead of its ending")
    parser.error = lambda message: sys.exit(f"{parser.prog}: {message} (--help lists what is accepted)")
    return parser.parse_args()


def paraview_simple():
    """ParaView's Python module. Raises InputError when this Python has none."""
    # This file has the name of ParaView's package, and its folder comes first.
    here = os.path.dirname(os.path.abspath(__file__))
    sys.path[:] = [folder for folder in sys.path if os.path.abspath(folder) != here]
    try:
        from paraview import simple
    except ImportError as error:
        raise InputError(f"found {os.path.basename(sys.executable)} without ParaView ({error}), expected pvpython "
                         "(Debian: packages paraview and python3-paraview)") from error
    simple._DisableFirstRenderCameraReset()
    return simple


def check_display():
    """Raises InputError where ParaView would crash: it draws on X, and there is none."""
    from vtkmodules import vtkRenderingCore, vtkRenderingOpenGL2  # noqa: F401  (which makes the windows)

    if vtkRenderingCore.vtkRenderWindow().IsA("vtkXOpenGLRenderWindow") and not os.environ.get("DISPLAY"):
        raise InputError("found no display, expected one: xvfb-run -a -s -noreset pvpython plots/paraview.py FILE "
                         "has one (Debian: packages xvfb and xauth)")


def open_snapshots(simple, path):
    """The source of a PVD or VTU file. Raises InputError when it is neither."""
    readers = {".pvd": lambda: simple.PVDReader(FileName=path),
               ".vtu": lambda: simple.XMLUnstructuredGridReader(FileName=[path])}
    make = readers.get(os.path.splitext(path)[1])
    if not make:
        raise InputError(f"{path}: expected a file that ends in .pvd or .vtu")
    if not os.path.isfile(path):
        raise InputError(f"{path}: no such file")
    source = make()
    source.UpdatePipelineInformation()
    return source


def check_output(path):
    """Raises InputError when no picture can be written there; ParaView would not report it."""
    if not path.endswith(".png"):
        raise InputError(f"--output: found {path}, expected a file that ends in .png")
    folder = os.path.dirname(path) or "."
    if not os.path.isdir(folder) or not os.access(folder, os.W_OK):
        raise InputError(f"{path}: cannot be written; expected a folder {folder} where files can be made")


def nearest(times, wanted):
    """The time of `times` that is nearest to `wanted`, a number as text or "last"; None when there are none."""
    if wanted == "last":
        return max(times, default=None)
    try:
        wanted = float(wanted)
    except ValueError:
        raise InputError(f"--time: found '{wanted}', expected a number or last") from None
    return min(times, key=lambda time: abs(time - wanted), default=None)


def only_grid(source):
    """The data of the source: of a collection those of its only block."""
    from paraview import servermanager

    grid = servermanager.Fetch(source)
    while grid.IsA("vtkCompositeDataSet"):
        grid = grid.GetBlock(0)
    return grid


def caption(grid):
    """Flow, time and step, as far as the field data say them."""
    arrays = grid.GetFieldData()
    words = []
    flow, time, step = (arrays.GetArray(name) for name in ("flow", "TimeValue", "step"))
    if flow:
        codes = bytes(flow.GetValue(i) for i in range(flow.GetNumberOfTuples()))
        words.append(codes.decode(errors="replace").replace("_", " "))
    if time:
        words.append(f"t = {time.GetValue(0):.6g}")
    if step:
        words.append(f"step {step.GetValue(0)}")
    return ", ".join(words)


def check_field(grid, field):
    """Raises InputError when the grid has no such nodal field; returns the number of its components."""
    data = grid.GetPointData()
    if not data.GetArray(field):
        names = ", ".join(data.GetArrayName(i) for i in range(data.GetNumberOfArrays()))
        raise InputError(f"--field: found '{field}', expected one of {names or 'no fields: the file has none'}")
    return data.GetArray(field).GetNumberOfComponents()


def directions(bounds):
    """Axis numbers (across, up, to the viewer), from the longest extent of the surface to the shortest."""
    extents = [bounds[2 * axis + 1] - bounds[2 * axis] for axis in range(3)]
    return sorted(range(3), key=lambda axis: -round(extents[axis] / max(extents), 3))


def aim(simple, view, bounds):
    """Points the camera at the surface, a little from the side and from above."""
    across, up, viewer = directions(bounds)
    centre = [(bounds[2 * axis] + bounds[2 * axis + 1]) / 2 for axis in range(3)]
    position, vertical = list(centre), [0.0] * 3
    position[across] += TURN
    position[up] += TILT
    position[viewer] += 1
    vertical[up] = 1.0
    view.CameraFocalPoint, view.CameraPosition, view.CameraViewUp = centre, position, vertical
    simple.ResetCamera(view)
    view.CameraParallelProjection = 1
    view.CameraParallelScale *= 0.9


def colour_bar(simple, view, field, components):
    """Colours the field from its least to its greatest value, and says which is which."""
    colours = simple.GetColorTransferFunction(field)
    # As in style.py: its lightness is monotone, so that colour-blind readers and greyscale keep the order.
    colours.ApplyPreset("Viridis (matplotlib)", True)
    bar = simple.GetScalarBar(colours, view)
    bar.Title, bar.ComponentTitle = field if components == 1 else f"length of {field}", ""
    bar.Orientation, bar.HorizontalTitle, bar.TitleFontSize, bar.LabelFontSize = "Horizontal", 1, 26, 22
    bar.LabelFormat = bar.RangeLabelFormat = "%.5g"
    bar.WindowLocation, bar.Position, bar.ScalarBarLength = "Any Location", [0.2, 0.03], 0.6
    bar.Visibility = 1


def draw(simple, source, grid, field, time):
    """A view of the surface, coloured by the field, with a colour bar."""
    components = check_field(grid, field)
    simple.LoadPalette("WhiteBackground")
    view = simple.CreateRenderView()
    view.ViewSize = SIZE
    view.OrientationAxesVisibility = 0
    if time is not None:
        view.ViewTime = time
    display = simple.Show(source, view)
    display.NonlinearSubdivisionLevel = SUBDIVISIONS
    display.Ambient, display.Diffuse = 0.4, 0.7
    if grid.GetPointData().GetArray("nu"):
        display.SelectNormalArray = "nu"  # else light falls on flat facets
    simple.ColorBy(display, ("POINTS", field) if components == 1 else ("POINTS", field, "Magnitude"))
    display.RescaleTransferFunctionToDataRange(False)
    colour_bar(simple, view, field, components)
    text = simple.Show(simple.Text(Text=caption(grid)), view)
    text.WindowLocation = "Upper Center"
    text.FontSize = 24
    aim(simple, view, grid.GetBounds())
    return view


def main():
    arguments = parse_arguments()
    output = arguments.output or os.path.splitext(arguments.snapshots)[0] + ".png"
    try:
        check_output(output)
        simple = paraview_simple()
        check_display()
        source = open_snapshots(simple, arguments.snapshots)
        time = nearest(list(source.TimestepValues), arguments.time)
        source.UpdatePipeline(*([] if time is None else [time]))
        view = draw(simple, source, only_grid(source), arguments.field, time)
        simple.SaveScreenshot(output, view, ImageResolution=SIZE)
    except InputError as error:
        sys.exit(f"plots/paraview.py: {error}")
    print(output)


if __name__ == "__main__":
    main()
