# Everything that a user or a developer calls; each sets up first what it needs.

SHELL := /bin/bash
in_env := source scripts/env.bash &&

# Tests of nodes wait more than they compute: three or four processes. A process
# that has nothing left takes half of what another one has left.
WORKERS := $(shell n=$$(nproc); echo $$((n < 2 ? 3 : 4)))
export ROS_AUTOMATIC_DISCOVERY_RANGE ?= LOCALHOST
export PYTHONDONTWRITEBYTECODE :=

.PHONY: help setup demo studio test lint bench clean

help:
	@sed -n 's/^\([a-z]*\):.*## /  make \1\t/p' Makefile | expand -t 16

setup:  ## ROS 2 Jazzy, Python packages and the build, unless they are there
	@scripts/setup.bash

demo: setup  ## plan a motion through via points and run it on the simulated arm; options in ARGS
	@$(in_env) demo $(ARGS)

studio: setup  ## a page in the browser to plan with the mouse and run the plan; options in ARGS
	@$(in_env) python -m pip install --quiet --no-deps -r requirements/studio.txt
	@$(in_env) studio $(ARGS)

# Their rules are those of flake8, which `lint` has just run; `colcon test` runs them.
CHECKED_BY_LINT := $(addprefix --deselect test/test_ament_linters.py::test_,\
	code_is_as_ament_flake8_wants_it docstrings_are_as_ament_pep257_wants_them)

test: lint  ## linters and every test; options for pytest in ARGS
	@$(in_env) python -m pytest -n $(WORKERS) --dist worksteal $(CHECKED_BY_LINT) $(ARGS)

lint: setup  ## ruff, flake8 with ament_flake8's rules, mypy on the core and the planners
	@$(in_env) ruff check && python -m flake8 && mypy

bench: setup  ## run the benchmarks; options in ARGS
	@$(in_env) python -m pip install --quiet --no-deps -r requirements/bench.txt
	@$(in_env) OPENBLAS_NUM_THREADS=1 python benchmarks/run.py $(ARGS)

clean:  ## leave what a fresh clone has
	rm -rf rrr_traj_planner/core/native/*.so .venv build install log .*_cache .hypothesis demo_*.png
	find . -name __pycache__ -prune -exec rm -rf {} +
