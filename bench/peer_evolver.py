#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Vesicles of least bending energy with given area and volume, by Surface Evolver and by this program's Helfrich flow.

    python3 bench/peer_evolver.py build/bin             (Debian: evolver-nox)

Prolates with area 4 pi and reduced volume v; 1/2 int H², H the sum of the principal curvatures, over 8 pi. Both start
from the same nodes on the spheroid of this area and volume: this program with quadratic triangles, Evolver with four
linear ones for each. Errors: against reference/independent/helfrich.json. Seconds: processor time of one run, all
included but, for Evolver, making the mesh.

Evolver minimises by Newton's method with normal displacements (hessian_seek); each step is followed by averaging of
the vertices (V), without which the triangles degenerate.
"""
import json
import math
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile

for variable in ("OMP_NUM_THREADS", "OMP_THREAD_LIMIT", "OPENBLAS_NUM_THREADS"):
    os.environ[variable] = "1"

VOLUMES = ("0.8", "0.7")
LEVELS = (0, 2)
LIMIT = 1200  # seconds by the clock, for each run
SPHERE_TOLERANCE = 0.01
# Evolver's h is the mean of the principal curvatures: 1/2 int H² = 2 int h². Two calm rounds end the minimisation,
# since a step from an indefinite Hessian may move hardly at all. The last steps meet area and volume to round-off.
HEADER = """quantity bending energy modulus 2 method star_perp_sq_mean_curvature global
quantity surface_area fixed = {area!r} method facet_area global
"""
PRINT = 'printf "END %.12g %.12g %.12g\\n", bending.value, surface_area.value, body[1].volume\n'
MINIMISE = """calm := 0
hessian_normal on
g 5
do { last := total_energy; hessian_seek; V;
     if abs(total_energy - last) < 1e-5*last then calm += 1 else calm := 0;
} while (calm < 2)
{ hessian_seek } 3
"""


def timed(command, **options):
    """Runs it; its output, and the processor time in seconds."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=LIMIT,
                              check=False, **options)
    except subprocess.TimeoutExpired as error:
        sys.exit(f"{command[0]} was not done after {LIMIT} s: {(error.stdout or b'').decode()[-500:]}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        sys.exit(f"{command[0]} ended with exit code {done.returncode}: {(done.stdout + done.stderr)[-500:]}")
    return done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def start(programs, folder, half_axes, level):
    """Nodes and quadratic triangles at the start: those of helfrich_vesicles at this level."""
    scale = 2 ** (-level / 2)
    config, nodal = os.path.join(folder, "start.json"), os.path.join(folder, "nodal.json")
    with open(config, "w", encoding="utf-8") as file:
        json.dump({"flow": "mean_curvature", "surface": {"name": "ellipsoid", "axes": half_axes}, "degree": 2,
                   "mesh": {"edge_length": 0.3 * scale, "grading": scale}, "tau": 1, "steps": 0,
                   "output": {"nodal": nodal}}, file)
    timed([os.path.join(programs, "evolve"), config])
    with open(nodal, encoding="utf-8") as file:
        data = json.load(file)
    return data["x"], data["elements"]


def linear_triangles(elements):
    """Each quadratic triangle, nodes 0, 1, 2, 01, 12, 20, as four linear ones."""
    for a, b, c, ab, bc, ca in elements:
        yield from ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))


def datafile(nodes, triangles, area, volume):
    """Evolver's description of a closed surface: vertices, edges, faces as oriented edges, and the body inside."""
    edges, faces = {}, []
    for a, b, c in triangles:
        face = []
        for edge in ((a, b), (b, c), (c, a)):
            opposite = edges.get(edge[::-1])
            face.append(-opposite if opposite else edges.setdefault(edge, len(edges) + 1))
        faces.append(face)
    lines = ["vertices", *(f"{i} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(nodes, 1))]
    lines += ["edges", *(f"{number} {a + 1} {b + 1}" for (a, b), number in edges.items())]
    lines += ["faces", *(f"{i} {a} {b} {c} tension 0" for i, (a, b, c) in enumerate(faces, 1))]
    lines += ["bodies", f"1 {' '.join(str(i) for i in range(1, len(faces) + 1))} volume {volume!r}"]
    return HEADER.format(area=area) + "\n".join(lines) + "\n"


def by_evolver(program, folder, surface, commands):
    """Runs the commands on a datafile; energy over 8 pi, area, volume, and seconds."""
    surface_file, command_file = os.path.join(folder, "vesicle.fe"), os.path.join(folder, "commands")
    for path, text in ((surface_file, surface), (command_file, commands + PRINT + "q\nq\n")):
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    # HOME: Evolver keeps a history of commands there.
    output, seconds = timed([program, "-x", "-f", command_file, surface_file], env={**os.environ, "HOME": folder})
    end = re.search(r"^\s*END (\S+) (\S+) (\S+)", output, re.M)
    if not end:
        sys.exit(f"Surface Evolver printed no energy: {output[-500:]}")
    energy, area, volume = map(float, end.groups())
    return energy / (8 * math.pi), area, volume, seconds


def check_sphere(programs, program, folder):
    """Evolver's energy of a sphere, which is 8 pi: are the factors right?"""
    nodes, elements = start(programs, folder, [1, 1, 1], 0)
    surface = datafile(nodes, linear_triangles(elements), 4 * math.pi, 4 * math.pi / 3)
    energy, _, _, _ = by_evolver(program, folder, surface, "")
    if not abs(energy - 1) <= SPHERE_TOLERANCE:
        sys.exit(f"Surface Evolver: energy of a sphere over 8 pi is {energy:g}, expected 1 up to {SPHERE_TOLERANCE:g}")


def minimum_by_evolver(program, folder, nodes, elements, v):
    """Triangles, energy over 8 pi, seconds."""
    triangles, area, volume = list(linear_triangles(elements)), 4 * math.pi, float(v) * 4 * math.pi / 3
    energy, area_found, volume_found, seconds = by_evolver(program, folder, datafile(nodes, triangles, area, volume),
                                                           MINIMISE)
    if not max(abs(area_found / area - 1), abs(volume_found / volume - 1)) <= 1e-6:
        sys.exit(f"Surface Evolver: area {area_found!r} and volume {volume_found!r}, expected {area!r} and {volume!r}")
    return len(triangles), energy, seconds


def minimum_by_flow(programs, folder, nodes, elements, v, level):
    """Triangles, energy of the surface over 8 pi, seconds."""
    table = os.path.join(folder, "table.json")
    _, seconds = timed([os.path.join(programs, "helfrich_vesicles"), "--branch", "prolate", "--volume", v, "--curvature",
                        "0", "--levels", str(level), "--output", table])
    with open(table, encoding="utf-8") as file:
        row, = json.load(file)["rows"]
    if row["status"] != "ok" or row["nodes"] != len(nodes):
        sys.exit(f"helfrich_vesicles: {row['status']}, {row['nodes']} nodes, expected {len(nodes)}")
    return len(elements), row["values"]["energy"], seconds


def main():
    program = shutil.which("evolver-nox-d") or shutil.which("evolver")
    if not program:
        print("Surface Evolver is not installed; on Debian: apt-get install evolver-nox")
        return
    programs = sys.argv[1]
    with open("reference/independent/helfrich.json", encoding="utf-8") as file:
        shapes = json.load(file)["shapes"]
    with tempfile.TemporaryDirectory() as folder:
        check_sphere(programs, program, folder)
        print(f"{'v':>4}  {'program':<16}{'triangles':>10}{'nodes':>8}{'E/8pi':>10}{'error':>10}{'seconds':>9}")
        for v in VOLUMES:
            shape, = (s for s in shapes if s["branch"] == "prolate" and s["v"] == float(v) and s["H0"] == 0)
            for level in LEVELS:
                nodes, elements = start(programs, folder, shape["start_spheroid"]["half_axes"], level)
                rows = (("Surface Evolver", *minimum_by_evolver(program, folder, nodes, elements, v)),
                        ("esfem", *minimum_by_flow(programs, folder, nodes, elements, v, level)))
                for name, triangles, energy, seconds in rows:
                    print(f"{v:>4}  {name:<16}{triangles:>10}{len(nodes):>8}{energy:>10.6f}"
                          f"{energy - shape['E_over_8pi']:>10.1e}{seconds:>9.1f}", flush=True)


if __name__ == "__main__":
    main()
