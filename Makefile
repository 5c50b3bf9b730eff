# Everything from a clean clone, with nothing but Python 3.11 or newer.
PYTHON ?= python3
BIN := .venv/bin
# What an installation is made from; the kernels are compiled when there is a compiler.
KERNELS := $(shell grep -rl --include=*.py "import cython" src/drystone/kernels; find src/drystone/kernels -name "*.p[yx][xd]")
SOURCES := pyproject.toml requirements.lock setup.py $(KERNELS)

.PHONY: demo test lint bench fuzz docs lock clean

demo: .venv/demo.stamp          ## plan a generated stone set and say where the picture is
	$(BIN)/drystone demo -o demo --overwrite

test: .venv/dev.stamp lint      ## lint, types, layers, tests
	$(BIN)/pytest -n 2

lint: .venv/dev.stamp
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports

bench: .venv/dev.stamp          ## times beside slow twins; QUICK=1 takes a minute instead of ten
	$(BIN)/python -m benchmarks $(if $(QUICK),--quick)

fuzz: .venv/dev.stamp           ## read damaged files of all formats: TIME=600 seconds, or COUNT=500000; SEED
	$(BIN)/python -m fuzz --keep fuzz-found $(if $(SEED),--seed $(SEED)) $(if $(COUNT),--count $(COUNT),--time $(or $(TIME),600))

docs: .venv/docs.stamp          ## pages with an executed gallery in docs/_build/html
	$(BIN)/sphinx-build -b html -n -W --keep-going -q docs docs/_build/html
	@echo "docs/_build/html/index.html"

.venv/demo.stamp: $(SOURCES)
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c requirements.lock -e .
	@touch $@

.venv/dev.stamp: $(SOURCES)
	$(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c requirements.lock -e '.[dev]'
	@touch $@ .venv/demo.stamp

# The package is there already, so this adds what the extra names and compiles nothing again.
.venv/docs.stamp: .venv/demo.stamp
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -c requirements.lock 'drystone[docs]'
	@touch $@

lock:                           ## renew requirements.lock (needs uv)
	uv pip compile --quiet --universal --python-version 3.11 --all-extras --no-emit-index-url \
		--no-header --output-file requirements.lock pyproject.toml

clean:
	rm -rf .venv demo fuzz-found build dist docs/_build docs/auto_gallery src/*.egg-info .mypy_cache .ruff_cache .pytest_cache .hypothesis
