# On a machine with Python >= 3.11, pip and make: `make ride` and `make test` do all the set-up.
# Another Python: make PYTHON=python3.12 test

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PIP_INSTALL := install --quiet --disable-pip-version-check --constraint constraints.txt

.PHONY: help ride test lint format docs derivations bench guard fuzz clean
.DEFAULT_GOAL := help

help: ## List what there is to make
	@grep -E '^[a-z]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):.*## /  make \1 	/'

ride: $(VENV)/test.stamp ## Derive the paper's coach, run it over 1 km at 145 and 200 km/h, rate it
	$(BIN)/python -m railride ride --plots ride-plots

# One process for each processor, and so one thread of linear algebra in each; sympy remembers more
# than its thousand results, for the hundreds of vehicles that are derived.
test: $(VENV)/test.stamp ## Run the tests and the examples in the documentation
	OPENBLAS_NUM_THREADS=1 SYMPY_CACHE_SIZE=20000 $(BIN)/python -m pytest --numprocesses auto --dist worksteal

lint: $(VENV)/dev.stamp ## Check style, format and types
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy

format: $(VENV)/dev.stamp ## Mend what style and format checks can mend
	$(BIN)/ruff check --fix
	$(BIN)/ruff format

docs: $(VENV)/docs.stamp ## Build the documentation site in build/docs; a warning is an error
	OPENBLAS_NUM_THREADS=1 $(BIN)/sphinx-build -W --keep-going -q -c docs -d build/doctrees . build/docs

DERIVE := $(BIN)/python -m railride derive --format markdown
COACH := $(DERIVE) --nonlinear --vehicle cati2024

derivations: $(VENV)/test.stamp ## Make the pinned derivations again
	$(DERIVE) --system half-body --output derivations/half_body.md
	$(DERIVE) --system half-body-free --output derivations/half_body_free.md
	$(COACH) --system body --segments 2 --output derivations/body_2.md
	$(COACH) --system body --segments 4 --output derivations/body_4.md
	$(COACH) --segments 1 --output derivations/vehicle_1.md
	$(COACH) --segments 2 --output derivations/vehicle_2.md
	$(COACH) --segments 4 --output derivations/vehicle_4.md
	$(BIN)/python derivations/paper_check.py
	$(BIN)/python derivations/reproduction.py

bench: $(VENV)/test.stamp ## Measure against peers; writes benchmarks/results.json
	$(BIN)/python benchmarks/run.py

FUZZ := OPENBLAS_NUM_THREADS=1 $(BIN)/python tests/damaged_files.py

fuzz: $(VENV)/test.stamp ## Ten thousand damaged files to the commands, 300 of them as processes too
	$(FUZZ) --count 10000
	$(FUZZ) --count 10000 --processes 300

guard: $(VENV)/test.stamp ## Count instructions under valgrind, against those kept
	$(BIN)/python benchmarks/guard.py

clean: ## Remove the environment, caches and outputs
	rm -rf $(VENV) .mypy_cache .pytest_cache .ruff_cache .hypothesis ride-plots build dist

# The environment is made without pip and filled by the pip at hand: some systems ship Python without
# ensurepip. The build tools are pinned as well, and so the build is not isolated from them.
$(VENV)/python.stamp: constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { \
	  echo "railride needs Python 3.11 or newer, and $(PYTHON) is" \
	    "$$($(PYTHON) --version 2>&1). Name another: make PYTHON=python3.12 $(MAKECMDGOALS)" >&2; \
	  exit 1; }
	@$(PYTHON) -m pip --version >/dev/null 2>&1 || { \
	  echo "railride is set up with pip, and $(PYTHON) has none: install it (python3-pip)" >&2; \
	  exit 1; }
	$(PYTHON) -m venv --clear --without-pip $(VENV)
	$(PYTHON) -m pip --python $(BIN)/python $(PIP_INSTALL) hatchling editables
	@touch $@

$(VENV)/test.stamp: $(VENV)/python.stamp pyproject.toml
	$(PYTHON) -m pip --python $(BIN)/python $(PIP_INSTALL) --no-build-isolation --editable '.[test]'
	@touch $@

$(VENV)/docs.stamp: $(VENV)/test.stamp
	$(PYTHON) -m pip --python $(BIN)/python $(PIP_INSTALL) --no-build-isolation --editable '.[docs]'
	@touch $@

$(VENV)/dev.stamp: $(VENV)/test.stamp
	$(PYTHON) -m pip --python $(BIN)/python $(PIP_INSTALL) --no-build-isolation --editable '.[dev]'
	@touch $@
