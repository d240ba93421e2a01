# jointid: `make help` lists what can be made. Everything goes into .venv, build, dist and demo.
SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DELETE_ON_ERROR:
.DEFAULT_GOAL := help
.NOTPARALLEL:  # each build uses every core by itself

BIN := .venv/bin
INSTALL := $(BIN)/python -m pip install --quiet --no-input --disable-pip-version-check
# Python compiles what is imported; most of what the tools bring never is.
TOOLS := $(INSTALL) --no-compile --group
# One thread of BLAS in each process: several wait for each other, and take from the other processes what they wait.
# Hundreds of processes import the same modules: each is compiled once, also where the environment keeps no bytecode.
BYTECODE := PYTHONDONTWRITEBYTECODE= PYTHONPYCACHEPREFIX=$(CURDIR)/build/bytecode
PYTEST := $(BYTECODE) OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest --numprocesses auto --dist loadfile

# What the installed package is made of, and a wheel in dist that is newer than all of it (or WHEEL=path): it is installed
# instead of compiled. An editable install (`make develop`) is renewed each time, which takes seconds.
FILES := find cpp python examples/data CMakeLists.txt pyproject.toml README.md LICENSE tools/stub.py \
  -type f -not -name '*.so' -not -name _core.pyi -not -path '*/__pycache__/*'
EDITABLE := $(wildcard .venv/.editable)
BUILT := $(if $(EDITABLE),,$(shell ls -t dist/jointid-*.whl dist/wheels/jointid-*.whl 2>/dev/null | head -n 1))
WHEEL := $(if $(BUILT),$(if $(shell $(FILES) -newer $(BUILT)),,$(BUILT)))
SOURCES := $(if $(EDITABLE),always,$(shell $(FILES)))

.PHONY: always help demo wheel test test-all night slow checks-address checks-thread vcan browser lint format develop \
        check-sdist wheels cross matrix study bench notebooks docs fuzz mutants write-faults soak clean

help:  ## list the targets
	@grep -hE '^[a-z][a-z-]*:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## */\t/' | expand -t 16

demo: $(if $(findstring command,$(origin WHEEL)),wheel,.venv/.installed)  ## identify a real robot joint from its log; writes demo/report.html. WHEEL=path: without a compiler
	@$(BIN)/jointid demo --output demo
	@echo "Open demo/report.html in a browser."

wheel: .venv/.created
	@tools/install.sh $(WHEEL) only

test: .venv/.tested .venv/.test-tools  ## one build; plain core checks and all tests that are not marked slow
	@echo "Core checks:"
	@build/package/core_check
	@echo "Python tests:"
	@$(PYTEST) -m "not slow"

# The guests without other tests: their drive has to answer within 200 ms.
test-all: test checks-address vcan slow docs check-sdist  ## slow tests, guests, browser, ASan and UBSan, site, sdist too (root or sudo)

night: test-all checks-thread write-faults notebooks soak mutants  ## by hand: everything else, but for the matrix; hours
	@$(MAKE) fuzz CASES=$(or $(CASES),20000)

slow: .venv/.installed .venv/.test-tools
	@tools/install_browser.sh
	@JOINTID_REQUIRE_BROWSER=1 $(PYTEST) -m slow --ignore tests/canlab

checks-address checks-thread: checks-%: .venv/.created build/tools/.made
	@echo "Core checks under sanitizers: $*"
	@tools/core_checks.sh $*

vcan: .venv/.installed .venv/.test-tools  ## install a guest with CAN (root or sudo), then sessions on its vcan, with faults
	@tools/install_vcan.sh
	@JOINTID_REQUIRE_VCAN=1 $(BIN)/python -m pytest tests/canlab

browser: .venv/.installed .venv/.test-tools  ## install Chromium (root or sudo), then look at the pages in it
	@tools/install_browser.sh
	@JOINTID_REQUIRE_BROWSER=1 $(BIN)/python -m pytest tests/report/test_in_browser.py tests/app/test_app_in_browser.py

lint: .venv/.installed .venv/.lint-tools  ## ruff, mypy, clang-format, workflow
	@echo "ruff check";         $(BIN)/ruff check
	@echo "ruff format";        $(BIN)/ruff format --check --quiet
	@echo "mypy";               $(BIN)/mypy
	@echo "clang-format";       find cpp benchmarks -name '*.[ch]pp' -print0 | xargs -0 $(BIN)/clang-format --dry-run -Werror
	@echo workflow;             $(BIN)/check-jsonschema --quiet --builtin-schema vendor.github-workflows .github/workflows/ci.yml

format: .venv/.lint-tools  ## format Python and C++ in place
	@$(BIN)/ruff check --fix --quiet || true
	@$(BIN)/ruff format --quiet
	@find cpp benchmarks -name '*.[ch]pp' -print0 | xargs -0 $(BIN)/clang-format -i

develop: .venv/.lint-tools  ## editable install for contributors, used until `make clean`
	@touch .venv/.editable
	@tools/install.sh checks
	@touch .venv/.installed .venv/.tested

# In an environment that holds nothing but what pyproject.toml asks for.
check-sdist: .venv/.created build/tools/.made  ## a wheel from the sdist, both in dist, installs and runs in an environment of its own
	@echo "Building the sdist and a wheel from it"
	@rm -rf dist/jointid-* build/sdist-venv
	@PYTHONPATH=build/tools $(BIN)/python -m build -qq --outdir dist .
	@$(BIN)/python -m venv build/sdist-venv
	@build/sdist-venv/bin/python -m pip install --quiet --no-input --disable-pip-version-check dist/jointid-*.whl
	@sdist="$$PWD/build/sdist-venv/bin"; cd / && "$$sdist/python" -c 'import jointid' && "$$sdist/jointid" --help >/dev/null
	@echo "The sdist works."

# PYTHONS='python3.12 python3.13' builds for these.
wheels: .venv/.created  ## wheels for Linux in dist/wheels, each tried where no compiler is; by hand
	@tools/wheels.sh $(PYTHONS)

cross: .venv/.created build/tools/.made  ## every file of the core compiles for Windows and macOS; by hand, 10 minutes of CPU
	@tools/cross.sh

matrix: .venv/.created  ## Debian 13 by chroot, gcc 14, clang 19 and 14, oldest and newest dependencies; by hand, as root, an hour
	@tools/matrix.sh $(MATRIX)

study: .venv/.installed .venv/.bench-tools  ## accuracy over many seeds; by hand, docs/contributors/measured.md
	@$(BIN)/python benchmarks/accuracy_study.py
	@$(BIN)/python benchmarks/coverage_study.py
	@$(BIN)/python benchmarks/presets_study.py
	@$(BIN)/python benchmarks/ring_study.py --write
	@$(BIN)/python benchmarks/emulated_ring.py --write
	@$(BIN)/python benchmarks/conditions_study.py --write
	@$(BIN)/python benchmarks/faulty_logs.py --logs 200 --seed 2026 --write
	@$(BIN)/python benchmarks/delays_study.py --write
	@$(BIN)/python benchmarks/causes_study.py --joints 100 --write
	@$(BIN)/python benchmarks/causes_study.py --joints 30 --seed 7001 --size .1 --write
	@$(BIN)/python benchmarks/robot_study.py --hour --write
	@$(BIN)/python benchmarks/robot_faults.py --write

bench: .venv/.installed .venv/.bench-tools  ## speed against other libraries (20 min); writes docs/contributors/measured.md
	@$(BIN)/python benchmarks/speed.py $(BENCH)
	@$(BIN)/python benchmarks/simulation_speed.py --write
	@$(BIN)/python benchmarks/latency.py --write
	@OPENBLAS_NUM_THREADS=1 $(BIN)/python benchmarks/projections.py --write

notebooks: .venv/.installed .venv/.test-tools  ## run the notebooks and keep what they show; by hand
	@$(BIN)/python tools/notebooks.py $(NOTEBOOKS)

docs: .venv/.installed .venv/.docs-tools  ## the documentation site, build/docs/site; LINKS=1 asks other hosts, too
	@PYTHONPATH=tools $(BIN)/python -m documentation $(if $(LINKS),--links)

# CASES=5000 SEED=0 MINUTES=60 PROCESSES=1 make fuzz: another number, where to begin, and for how long. build/fuzz.jsonl
# has what was done: the next run goes on there.
fuzz: .venv/.installed .venv/.test-tools build/tools/.made  ## a million damaged files for each reader, core under ASan+UBSan; by hand, hours
	@tools/fuzz.sh build/fuzz.jsonl --cases $(or $(CASES),1000000) --first $(or $(SEED),0) \
	  --minutes $(or $(MINUTES),1000000) --processes $(or $(PROCESSES),$$(getconf _NPROCESSORS_ONLN))

mutants: .venv/.installed .venv/.test-tools build/tools/.made  ## change single lines, see whether tests notice; by hand, docs/contributors/measured.md
	@PATH="$$PWD/build/tools/bin:$$PATH" PYTHONPATH="tools:$$PWD/build/tools" $(BIN)/python -m mutants --write $(MUTANTS)

write-faults: .venv/.installed .venv/.test-tools  ## a full disk, a bad one, a power loss at 1,000 calls that write; by hand
	@JOINTID_WRITE_FAULTS=all $(BIN)/python -m pytest -s tests/base/test_write_faults.py

soak: .venv/.installed  ## minutes of identification, 30 emulated minutes of sessions; by hand
	@$(BIN)/python benchmarks/soak.py

clean:  ## remove everything made here, .venv too
	@rm -rf .venv build dist demo python/jointid/_core.pyi .pytest_cache .mypy_cache .ruff_cache .hypothesis
	@find . -name __pycache__ -type d -prune -exec rm -rf {} +

.venv/.created:
	@python="$$(tools/find_python.sh)"; \
	  echo "Making .venv with $$($$python --version)"; \
	  $$python -m venv .venv
	@$(INSTALL) --upgrade 'pip>=25.1'  # dependency groups
	@touch $@

# What builds lies apart from .venv, at one place: an isolated build's would be at another each time, and all objects old.
build/tools/.made: pyproject.toml | .venv/.created
	@echo "Installing what compiles"
	@rm -rf build/tools
	@$(TOOLS) build --target build/tools
	@touch $@

.venv/.test-tools: .venv/.created pyproject.toml
	@echo "Installing what the tests need"
	@$(TOOLS) test
	@touch $@

.venv/.lint-tools: .venv/.created pyproject.toml
	@echo "Installing ruff, mypy and clang-format"
	@$(TOOLS) lint
	@touch $@

.venv/.docs-tools: .venv/.created pyproject.toml
	@echo "Installing Sphinx, its theme and its reader of Markdown"
	@$(TOOLS) docs
	@touch $@

.venv/.bench-tools: .venv/.created pyproject.toml
	@echo "Installing the libraries that the benchmark times"
	@$(TOOLS) bench
	@touch $@

.venv/.installed: .venv/.created $(SOURCES)
	@tools/install.sh $(WHEEL)
	@touch $@

.venv/.tested: .venv/.created $(SOURCES)
	@tools/install.sh checks
	@touch .venv/.installed $@
