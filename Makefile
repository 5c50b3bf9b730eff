# Everything from a clean clone, with nothing but Python 3.11 or newer.
PYTHON ?= python3
BIN := .venv/bin
PIP := $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile
# What an installation is made from; the kernels are compiled when there is a compiler.
KERNELS := $(shell grep -rl --include=*.py "import cython" src/drystone/kernels; find src/drystone/kernels -name "*.p[yx][xd]")
SOURCES := pyproject.toml setup.py $(KERNELS)

# Tests start many processes: Python compiles what they import once, whatever the machine has set.
export PYTHONDONTWRITEBYTECODE :=

.PHONY: demo test quick lint bench fuzz docs licences sbom lock clean

demo: .venv/demo.stamp          ## plan a generated stone set and say where the picture is
	$(BIN)/drystone demo -o demo --overwrite

test: .venv/dev.stamp lint      ## lint, types, layers, tests
	$(BIN)/pytest -n 2 --dist worksteal

# Of src/drystone/ROOM/... and tests/ROOM/... the tests of the room, of the lab those of the lab.
ROOMS := 's,^(src/drystone|tests)/([a-z_]+)/.*,tests/\2,p; s,^src/drystone_lab/.*,tests/lab,p; \
	s,^src/drystone/([a-z_]+)\.py$$,tests/test_\1.py,p; s,^tests/test_[a-z_]+\.py$$,&,p'

quick: .venv/dev.stamp          ## lint what differs from main and test its rooms, in under a minute
	@changed=$$(git diff --name-only --diff-filter=d main -- '*.py'; \
		git ls-files --others --exclude-standard -- '*.py'); \
	[ -n "$$changed" ] || { echo "nothing differs from main"; exit 0; }; \
	$(BIN)/ruff format --check $$changed && $(BIN)/ruff check $$changed || exit 1; \
	rooms=$$(echo "$$changed" | sed -nE $(ROOMS) | sort -u); \
	tests=$$([ -z "$$rooms" ] || find $$rooms -name 'test_*.py' 2>/dev/null); \
	[ -n "$$tests" ] || { echo "no tests of what differs"; exit 0; }; \
	timeout 45 $(BIN)/pytest -q -x --failed-first -n 2 $$tests; code=$$?; \
	[ $$code -ne 124 ] || { echo "stopped after 45 s, nothing failed so far: make test"; exit 0; }; \
	exit $$code

lint: .venv/dev.stamp
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/python tools/size.py
	$(BIN)/python tools/prose.py

bench: .venv/dev.stamp          ## times beside slow twins; QUICK=1 takes a minute instead of ten
	$(BIN)/python -m benchmarks $(if $(QUICK),--quick)

fuzz: .venv/dev.stamp           ## read damaged files of all formats: TIME=600 seconds, or COUNT=500000; SEED
	$(BIN)/python -m fuzz --keep fuzz-found $(if $(SEED),--seed $(SEED)) $(if $(COUNT),--count $(COUNT),--time $(or $(TIME),600))

docs: .venv/dev.stamp           ## pages with an executed gallery in docs/_build/html
	$(BIN)/sphinx-build -b html -n -W --keep-going -q docs docs/_build/html
	@echo "docs/_build/html/index.html"

licences: .venv/dev.stamp       ## list all that is installed with its licence
	$(BIN)/python tools/licences.py

sbom: .venv/dev.stamp           ## list the same as CycloneDX in sbom.json (needs uv)
	uv tool run --from 'cyclonedx-bom>=7,<8' cyclonedx-py environment --pyproject pyproject.toml \
		--mc-type library --output-reproducible --output-file sbom.json $(BIN)/python

# Every file that is installed has its checksum in a lock; only then is the package itself built.
define INSTALL
@echo "making an environment in .venv, installing what $< lists"
@$(PYTHON) -m venv .venv
@$(PIP) --require-hashes -r $<
@echo "compiling the kernels, if there is a compiler"
@$(BIN)/python setup.py -q build_ext --inplace
@$(PIP) --no-deps --no-build-isolation -e .
@touch $@ .venv/demo.stamp
endef

.venv/demo.stamp: requirements.lock $(SOURCES)
	$(INSTALL)

.venv/dev.stamp: requirements-dev.lock requirements.lock $(SOURCES)
	$(INSTALL)

NEEDED_TO_BUILD := 'import tomllib; f = open("pyproject.toml", "rb"); \
	print(*tomllib.load(f)["build-system"]["requires"], sep="\n")'
COMPILE := uv pip compile --quiet --universal --python-version 3.11 --no-emit-index-url \
	--no-header --generate-hashes pyproject.toml -

lock:                           ## renew the locks (needs uv)
	$(PYTHON) -c $(NEEDED_TO_BUILD) | $(COMPILE) --all-extras --output-file requirements-dev.lock
	$(PYTHON) -c $(NEEDED_TO_BUILD) | $(COMPILE) -c requirements-dev.lock --output-file requirements.lock

clean:
	rm -rf .venv demo fuzz-found sbom.json build dist docs/_build docs/auto_gallery src/*.egg-info .mypy_cache .ruff_cache .pytest_cache .hypothesis
