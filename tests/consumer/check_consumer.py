#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Can other projects use the library? Installs it below the build folder, configures tests/consumer/ (a project of its
own) against the installed copy, builds it with -O2 alone, and runs it:

* shrink: area and volume of a sphere under mean curvature flow, R(t) = sqrt(R(0)² - 4t), and those of evolve in this
  build, which is compiled with the project's own flags, to round-off;
* integrate: integrands of one's own, with and without inlining.

The same project is configured with the library's source tree in it, too, to see that this forces no flags on it either.
docs/library.md must show shrink.cpp as it is.

    tests/consumer/check_consumer.py [--build DIR]

Exit code 0 when all is well, 1 otherwise."""
import argparse
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
CONSUMER = ROOT / "tests/consumer"
MESH, RADIUS = ROOT / "reference/independent/sphere_radius2_642.msh", 2
STEPS, TAU = 20, 0.02
# Of quadratic elements with h = 0.5, whose nu and H are computed from the nodes.
MESH_ERROR = 5e-4
ROUND_OFF = 1e-10


class Failure(Exception):
    """Something is not as it should be."""


def expect(holds, what):
    if not holds:
        raise Failure(what)


def run(*command):
    """What a command writes to standard output. It takes no part in the jobs of the make that runs this."""
    environment = {name: value for name, value in os.environ.items() if name not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL")}
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, env=environment)
    expect(done.returncode == 0, f"{' '.join(map(str, command))}\nended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


def install(build, prefix):
    run("cmake", "--install", build, "--prefix", prefix, "--component", "esfem")
    targets = next(prefix.rglob("esfemTargets.cmake")).read_text(encoding="utf-8")
    expect("INTERFACE_COMPILE_OPTIONS" not in targets, "esfem::esfem forces compiler options on its users")
    expect(str(ROOT) not in targets, f"esfem::esfem names {ROOT}: it is of no use where that is missing")


def functions_that_return_packs(header):
    """The names of the functions in the text of a header whose value is a Pack, or one of its kind."""
    pattern = re.compile(r"^ *(?:\[\[.*\]\] )?(?:static )?(?:inline )?(?:Pack|ComplexPack|Lanes) (\w+)\(", re.M)
    found = list(pattern.finditer(header))
    for function in found:
        expect(re.search("[{;]", header[function.end():])[0] == "{",
               f"{function[1]} gives a Pack by value to another object file: it should be always inlined, or fill a reference")
    return {function[1] for function in found}


def without_template_arguments(symbol):
    while re.search("<[^<>]*>", symbol):
        symbol = re.sub("<[^<>]*>", "", symbol)
    return symbol


def symbols_of(listing):
    """What a library defines for others, of readelf's listing: "ADDRESS W|T NAME" lines, W for weak ones. (nm lists them so
    itself, but loads the plugins of every compiler that is installed.)"""
    entry = r"^ *\d+: ([0-9a-f]+) +\S+ \w+ +(GLOBAL|WEAK) +\w+ +(?!UND)\S+ (.*)$"
    return "".join(f"{address} {'W' if bind == 'WEAK' else 'T'} {name}\n"
                   for address, bind, name in re.findall(entry, listing, re.M))


def check_symbols(symbols, names):
    """No function that takes or gives Packs by value, such as those of these names, is a symbol of the library: programs that are compiled for another CPU expect in memory what it has in a register."""
    for kind, symbol in re.findall(r"^[0-9a-f]+ (\w) (.*esfem::.*)$", symbols, re.M):
        plain = without_template_arguments(symbol)
        name = plain.split("(")[0].split("::")[-1]
        expect(not re.match(r"(double|long) __vector", plain) and not (kind == "W" and name in names),
               f"libesfem.a: {symbol} gives a Pack by value: it should be always inlined, or fill a reference")
        expect(not re.search(r"__vector\(\d+\)[,)]", plain), f"libesfem.a: {symbol} takes a Pack by value")


def check_calls(prefix):
    names = set().union(*(functions_that_return_packs(header.read_text(encoding="utf-8"))
                          for header in (prefix / "include").rglob("*.hpp")))
    expect("dot" in names, "no header has dot(), which returns a Pack: this check sees nothing any more")
    archive = next(prefix.rglob("libesfem.a"))
    symbols = symbols_of(run("readelf", "--syms", "--wide", "--demangle", archive))
    expect("esfem::" in symbols, "libesfem.a defines no symbol of esfem: this check sees nothing any more")
    check_symbols(symbols, names)


def check_flags(folder):
    """What the consumer's files are compiled with."""
    commands = json.loads((folder / "compile_commands.json").read_text(encoding="utf-8"))
    own = [command["command"] for command in commands if command["file"].startswith(str(CONSUMER))]
    flags = set(re.findall(r" (-[mWfO]\S*)", " ".join(own))) - {"-O0", "-O2"}
    expect(own and not flags, f"{folder}: compiled with {' '.join(sorted(flags))}, expected -O2 alone")


def configure(folder, *options):
    run("cmake", "-S", CONSUMER, "-B", folder, "-DCMAKE_BUILD_TYPE=", "-DCMAKE_CXX_FLAGS=-O2",
        "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", *options)
    check_flags(folder)


def compare(area, volume, expected_area, expected_volume, tolerance, what):
    for name, found, expected in (("area", area, expected_area), ("volume", volume, expected_volume)):
        error = abs(found / expected - 1)
        expect(error <= tolerance, f"{name} of the consumer's surface: {found:.16g}, {what}: {expected:.16g}, relative "
                                   f"difference {error:.2g}, expected at most {tolerance:g}")
        print(f"consumer: {name} {found:.12g}, {what} {expected:.12g}, relative difference {error:.1e}")


def run_shrink(program, folder):
    """Area and volume at the end."""
    output = folder / "shrink.vtu"
    lines = run(program, MESH, TAU, output).splitlines()
    expect(len(lines) == STEPS + 2, f"{program} printed {len(lines)} lines, expected {STEPS + 2}")
    expect(b"UnstructuredGrid" in output.read_bytes(), f"{output} is no VTU file")
    return [float(word) for word in lines[-1].split()[1:]]


def run_evolve(build, folder):
    """The same by this build's own program."""
    series = folder / "series.json"
    configuration = {"flow": "mean_curvature", "mesh": {"file": str(MESH)}, "bdf": 3, "tau": TAU, "steps": STEPS,
                     "start": "substeps:16", "output": {"series": str(series), "nodal": str(folder / "nodal.json")}}
    (folder / "evolve.json").write_text(json.dumps(configuration), encoding="utf-8")
    run(build / "bin/evolve", folder / "evolve.json")
    found = json.loads(series.read_text(encoding="utf-8"))
    return found["area"][-1], found["volume"][-1]


def check_document():
    text = (ROOT / "docs/library.md").read_text(encoding="utf-8")
    source = (CONSUMER / "shrink.cpp").read_text(encoding="utf-8").split("\n", 1)[1]
    expect(f"```cpp\n{source}```\n" in text, "docs/library.md does not show tests/consumer/shrink.cpp as it is: copy it there")


def check_consumer(build):
    check_document()
    folder = build / "consumer"
    shutil.rmtree(folder, ignore_errors=True)
    prefix, programs = folder / "installed", folder / "build"
    install(build, prefix)
    check_calls(prefix)
    configure(folder / "with_source", f"-DESFEM_SOURCE={ROOT}")
    configure(programs, f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", programs, "-j", os.cpu_count())
    for level in ("O0", "O2"):
        run(programs / f"integrate_{level}")
    area, volume = run_shrink(programs / "shrink", folder)
    R = math.sqrt(RADIUS**2 - 4 * STEPS * TAU)
    compare(area, volume, 4 * math.pi * R**2, 4 / 3 * math.pi * R**3, MESH_ERROR, "exact")
    compare(area, volume, *run_evolve(build, folder), ROUND_OFF, "evolve")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build", help="the build folder (default: build)")
    try:
        check_consumer(pathlib.Path(parser.parse_args().build).resolve())
    except Failure as failure:
        print(f"consumer: {failure}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
