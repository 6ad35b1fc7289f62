# make run      install what is missing, then compute jobs/case1.toml
# make test     install what is missing, then run the fast tests (those with mpirun included) in one
#               process a core, at most 4; WORKERS=2: in so many, WORKERS=0: in pytest's own
# make test-all all tests; make lint: ruff and mypy; make bench: assembly against MUMPS
SHELL := /bin/bash
PYTHON := .venv/bin/python
WORKERS ?= auto

# One BLAS thread per rank: more of them only slow each other (and MUMPS) down.
export OPENBLAS_NUM_THREADS := 1
export OMP_NUM_THREADS := 1
export OMPI_MCA_rmaps_base_oversubscribe := 1
ifeq ($(shell id -u),0)
export OMPI_ALLOW_RUN_AS_ROOT := 1
export OMPI_ALLOW_RUN_AS_ROOT_CONFIRM := 1
endif

.PHONY: run test test-all lint bench install clean

run: install
	@.venv/bin/porolub run jobs/case1.toml

# A test that hangs where no signal reaches it, in PETSc say, ends its worker, and with it the test.
test: install
	@$(PYTHON) -m pytest -m "not slow" -n $(WORKERS) --dist worksteal \
		-o faulthandler_timeout=420 -o faulthandler_exit_on_timeout=true

test-all: install
	@$(PYTHON) -m pytest

lint: install
	@$(PYTHON) -m ruff check .
	@$(PYTHON) -m mypy

bench: install
	@$(PYTHON) tests/bench/assembly.py

install:
	@bash .ci/install.sh

clean:
	rm -rf .venv build *.egg-info porolub/fem/_kernels*.so porolub/laws/_tensors*.so
	find porolub tests -name __pycache__ -prune -exec rm -rf {} +
