# SPDX-License-Identifier: GPL-3.0-or-later
# `make help` lists the targets. Needs GNU make 4.3.
#
# Every experiment is a grid of cells (independent runs), known only to its executable. So the targets that run
# experiments first build, then list the cells (`run`), and then call experiments/harness/cells.mk, where each cell, table
# and figure is an ordinary target.

SHELL := bash
.SHELLFLAGS := -eu -o pipefail -c
.ONESHELL:
.NOTPARALLEL:
.SUFFIXES:
MAKEFLAGS += --no-builtin-rules --no-print-directory

cores := $(shell nproc 2>/dev/null || echo 1)
ifeq ($(MAKELEVEL),0)
MAKEFLAGS += -j$(cores)
endif
# Known only inside recipes. The build and the tests run on this machine, whatever LAUNCH and -j say about the cells.
asked_jobs = $(patsubst -j%,%,$(filter -j%,$(MAKEFLAGS)))
local_jobs = $(shell n=$(asked_jobs); echo $$(( $${n:-$(cores)} < $(cores) ? $${n:-$(cores)} : $(cores) )))

# Another folder leaves the source tree unchanged: make build BUILD=/tmp/esfem
BUILD ?= build
ifneq ($(words $(BUILD)),1)
$(error BUILD is "$(BUILD)": make needs a folder without blanks in its name)
endif
export BUILD
BIN := $(BUILD)/bin
# Debian's Python has Debian's matplotlib, but another one may come first.
PYTHON ?= $(shell for p in python3 /usr/bin/python3; do \
  $$p -c 'import matplotlib' 2>/dev/null && echo $$p && exit; done; echo no-python3-with-matplotlib)
stems := $(sort $(basename $(notdir $(shell grep -l run_experiment experiments/*.cpp 2>/dev/null))))
programs := evolve study check_orders compare_tables
sources = $(shell find solver experiments tests bench -name '*.cpp' -o -name '*.hpp')

.PHONY: help figures check bench bench-peers deps configure build test test-library test-plots test-vtu test-norms sanitize fuzz crash \
        crash-check consumer-check format format-check samples samples-check tables-check verdicts claims-check independent \
        plots-check report report-check packages-check packages-check-each findings gallery groups docs site site-check \
        clean distclean prepare-figures prepare-report $(programs) $(stems) $(stems:%=prepare-%)

help:
	@echo "make figures       install what is missing, build, run every experiment as published, draw all figures"
	@echo "                   -> results/paper/STEM.{json,csv,tex}, figures/<paper>/fig*.{pdf,png}"
	@echo "make check         install, build, all unit tests, every experiment at preset check, a verdict per claim"
	@echo "make report        one page with every figure, claim and verdict, from the published results that exist"
	@echo "                   -> report/index.html, report/report.pdf, report/verdicts.json"
	@echo "make STEM          one experiment as published, with its figures; STEM is one of"
	@echo "                   $(or $(stems),(none yet))"
	@echo "make evolve        only the program for your own surface, mesh and flow -> $(BIN)/evolve"
	@echo "make study         only the program for the convergence of such a problem -> $(BIN)/study"
	@echo "make sanitize      tests of fe, mesh, assembly, linalg, time and tables under AddressSanitizer and UBSan"
	@echo "make crash         kills runs at KILLS=200 random moments, fills disks, damages checkpoints; then compares the numbers"
	@echo "make fuzz          mutated files for each reader, SECONDS=60 of each, in build-fuzz/ (needs clang)"
	@echo "make bench         ms per step and phase at growing sizes, factorisations compared with CHOLMOD and MUMPS"
	@echo "make bench-peers   a step compared with DOLFINx and PETSc, vesicles with Surface Evolver, where they are installed"
	@echo "make build | test | format | format-check | packages-check | deps     parts of the above"
	@echo "make samples       runs the configurations in reference/examples and compares their ends with what is expected"
	@echo "make findings      docs/findings/ and the tables of README.md, from the published results"
	@echo "make gallery       the same, and the pictures in docs/"
	@echo "make docs | site   API pages of the library (doxygen); all pages for a browser in site/ (python3-markdown)"
	@echo "make clean         remove build/ and results/check/; published results and figures are kept and reused"
	@echo "make distclean     remove results/, figures/ and report/ as well"
	@echo
	@echo "-jN                N jobs at once instead of one per core ($(cores) here)"
	@echo "BUILD=FOLDER       build there instead of in build/"
	@echo "CXX=clang++, CMAKE_GENERATOR=Ninja, OPTIONS=-D...  another compiler, build tool, options for CMake"
	@echo 'GROUP=60           runs in groups of about 60 s, each one process; failed runs are tried twice and stop no others'
	@echo 'LAUNCH="srun -n1"  prefix of the command of each run or group; docs/cluster.md says how with Slurm'
	@echo "make groups        the groups alone, for a job array -> results/paper/cells/.groups/1, 2, ..."
	@echo "Interrupt it at any time and repeat the command: finished runs are kept."

# prepare(step, kinds of packages, targets): packages, configuration and executables, as far as a target needs them.
prepare = JOBS=$(local_jobs) OPTIONS="$(OPTIONS)" experiments/harness/prepare $(1) "$(2)" $(3)
prepare-figures:
	@$(call prepare,build,build figures,experiments)
prepare-report:
	@$(call prepare,build,build figures report,check_orders)
$(stems:%=prepare-%): prepare-%:
	@$(call prepare,build,build figures,$*)
$(programs):
	@$(call prepare,build,build,$@)
deps configure build:
	@$(call prepare,$@,build figures report tests peers bench format)

figures: prepare-figures
	+@start=$$SECONDS
	$(call run,paper,$(stems),all)
	echo "== everything as published: $$((SECONDS - start)) s, excluding compilation. Seconds on one core, and the most expensive runs:"
	grep -Hm1 '"seconds":' $(stems:%=results/paper/cells/%/*.json) | tr -d ',' | awk -F'[/: ]+' '
	  { stem = $$4; sub(".json", "", $$5); of[stem] += $$NF; all += $$NF; n += 1; run[stem " " $$5] = $$NF }
	  END { for (s in of) printf "%8.0f  %s\n", of[s], s | "sort -gr"; close("sort -gr")
	        printf "%8.0f  %d runs in all\n", all, n
	        for (r in run) printf "%8.0f  %s\n", run[r], r | "sort -gr | head -n 8" }'

# report_of(preset, figures, folder, options): the verdicts on the existing tables, then the report.
define report_of
mkdir -p $(3); status=0
tables=$$(ls $(stems:%=results/$(1)/%.json) 2>/dev/null || true)
if [ -z "$$tables" ]; then echo "no tables in results/$(1): run make figures or make STEM first" >&2; exit 1; fi
$(BIN)/check_orders $$tables --output $(3)/verdicts.json >$(3)/verdicts.txt || status=$$?
if [ $$status = 1 ] || [ $$status = 2 ]; then exit $$status; fi
tail -n 1 $(3)/verdicts.txt
# What each claim catches; the exit code 3 says that some miss a spoiled table, which claims-check judges.
catches=$(3)/catches.json
if [ ! -f $$catches ] || [ -n "$$(find reference tests/claims $(BIN)/check_orders $$tables -type f -newer $$catches)" ]; then
  $(PYTHON) tests/claims/spoil.py --build $(BUILD) --json $$catches results/$(1) >/dev/null || [ $$? = 3 ]
fi
$(PYTHON) plots/report.py $(3)/verdicts.json $(2) $(3) --catches $$catches $(4)
endef
report: prepare-report
	@$(call report_of,paper,figures,report)
# What docs/ and README.md say of the published results, and the pictures in docs/.
gallery: findings samples
	@$(PYTHON) plots/gallery.py report/verdicts.json $(BUILD)/evolve.schema.json figures README.md docs
	@$(BIN)/evolve reference/examples/turing.json
	@$(PYTHON) plots/own_problem.py build/turing/surfaces.pvd u1 docs/own_problem.png
	$(PYTHON) plots/examples.py $(BUILD)/samples docs
	$(PYTHON) plots/study.py $(BUILD)/samples/study/table.json $(BUILD)/samples
	$(PYTHON) plots/sweep.py $(BUILD)/samples/sweep/table.json --x parameters.b --y parameters.gamma --colour max_u1
	cp $(BUILD)/samples/study_h.png docs/example_study.png
	cp $(BUILD)/samples/sweep/sweep.png docs/example_sweep.png
# The API from the headers' comments, and all pages for a browser. Their tools are in no list: nothing else needs them.
docs:
	@if ! command -v doxygen >/dev/null; then echo "missing: doxygen; install it (Debian's name) and try again" >&2; exit 1; fi
	mkdir -p $(BUILD)/api
	ESFEM_VERSION=$$(sed -n 's/^project(esfem VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt) ESFEM_API=$(BUILD)/api doxygen docs/Doxyfile
	echo "docs: $(BUILD)/api/html/index.html"
site:
	@$(PYTHON) plots/site_pages.py site --report report --figures figures --api $(BUILD)/api/html
# Every page in a browser, where Chromium is installed: nothing on its console, nothing wider than the page. The packages of
# these tests are in no list, so they are no part of the check.
site-check: site
	@$(PYTHON) -m unittest discover -q -s tests/site
	$(PYTHON) tests/site/check_site.py site $(BUILD)/site-check
findings: report evolve
	@$(BUILD)/bin/evolve --schema >$(BUILD)/evolve.schema.json
	@$(PYTHON) plots/gallery.py report/verdicts.json $(BUILD)/evolve.schema.json none README.md docs
	@$(PYTHON) plots/findings.py report/verdicts.json docs
# The page alone: printing it takes longer, and its test prints a small one.
report-check:
	@$(call report_of,check,$(BUILD)/figures-check,$(BUILD)/report-check,--expect tables --without-pdf)

$(stems): %: prepare-%
	+@$(call run,paper,$@,all)

# All parts of the check run; those that failed are listed at the end. Files they read are traced for the last part.
check_parts := format-check test-library test-plots test-vtu test-norms crash-check consumer-check samples-check tables-check \
               verdicts claims-check independent plots-check report-check packages-check
check: build
	+@failed=""
	for part in $(check_parts); do
	  echo "== $$part"; start=$$SECONDS
	  tests/packages/trace $$part $(MAKE) $$part PYTHON="$(PYTHON)" || failed="$$failed $$part"
	  echo "== $$part took $$((SECONDS - start)) s"
	done
	if [ -n "$$failed" ]; then echo "== check FAILED:$$failed"; exit 1; fi
	echo "== check passed: $(check_parts)"

# `check` has built what its parts need; a part that is run on its own builds first.
ifeq ($(MAKELEVEL),0)
test-library test-plots test-vtu test-norms crash-check consumer-check samples-check tables-check verdicts claims-check independent \
  plots-check report-check packages-check: build
endif

# run_tests(folder, options): tests that pass are not listed.
run_tests = ctest --test-dir $(1) --output-on-failure -j$(local_jobs) $(2) | \
  { grep -vE '^ +Start +[0-9]+: |   Passed  ' || true; }
test: test-library test-plots test-vtu test-norms
test-library:
	@$(call run_tests,$(BUILD))
test-plots:
	@for folder in packages samples; do $(PYTHON) -m unittest discover -q -s tests/$$folder || exit; done & scripts=$$!
	(cd plots && basename -s .py -a test_*.py | xargs -n5 -P$(local_jobs) $(PYTHON) -m unittest -q)
	wait $$scripts
# VTK and ParaView read the snapshots where they are installed; so their files belong to no package of the lists.
test-vtu:
	@$(PYTHON) tests/mesh/test_vtu_files.py -q
# The errors of elements of degree 2 to 4, computed anew with numpy from nodal values.
test-norms:
	@$(PYTHON) tests/analysis/test_norms.py -q

# Sanitizers for the tests of fe, mesh, assembly, linalg, time and tables; flows and the finest meshes take too long.
sanitize:
	@export BUILD=build-asan PRESET=asan LSAN_OPTIONS="suppressions='$(CURDIR)/tests/leaks.txt':print_suppressions=0"
	$(call prepare,build,build tests peers,sanitized)
	$(call run_tests,$$BUILD,-L '^(fe|mesh|assembly|linalg|time|tables)$$' \
	  -E 'GeneratedMesh.KeepsItsPromises.*_(50|100|125) |FollowsASizeFunction|GradesByACurvatureThatJumps|Peers.BgnSystems|ResolvesADeeplyPerturbedTorus|IsTheSameToTheBitAfterOtherCalls|FitOrders.Intervals')

# Runs that are killed at random moments, full disks, damaged checkpoints; a part of it as a check.
crash: build
	@$(PYTHON) tests/crash/crash.py --build $(BUILD) --kills $(or $(KILLS),200)
crash-check:
	@$(PYTHON) tests/crash/crash.py --build $(BUILD) --kills 20 --cuts 0 evolve cut

# The library as others use it: installed below the build folder, and found by an independent project.
consumer-check:
	@$(PYTHON) -m unittest discover -q -s tests/consumer
	$(PYTHON) tests/consumer/check_consumer.py --build $(BUILD)

# Each reader of input files is run on mutations of its corpus. New inputs are kept in
# build-fuzz/corpus; one that makes a reader fail is build-fuzz/TARGET-crash-*, and becomes a file of tests/fuzz/corpus.
SECONDS ?= 60
fuzz:
	@if ! command -v clang++ >/dev/null; then echo "no clang++: install clang and libclang-rt-14-dev" >&2; exit 1; fi
	export BUILD=build-fuzz PRESET=fuzz CXX=clang++
	$(call prepare,build,build tests peers,fuzzers)
	basename -a tests/fuzz/corpus/* | xargs -P$(local_jobs) -I{} sh -c 'mkdir -p build-fuzz/corpus/{} && \
	  build-fuzz/bin/fuzz_{} -max_total_time=$(SECONDS) -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
	    -artifact_prefix=build-fuzz/{}- build-fuzz/corpus/{} tests/fuzz/corpus/{} >build-fuzz/{}.log 2>&1 || \
	  { tail -n 40 build-fuzz/{}.log; exit 255; }'
	grep -H stat::number_of_executed_units build-fuzz/*.log

format:
	@$(call prepare,deps,format)
	clang-format -i $(sources)
format-check:
	@$(call prepare,deps,format)
	clang-format --dry-run -Werror $(sources) && echo "$(words $(sources)) files are formatted"

# The configurations of reference/examples, compared with expected.json beside them; a few minutes.
samples: evolve study
	@$(PYTHON) tests/samples/run_samples.py --build $(BUILD) --jobs $(local_jobs)
	$(BIN)/study reference/examples/study_ellipsoid.json --levels 0-3 --output $(BUILD)/samples/study
	$(BIN)/evolve reference/examples/sweep_schnakenberg.json --set parameters.gamma=10,20,40,80 --set parameters.b=0.6,0.7,0.8,0.9,1 \
	  --output $(BUILD)/samples/sweep

# The sample command lines in the heads of the experiments must be valid.
samples-check:
	@for stem in $(stems); do
	  sed -n "s|^//.*build/bin/\($$stem .*\)|$(BIN)/\1|p" experiments/$$stem.cpp | sed 's/ --output [^ ]*//' | while read -r command; do
	    $$command --list >/dev/null; echo "accepted: $$command"
	  done
	done

tables-check:
	+@$(call run,check,$(stems),tables)
plots-check:
	+@$(call run,check,$(stems),figures)

# Whether the checks of claims can fail: on spoiled tables.
claims-check:
	@mkdir -p $(BUILD)/report-check
	$(PYTHON) tests/claims/spoil.py --build $(BUILD) --known tests/claims/known.txt --json $(BUILD)/report-check/catches.json results/check
verdicts:
	@$(if $(stems),$(BIN)/check_orders $(stems:%=results/check/%.json),echo "no experiments")

# Do packages.txt and packages-tests.txt install all files that are read, and is each of their packages needed?
# The removal of libgmock-dev must be detected (it once was not). WITHOUT=each removes one package after the other.
packages-check:
	@$(PYTHON) tests/packages/check_packages.py --build $(BUILD) --without $(or $(WITHOUT),libgmock-dev)
packages-check-each:
	@$(MAKE) packages-check WITHOUT=each

# The errors of an independent implementation, on its meshes and with its quadrature rule.
independent_meshes := $(foreach n,642 1442 2562,--mesh reference/independent/sphere_radius2_$(n).msh)
independent_unit_meshes := $(foreach n,642 1442 2562,--mesh reference/independent/sphere_radius1_$(n).msh)
independent:
	@mkdir -p results/check/independent
	$(BIN)/mcf_sphere --flow mean_curvature $(independent_meshes) --quadrature conical:4 --steps 0-6 --output results/check/independent/mcf_sphere.json
	$(BIN)/compare_tables results/check/independent/mcf_sphere.json reference/independent/table_mcf_sphere.json --from-step 3
	$(BIN)/check_orders results/check/independent/mcf_sphere.json --reference reference/independent
	$(BIN)/coupled_diffusion $(independent_unit_meshes) --quadrature conical:4 --steps 0-3 --output results/check/independent/coupled_diffusion.json
	$(BIN)/compare_tables results/check/independent/coupled_diffusion.json reference/independent/table_coupled_diffusion.json

bench:
	@$(call prepare,build,build bench peers,bench_step)
	@# One thread each; OpenBLAS does not know CPUs newer than itself, so its best kernels are chosen here.
	core=$$(grep -qw avx512vl /proc/cpuinfo && echo SkylakeX || { grep -qw avx2 /proc/cpuinfo && echo Haswell; } || true)
	OMP_NUM_THREADS=1 OMP_THREAD_LIMIT=1 OPENBLAS_NUM_THREADS=1 OPENBLAS_CORETYPE=$$core $(BIN)/bench_step

bench-peers:
	@$(call prepare,build,build bench peers,bench_step evolve helfrich_vesicles)
	$(BIN)/bench_step --write-step $(BUILD)/step.json
	$(PYTHON) bench/peer_dolfinx.py $(BUILD)/step.json
	$(PYTHON) bench/peer_evolver.py $(BIN)

clean:
	rm -rf $(BUILD) results/check
distclean: clean
	rm -rf results figures report site

# list_cells(preset, stems): the cells of each stem, and how many are to do. The cells depend on `.executable`, the checksum
# of their executable: a build that leaves it unchanged outdates nothing.
define list_cells
for stem in $(2); do
  folder=results/$(1)/cells/$$stem; mkdir -p $$folder
  sha256sum <$(BIN)/$$stem >$$folder/.executable.new
  cmp -s $$folder/.executable.new $$folder/.executable || mv $$folder/.executable.new $$folder/.executable
  rm -f $$folder/.executable.new
  $(BIN)/$$stem --preset $(1) --list >$$folder/.list
  while read -r cell cost; do
    if [ ! -f $$folder/$$cell.json ] || [ $$folder/.executable -nt $$folder/$$cell.json ]; then echo $$cost; else echo; fi
  done <$$folder/.list
done | awk -v start=$$(date +%s) -v progress=results/$(1)/cells/.progress '
  NF { n += 1; s += $$1 }
  END { if (n) printf "== %d runs to do, %d are done; about %.0f s on one core\n", n, NR - n, s
        printf "%d %d %d %g\n", start, NR - n, NR, s >progress }'
endef

# run(preset, stems, goal): lists the cells of the stems, then makes the goal of cells.mk. With GROUP the cells are run before,
# in groups, and the goal is made of the stems that are complete.
make_cells = $(MAKE) -f experiments/harness/cells.mk PRESET=$(1) STEMS="$(2)" PYTHON=$(PYTHON) $(3)
define run
$(call list_cells,$(1),$(2))
$(if $(GROUP),$(call run_groups,$(1),$(2),$(3)),$(call make_cells,$(1),$(2),$(3)))
endef
define run_groups
experiments/harness/cell_groups pack $(1) "$(GROUP)" $(2)
$(call make_cells,$(1),$(2),groups)
complete=$$(experiments/harness/cell_groups complete $(1) $(2) | xargs)
[ -z "$$complete" ] || $(call make_cells,$(1),$$complete,$(3))
experiments/harness/cell_groups failed $(1) $(2)
endef

# For a job array: the groups alone (docs/cluster.md).
groups: prepare-figures
	@$(call list_cells,paper,$(stems))
	experiments/harness/cell_groups pack paper "$(or $(GROUP),60)" $(stems)
