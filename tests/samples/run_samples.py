#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the configurations of reference/examples, and compares their ends with reference/examples/expected.json.

Usage: python3 tests/samples/run_samples.py --build build [--jobs 2] [NAME...]
An entry of expected.json, by the name of the configuration, has some of
  t, steps, area     of the series, at its end (steps: without those of the start)
  helfrich_energy    the same
  max_FIELD          the largest nodal value at the end
  tolerance          relative, of all of these; default 1e-6
Outputs below build/ go to BUILD/samples/, anew. Exits with 1 when a run fails, an entry is missing, or a value differs.
"""
import argparse
import concurrent.futures
import json
import os
import shutil
import subprocess
import sys
import tempfile

EXAMPLES = os.path.join("reference", "examples")
EXPECTED = os.path.join(EXAMPLES, "expected.json")
TOLERANCE = 1e-6


def read(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def names():
    """Of the configurations in reference/examples that are run as they are: they name their output, unlike those of sweeps and studies."""
    return sorted(os.path.splitext(name)[0] for name in os.listdir(EXAMPLES) if "output" in read(os.path.join(EXAMPLES, name)))


def found_at_end(output):
    """The values that expected.json may name."""
    series, nodal = read(output["series"]), read(output["nodal"])
    values = {"t": series["t"][-1], "steps": len(series["t"]) - 1}
    values.update({name: series[name][-1] for name in ("area", "helfrich_energy") if name in series})
    values.update({f"max_{field}": max(nodal[field]) for field in ("u", "u1", "u2", "H") if field in nodal})
    return series["status"], values


def differences(found, expected):
    """What differs, as text. Raises KeyError when a value is expected that the run does not have."""
    tolerance = expected.get("tolerance", TOLERANCE)
    return [f"{name}: found {found[name]:.10g}, expected {value:.10g}" for name, value in expected.items()
            if name != "tolerance" and not abs(found[name] - value) <= tolerance * abs(value)]


def evolve(build, configuration):
    """(exit code, messages, seconds of the processor)."""
    with tempfile.TemporaryFile("w+", encoding="utf-8") as messages:
        command = [os.path.join(build, "bin", "evolve"), configuration]
        with subprocess.Popen(command, stdout=messages, stderr=messages) as process:
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
        messages.seek(0)
        return process.returncode, messages.read().strip(), usage.ru_utime + usage.ru_stime


def run(name, build):
    """(what is wrong, as text or "", the values found, seconds of the processor)."""
    folder = os.path.join(build, "samples")
    shutil.rmtree(os.path.join(folder, name), ignore_errors=True)
    os.makedirs(os.path.join(folder, name))
    with open(os.path.join(EXAMPLES, f"{name}.json"), encoding="utf-8") as file:
        config = json.loads(file.read().replace('"build/', f'"{folder}/{name}/'))
    config["output"] = {"nodal": f"{folder}/{name}/end.json", **config["output"]}
    path = os.path.join(folder, name, "configuration.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(config, file, indent=1)
    code, said, seconds = evolve(build, path)
    if code != 0:
        return f"exit code {code}: {said}", {}, seconds
    status, found = found_at_end(config["output"])
    expected = read(EXPECTED).get(name)
    if expected is None:
        return f"no entry in {EXPECTED}; found {json.dumps(found)}", found, seconds
    wrong = ([] if status.split(":")[0] in ("ok", "stationary") else [status]) + differences(found, expected)
    return "; ".join(wrong), found, seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("names", nargs="*", metavar="NAME")
    given = parser.parse_args()
    failed = []
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        runs = {pool.submit(run, name, given.build): name for name in given.names or names()}
        for future in concurrent.futures.as_completed(runs):
            wrong, found, seconds = future.result()
            values = ", ".join(f"{key} {value:.10g}" for key, value in found.items())
            print(f"{runs[future]}: {seconds:.0f} s of CPU time, {wrong or 'as expected: ' + values}", flush=True)
            if wrong:
                failed.append(runs[future])
    if failed:
        sys.exit(f"samples FAILED: {', '.join(sorted(failed))}")


if __name__ == "__main__":
    main()
