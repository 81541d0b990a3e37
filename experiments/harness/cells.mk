# SPDX-License-Identifier: GPL-3.0-or-later
# The cells, tables and figures of the experiments STEMS at one PRESET, drawn by PYTHON; the Makefile calls it from the
# project's root when results/PRESET/cells/STEM/.list and .executable are there, and results/PRESET/cells/.progress of
# cell_done. Goals: tables, figures, all; groups runs the cells that cell_groups has packed.

SHELL := bash
.SHELLFLAGS := -eu -o pipefail -c
.ONESHELL:
.DELETE_ON_ERROR:
.SUFFIXES:

# The prefix of the command of every cell or group, such as LAUNCH="srun -n1".
LAUNCH ?=
BUILD ?= build
BIN := $(BUILD)/bin
cells := results/$(PRESET)/cells
figures := $(if $(filter paper,$(PRESET)),figures,$(BUILD)/figures-check)
plotted := $(foreach stem,$(STEMS),$(if $(wildcard plots/$(stem).py),$(stem)))
# The pictures that take longest come first.
plotted := $(filter mcf_dumbbell,$(plotted)) $(filter-out mcf_dumbbell,$(plotted))

# Of all experiments together, most expensive first: so the last runs to finish are short ones.
all_cells := $(shell cd $(cells) && for s in $(STEMS); do sed "s|^\([^ ]*\)|$$s/\1.json|" $$s/.list; done | \
  sort -k2,2gr | cut -d' ' -f1)
all_cells := $(addprefix $(cells)/,$(all_cells))
cells_of = $(filter $(cells)/$(1)/%,$(all_cells))

# Cells packed by cell_groups: each group is one process that LAUNCH starts. One that fails stops no other.
groups := $(shell ls -v $(cells)/.groups/* 2>/dev/null)

.PHONY: all tables figures groups $(groups)
all: tables figures
	@:
tables: $(all_cells) $(STEMS:%=results/$(PRESET)/%.json)
figures: tables $(plotted:%=$(figures)/.%.drawn)
groups: $(groups)
$(groups):
	@experiments/harness/cell_groups launch $@ $(LAUNCH)

define stem_rules
$(call cells_of,$(1)): $(cells)/$(1)/%.json: $(cells)/$(1)/.executable
	@$$(LAUNCH) $(BIN)/$(1) --preset $(PRESET) --cell $$* --output $$@
	experiments/harness/cell_done $(cells)/.progress $(1) $$*

results/$(PRESET)/$(1).json results/$(PRESET)/$(1).csv results/$(PRESET)/$(1).tex &: $(call cells_of,$(1))
	@$(BIN)/$(1) --preset $(PRESET) --collect $(cells)/$(1) --output results/$(PRESET)/$(1).json
	echo "$(1): results/$(PRESET)/$(1).json"

$(figures)/.$(1).drawn: results/$(PRESET)/$(1).json $(filter-out plots/test%,$(wildcard plots/*.py))
	@mkdir -p $(figures)
	$$(PYTHON) plots/$(1).py results/$(PRESET)/$(1).json $(figures)
	touch $$@
	echo "$(1): drawn into $(figures)"
endef
$(foreach stem,$(STEMS),$(eval $(call stem_rules,$(stem))))
