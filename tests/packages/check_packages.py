#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Are packages.txt and packages-tests.txt complete? Every file outside the project that the build, the experiments, the
plots and the tests read must belong to a package that apt installs for these lists on an empty Debian.

What is read is seen, not guessed, so a forgotten package is found on a machine that has it installed, too:

* compilers write what they read into dependency files, and link commands name libraries (taken from the build folder,
  and from that of the library's consumer in it);
* all the rest (CMake, programs, shared libraries, Python modules) is traced: `make check` runs its parts under strace
  (tests/packages/trace), and this script configures two scratch folders, without tests and benchmarks and with both.

`apt-get` says what it would install on an empty system: required packages, apt, and a list. What the build of the
experiments, the runs, the plots and the report read must come with packages.txt alone; the tests and benchmarks may
read what comes with both lists. With --without each, every listed package is taken away once: another one must bring
it, or the check must miss it.

Rules:
1. The project, /proc, /sys, /dev, /run, /tmp, /var, /etc, home folders and translations concern no package, nor do
   links into them.
2. A symbolic link counts, and so does its target; but links into /etc/alternatives belong to nobody.
3. __pycache__/x.cpython-311.pyc counts as x.py. Other files in /usr that no package owns are caches, made when a
   package was installed.
4. A file that the compiler or the linker reads must belong to a package. When something that runs reads files that
   belong to none (a Python of conda's, say), a line says that these were not judged.
5. The package of another compiler or build tool than g++ and make (CXX, CMAKE_GENERATOR) counts as listed.
6. Who lists the machine's fonts opens all of them and what packages tell fontconfig of theirs: only those that it
   chooses for report.css count.
7. Every start of Python reads the .pth files that are there, and the hook that setuptools' one names (_distutils_hack).
8. Dynamic loaders do not count: libc6 is on every system, and ldd asks the loaders of other architectures, too.
9. What a compiler opens counts by its dependency file alone: __has_include opens headers that need not be there.
"""
import argparse
import collections
import concurrent.futures
import functools
import json
import os
import re
import shutil
import subprocess
import sys

RUNS, TESTS = LISTS = ("packages.txt", "packages-tests.txt")
# Parts of `make check`, by the list that must be enough for them.
PARTS = {"samples-check": RUNS, "tables-check": RUNS, "verdicts": RUNS, "independent": RUNS, "plots-check": RUNS,
         "report-check": RUNS, "consumer-check": RUNS, "test-plots": RUNS, "configure": RUNS, "test-library": TESTS,
         "format-check": TESTS, "configure-tests": TESTS}
# Where `make consumer-check` builds a project that uses the library.
CONSUMER = "consumer/build"
NOBODYS = ("/proc/", "/sys/", "/dev/", "/run/", "/tmp/", "/var/", "/etc/", "/home/", "/usr/share/locale/",
           "/usr/lib/locale/", "/usr/lib/python3/dist-packages/_distutils_hack/")
FONTS = ("/usr/share/fonts/", "/usr/local/share/fonts/", "/usr/share/texmf/fonts/", "/usr/share/fontconfig/")
LOADER = re.compile(r"/ld(-[\w-]+)?\.so\.\d+$")
COMPILER = re.compile(r"cc1plus$|clang")
# Variables of CMake's cache, and what is there unless the user chooses something else.
DEFAULT_TOOLS = {"CMAKE_CXX_COMPILER": "g++", "CMAKE_MAKE_PROGRAM": "make"}
Read = collections.namedtuple("Read", "path reader list built")  # built: by the compiler or the linker


class NotRun(Exception):
    """The check is impossible here."""


class Failed(Exception):
    """The check found something, or cannot be made although it should."""


def run(command, **options):
    return subprocess.run(command, capture_output=True, text=True, check=False, errors="surrogateescape", **options)


def names_in(text):
    """The packages of a list: the first word of each line that is no comment."""
    return [line.split()[0] for line in (full.split("#")[0] for full in text.splitlines()) if line.strip()]


# ---- What was read

def dependencies_in(text):
    """Files named by a compiler's dependency file: `target: file file \\`, with a blank in a name as `\\ `."""
    _, _, files = text.replace("\\\n", " ").partition(": ")
    return [word.replace("\\ ", " ") for word in re.findall(r"(?:\\ |\S)+", files) if not word.endswith(":")]


def ninja_dependencies_in(text):
    """(object, file) of the answer of `ninja -t deps`."""
    target = ""
    for line in text.splitlines():
        if line.startswith("    "):
            yield target, line.strip()
        elif line:
            target = line.split(": #deps")[0]


def list_of(target):
    """Which list must be enough to build a target, by its path in the build folder."""
    return TESTS if re.match(r"(\./)?(tests|bench)/", target) else RUNS


def objects_in(commands):
    """What the compile commands of a build make; other objects in its folder are left from former sources."""
    outputs = ((command["directory"], re.search(r" -o (\S+)", command["command"])) for command in commands)
    return {os.path.normpath(os.path.join(directory, output[1])) for directory, output in outputs if output}


def compiled(build):
    """What compilers have read."""
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8", errors="surrogateescape") as file:
        objects = {os.path.relpath(path, os.path.abspath(build)) for path in objects_in(json.load(file))}
    for path in sorted(objects):
        if os.path.exists(os.path.join(build, path + ".d")):
            with open(os.path.join(build, path + ".d"), encoding="utf-8", errors="surrogateescape") as file:
                for name in dependencies_in(file.read()):
                    yield Read(name, f"the compiler for {os.path.basename(path)}", list_of(path), True)
    if os.path.exists(os.path.join(build, "build.ninja")):
        for target, name in ninja_dependencies_in(run(["ninja", "-C", build, "-t", "deps"]).stdout):
            yield Read(name, f"the compiler for {os.path.basename(target)}", list_of(target), True)


def linked(build):
    """Libraries that link commands name by their path."""
    commands = {}
    targets = os.path.join(build, "CMakeFiles/TargetDirectories.txt")
    with open(targets, encoding="utf-8", errors="surrogateescape") as file:
        folders = [os.path.relpath(line, os.path.abspath(build)) for line in file.read().splitlines()]
    for path in (os.path.join(folder, "link.txt") for folder in folders):
        if os.path.exists(os.path.join(build, path)):
            with open(os.path.join(build, path), encoding="utf-8", errors="surrogateescape") as file:
                commands[path] = file.read()
    if os.path.exists(os.path.join(build, "build.ninja")):
        lines = run(["ninja", "-C", build, "-t", "commands"]).stdout.splitlines()
        for line in lines:
            output = re.search(r" -o (bin/\S+)", line)
            if output:
                test = re.match(r"bin/(test_|fake_|bench_)", output[1])
                commands[("tests/" if test else "") + output[1]] = line
    for path, command in commands.items():
        program = re.search(r" -o (?:\S*/)?(\S+)", command)
        for name in re.findall(r"\s(/\S+\.(?:so|a)[.\d]*)(?=\s|$)", command):
            yield Read(name, f"the linker for {program[1] if program else path}", list_of(path), True)


def traced(lines, part):
    """What ran and was opened, of the lines of a strace."""
    seen, reader = set(), {}
    for line in lines:
        found = re.match(r'(\d+)\s+(\w+)\((?:AT_FDCWD, )?"(.*?)"', line)
        if not found:
            continue
        process, call, path = found.groups()
        if call == "execve":
            reader[process] = os.path.basename(path)
        elif COMPILER.match(reader.get(process, "")):
            continue
        if path not in seen and not path.startswith(FONTS) and not LOADER.search(path):
            seen.add(path)
            yield Read(path, f"{reader.get(process, 'a program')} in `make {part}`", PARTS[part], False)


def traces(build):
    """What the parts of `make check` have read, and the parts of which there is no trace."""
    reads, untraced = [], []
    for part in PARTS:
        path = os.path.join(build, "packages", f"{part}.trace")
        if os.path.exists(path):
            with open(path, encoding="utf-8", errors="surrogateescape") as file:
                reads += traced(file, part)
        else:
            untraced.append(part)
    return reads, untraced


def fonts(css):
    """The fonts that the report is printed with: fontconfig's choice for each list of families."""
    with open(css, encoding="utf-8") as file:
        families = re.findall(r"font-family:\s*([^;}]+)", file.read())
    for family in families if shutil.which("fc-match") else []:
        family = family.replace('"', "")
        yield Read(run(["fc-match", "-f", "%{file}", family]).stdout, f"font-family: {family} in {css}", RUNS, False)


def configure(build):
    """Configures two scratch folders, traced; and what a build does besides compiling."""
    trace = os.path.join(os.path.dirname(os.path.abspath(__file__)), "trace")
    for part, switch in (("configure", "OFF"), ("configure-tests", "ON")):
        scratch = os.path.join(build, "packages", part)
        shutil.rmtree(scratch, ignore_errors=True)
        commands = (f"cmake --preset release -B '{scratch}' -DESFEM_BUILD_TESTS={switch} "
                    f"-DESFEM_BUILD_BENCHMARKS={switch} $OPTIONS && "
                    f"env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL cmake --build '{scratch}' --target provenance")
        done = run([trace, part, "sh", "-c", commands], env={**os.environ, "BUILD": build})
        if done.returncode:
            raise Failed(f"a fresh configure failed: {scratch}\n{done.stdout}{done.stderr}")
        shutil.rmtree(scratch)


# ---- Whose it is

class Owners:
    """Which package a file belongs to."""

    def __init__(self, paths):
        names = {path for path in paths} | {os.path.realpath(path) for path in paths}
        # Packages may name a file by its place before /bin and /lib became links to /usr/bin and /usr/lib.
        names |= {name[4:] for name in names if re.match("/usr/(bin|sbin|lib)", name)}
        names = sorted(names)
        self.owner = {}
        for start in range(0, len(names), 2000):
            for line in run(["dpkg-query", "-S", *names[start:start + 2000]]).stdout.splitlines():
                packages, _, name = line.rpartition(": ")
                if not packages.startswith("diversion "):
                    self.owner.setdefault(name, packages.split(", ")[0].split(":")[0])

    def of(self, path):
        """The package, or None."""
        return self.owner.get(path) or (self.owner.get(path[4:]) if path.startswith("/usr/") else None)


def steps_to(path):
    """The file that a path leads to, and the link that it is, if a package may own that."""
    steps = [os.path.realpath(path)]
    link = os.path.join(os.path.realpath(os.path.dirname(path)), os.path.basename(path))
    if os.path.islink(link) and not os.readlink(link).startswith("/etc/alternatives/"):
        steps.append(link)
    return steps


def source_of(path):
    """The Python source of a compiled file."""
    found = re.fullmatch(r"(.*)/__pycache__/([^/]+?)\.[\w-]+(?:\.opt-\d)?\.pyc", path)
    return f"{found[1]}/{found[2]}.py" if found else path


def packages_read(reads, own, notes):
    """{(package, list): Read, one of its files}; files without owner, read by compiler or linker, as package ''.

    `own`: folders that concern no package.
    """
    ignored = tuple(folder.rstrip("/") + "/" for folder in (*NOBODYS, *own))
    places = {}
    for read in reads:
        path = os.path.normpath(source_of(read.path))
        if os.path.isabs(path) and os.path.isfile(path) and not path.startswith(ignored) and not path.endswith(".pth"):
            steps = steps_to(path)
            for place in steps if not steps[0].startswith(ignored) else ():
                places.setdefault((place, read.list), read._replace(path=place))
    owners = Owners({place for place, _ in places})
    found, foreign = {}, {}
    for (place, which), read in sorted(places.items()):
        package = owners.of(place)
        if package or read.built:
            found.setdefault((package or "", which), read)
        elif not place.startswith("/usr/") or place.startswith("/usr/local/"):
            foreign.setdefault("/".join(place.split("/")[:5]), read)
    for folder, read in foreign.items():
        notes.append(f"not judged: files in {folder}, which belong to no package, such as {read.path}, "
                     f"read by {read.reader}")
    return found


# ---- What apt installs on an empty system

class Apt:
    """apt with an empty status. Its own package lists are used, or fetched when this machine has none."""

    def __init__(self, folder):
        self.folder = os.path.abspath(folder)
        for name in ("lists/partial", "archives/partial"):
            os.makedirs(os.path.join(self.folder, name), exist_ok=True)
        with open(os.path.join(self.folder, "status"), "w", encoding="utf-8"):
            pass
        places = {"State::status": "status", "State::extended_states": "status", "Cache::archives": "archives",
                  "Cache::pkgcache": "pkgcache.bin", "Cache::srcpkgcache": "srcpkgcache.bin"}
        self.options = [f"-oDir::{key}={self.folder}/{name}" for key, name in places.items()]
        self.options += ["-oAPT::Install-Recommends=false", "-oDebug::NoLocking=true"]
        if not run(["apt-cache", *self.options, "show", "base-files"]).stdout:
            self.options.append(f"-oDir::State::lists={self.folder}/lists")
            run(["apt-get", *self.options, "-qq", "update"])
            if not run(["apt-cache", *self.options, "show", "base-files"]).stdout:
                raise NotRun("apt has no package lists and cannot fetch them (apt-get update)")

    def closure(self, packages):
        """The names of all packages that are there when `packages` have been installed on a minimal Debian."""
        # Not --simulate, which computes an order of installation, too, and takes three times as long.
        done = run(["apt-get", *self.options, "-qq", "--print-uris", "install",
                    "?essential", "?priority(required)", "apt", *packages], env={**os.environ, "LC_ALL": "C"})
        if done.returncode:
            raise Failed(f"apt-get cannot install the list on an empty system: {done.stderr.strip()}")
        return {line.split()[1].split("_")[0] for line in done.stdout.splitlines()}

    def reachable(self, packages):
        """No closure of `packages` has more: all that dependencies lead to, by whichever alternative and provider.

        In a tenth of the time.
        """
        unwanted = ("recommends", "suggests", "conflicts", "breaks", "replaces", "enhances")
        done = run(["apt-cache", *self.options, "depends", "--recurse", *(f"--no-{kind}" for kind in unwanted), *packages])
        if done.returncode:
            raise Failed(f"apt-cache does not know the dependencies of the list: {done.stderr.strip()}")
        return self.minimal() | {word for line in done.stdout.splitlines() for word in line.split()}

    @functools.cache
    def minimal(self):
        """The packages of a minimal Debian."""
        return self.closure([])


# ---- The verdict

def chosen_tools(build):
    """Packages of the compiler and the build tool, where they are not the default."""
    with open(os.path.join(build, "CMakeCache.txt"), encoding="utf-8", errors="surrogateescape") as file:
        cache = dict(re.findall(r"^(\w+):\w+=(.*)$", file.read(), re.M))
    tools = {os.path.realpath(cache[variable]) for variable, default in DEFAULT_TOOLS.items()
             if os.path.realpath(cache[variable]) != os.path.realpath(shutil.which(default) or "")}
    return [Owners(tools).of(tool) or tool for tool in sorted(tools)]


def missing(found, which, closure):
    """The packages read that the closure lacks, with an example: {package: Read}."""
    return {package: read for (package, reader_list), read in found.items()
            if reader_list == which and package not in closure}


def complaint(package, read):
    lists = RUNS if read.list == RUNS else f"{TESTS} (or {RUNS})"
    return (f"{read.path}, read by {read.reader}, belongs to " +
            (f"{package}, which nothing in {lists} brings: list it there" if package else
             "no package: the build depends on something that a Debian package does not bring"))


def check(found, lists, apt):
    """All complaints, one for a package."""
    closures = {RUNS: apt.closure(lists[RUNS]), TESTS: apt.closure(lists[RUNS] + lists[TESTS])}
    complaints = {}
    for which in LISTS:
        for package, read in sorted(missing(found, which, closures[which]).items()):
            complaints.setdefault(package, complaint(package, read))
    return list(complaints.values())


def without(package, found, lists, apt):
    """What happens when one package is taken from its list: ('implied' | 'missed' | 'superfluous', sentence)."""
    which = next(name for name in LISTS if package in lists[name])
    rest = [name for name in (lists[RUNS] if which == RUNS else lists[RUNS] + lists[TESTS]) if name != package]
    seen = found.get((package, which))
    if seen and package not in apt.reachable(rest):
        return "missed", f"without {package}: {complaint(package, seen)}"
    closure = apt.closure(rest)
    if package in closure:
        return "implied", f"{package}: other packages of the lists bring it"
    lacking = missing(found, which, closure)
    if lacking:
        example = package if package in lacking else min(lacking)
        return "missed", f"without {package}: {complaint(example, lacking[example])}"
    return "superfluous", f"{package} in {which} is needed by nothing that was seen, and brought by no other: remove it"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build", help="the build folder (default: build)")
    parser.add_argument("--without", metavar="PACKAGE|each",
                        help="then take this package away, or each in turn: the check must miss it")
    arguments = parser.parse_args()
    try:
        if not shutil.which("dpkg-query") or not shutil.which("apt-get"):
            raise NotRun("no dpkg and apt here; the lists are Debian's")
        return judge(arguments)
    except NotRun as reason:
        print(f"packages: NOT RUN: {reason}")
    except Failed as error:
        print(f"packages: {error}", file=sys.stderr)
        return 1
    return 0


def judge(arguments):
    lists, notes = {}, []
    for name in LISTS:
        with open(name, encoding="utf-8") as file:
            lists[name] = names_in(file.read())
    apt = Apt(os.path.join(arguments.build, "packages/apt"))
    configure(arguments.build)
    reads, untraced = traces(arguments.build)
    reads += fonts("plots/report.css")
    consumer = os.path.join(arguments.build, CONSUMER)
    for folder in [arguments.build] + [consumer] * os.path.exists(consumer):
        reads += [*compiled(folder), *linked(folder)]
    if untraced:
        notes.append(f"not judged: what runs in {', '.join(untraced)}: no trace; "
                     "`make check` makes it where strace may run")
    for program in ("strace", "dpkg-query", "apt-get"):
        reads.append(Read(shutil.which(program) or "", "the check of packages", TESTS, False))
    listed = [package for name in LISTS for package in lists[name]]
    chosen = chosen_tools(arguments.build)
    if chosen:
        notes.append(f"not judged: {', '.join(chosen)}, the compiler or build tool that was chosen for this build")
        lists[RUNS] = lists[RUNS] + [package for package in chosen if not os.path.isabs(package)]
    found = packages_read(reads, (os.getcwd(), os.path.abspath(arguments.build), os.path.expanduser("~")), notes)
    failed = check(found, lists, apt)
    for note in notes:
        print(f"packages: {note}")
    if failed:
        raise Failed("\npackages: ".join(failed))
    print(f"packages: {len({read.path for read in reads})} files of {len({package for package, _ in found})} packages "
          f"were read; {', '.join(LISTS)} bring them all")
    if arguments.without and untraced:
        print("packages: not judged: whether each package is needed, because not everything was seen")
    elif arguments.without:
        take_away(listed if arguments.without == "each" else [arguments.without], found, lists, apt)
    return 0


def take_away(packages, found, lists, apt):
    """Removes each of the packages in turn and reports the result."""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(lambda package: without(package, found, lists, apt), packages))
    for kind in ("missed", "implied"):
        for sentence in (sentence for found_kind, sentence in results if found_kind == kind):
            print(f"  {sentence}")
    superfluous = [sentence for kind, sentence in results if kind == "superfluous"]
    if superfluous:
        raise Failed("\npackages: ".join(superfluous))


if __name__ == "__main__":
    sys.exit(main())
