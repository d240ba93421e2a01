# jointid: `make help` lists what can be made. Everything goes into .venv, build, dist and demo.
SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DELETE_ON_ERROR:
.DEFAULT_GOAL := help
.NOTPARALLEL:  # each build uses every core by itself

BIN := .venv/bin
PIP := $(BIN)/python -m pip
INSTALL := $(PIP) install --quiet --no-input --disable-pip-version-check
# Python compiles what is imported; most of what the tools bring never is.
TOOLS := $(INSTALL) --no-compile --group
STRICT := -Ccmake.define.JOINTID_WARNINGS_AS_ERRORS=ON -Ccmake.define.JOINTID_PRECOMPILED=$(if $(shell command -v ccache),OFF,ON)

# What the installed package is made of; outside a git checkout (an unpacked sdist) whatever is there.
PARTS := cpp python CMakeLists.txt pyproject.toml README.md LICENSE examples/data
LISTED := $(shell git ls-files --cached --others --exclude-standard -- $(PARTS) 2>/dev/null)
SOURCES := $(wildcard $(or $(LISTED),$(shell find $(PARTS) -type f -not -name '*.so' -not -path '*/__pycache__/*' 2>/dev/null)))

# Warnings are errors in CI and in `make test`, never when a user just wants the demo.
INSTALLED := $(if $(filter true,$(CI)),.venv/.strict,.venv/.installed)

# CI checks the core that it ships: the plain checks come out of the wheel's build, whose objects they link.
SHIPPED_CHECKS := $(if $(filter true,$(CI)),dist/.wheel)
CHECKS_TOO := $(if $(SHIPPED_CHECKS),-Cbuild-dir=$(CURDIR)/build/wheel -Ccmake.define.JOINTID_BUILD_CHECKS=ON)

# After `make develop`, .venv/.editable lists the Python files that are used in place. Then only the compiled part,
# or another list of files, needs an installation, and that one is in place again.
MODULES := $(sort $(filter python/%.py,$(SOURCES)))
IN_PLACE := $(wildcard .venv/.editable)
MOVED := $(if $(IN_PLACE),$(shell echo $(MODULES) | cmp -s - .venv/.editable || echo list-changed))

.PHONY: help demo test tools checks check-plain check-address check-thread pytest pytest-guest pytest-rest vcan browser lint format \
        develop list-changed sdist check-sdist wheels matrix study bench notebooks docs fuzz mutants write-faults soak clean

help:  ## list the targets
	@grep -hE '^[a-z][a-z-]*:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## */\t/' | expand -t 16

demo: $(INSTALLED)  ## identify a real robot joint from its log; writes demo/report.html
	@$(BIN)/jointid demo --output demo
	@echo "Open demo/report.html in a browser."

# DONE names parts that .ci/run has seen to already, beside other work.
test: $(filter-out $(DONE),checks pytest-guest) pytest-rest  ## core checks (plain, ASan+UBSan, TSan), then pytest

checks: .venv/.test-tools $(SHIPPED_CHECKS)
	@mkdir -p build
	@for name in plain address thread; do \
	  echo "Core checks, $$name:"; \
	  tools/core_checks.sh $$name; \
	done

check-plain: $(SHIPPED_CHECKS)

check-plain check-address check-thread: check-%: .venv/.test-tools  ## (each alone)
	@mkdir -p build
	@tools/core_checks.sh $*

pytest: pytest-guest pytest-rest  ## the Python tests alone

# The guest without other tests: its drive has to answer within 200 ms. Then the rest, whose summary closes the output.
pytest-guest: .venv/.strict .venv/.test-tools
	@echo "Python tests on the kernel's own CAN:"
	@$(BIN)/python -m pytest tests/canlab

# One thread of BLAS in each: several wait for each other, and take from the other processes what they wait.
pytest-rest: .venv/.strict .venv/.test-tools
	@echo "Python tests:"
	@OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest --numprocesses auto --dist loadfile --no-loadscope-reorder --ignore tests/canlab

vcan: .venv/.strict .venv/.test-tools  ## install a guest with CAN (root or sudo), then sessions on its vcan, with faults
	@tools/install_vcan.sh
	@JOINTID_REQUIRE_VCAN=1 $(BIN)/python -m pytest tests/canlab

browser: .venv/.strict .venv/.test-tools  ## install Chromium (root or sudo), then look at the pages in it
	@tools/install_browser.sh
	@JOINTID_REQUIRE_BROWSER=1 $(BIN)/python -m pytest tests/report/test_in_browser.py tests/app/test_app_in_browser.py

lint: $(INSTALLED) .venv/.test-tools .venv/.lint-tools  ## ruff, mypy, clang-format, workflow
	@echo "ruff check";         $(BIN)/ruff check
	@echo "ruff format";        $(BIN)/ruff format --check --quiet
	@$(BIN)/python -c 'import shutil, sysconfig; shutil.copy(sysconfig.get_path("platlib") + "/jointid/_core.pyi", "python/jointid")'
	@echo "mypy";               $(BIN)/mypy
	@echo "clang-format";       find cpp benchmarks -name '*.[ch]pp' -print0 | xargs -0 $(BIN)/clang-format --dry-run -Werror
	@echo workflow;             $(BIN)/check-jsonschema --quiet --builtin-schema vendor.github-workflows .github/workflows/ci.yml

format: .venv/.lint-tools  ## format Python and C++ in place
	@$(BIN)/ruff check --fix --quiet || true
	@$(BIN)/ruff format --quiet
	@find cpp benchmarks -name '*.[ch]pp' -print0 | xargs -0 $(BIN)/clang-format -i

define INSTALL_IN_PLACE
@echo "Installing jointid in place, warnings are errors"
@PATH="$$PWD/$(BIN):$$PATH" $(INSTALL) --no-build-isolation -Cbuild-dir=build/editable $(STRICT) -e .
@echo $(MODULES) > .venv/.editable
@touch .venv/.installed .venv/.strict
endef

develop: .venv/.test-tools .venv/.lint-tools  ## editable install for contributors, used until `make clean`
	$(INSTALL_IN_PLACE)

sdist: .venv/.test-tools  ## dist/jointid-VERSION.tar.gz
	@rm -f dist/jointid-*.tar.gz
	@$(BIN)/python -m build -qq --sdist --outdir dist .

# In an environment that holds nothing but what pyproject.toml asks for.
dist/.wheel: .venv/.build-tools $(SOURCES)
	@echo "Building the sdist and a wheel from it, warnings are errors (a minute or two)"
	@rm -rf dist/jointid-* build/wheel
	@$(BIN)/python -m build -qq $(STRICT) $(CHECKS_TOO) --outdir dist .
	@touch $@

check-sdist: dist/.wheel  ## a wheel from the sdist installs, imports and runs in an environment of its own
	@echo "Installing $$(ls dist/jointid-*.whl) into a fresh environment"
	@rm -rf build/sdist-venv
	@$(BIN)/python -m venv build/sdist-venv
	@build/sdist-venv/bin/python -m pip install --quiet --no-input --disable-pip-version-check dist/jointid-*.whl
	@sdist="$$PWD/build/sdist-venv/bin"; cd / && "$$sdist/python" -c 'import jointid' && "$$sdist/jointid" --help >/dev/null
	@echo "The sdist works."

# PYTHONS='python3.12 python3.13' builds for these.
wheels: .venv/.created  ## wheels for Linux in dist/wheels, each tried where no compiler is; by hand
	@tools/wheels.sh $(PYTHONS)

matrix: .venv/.created  ## Debian 13 by chroot, gcc 14, clang 19 and 14, oldest and newest dependencies; by hand, as root, an hour
	@tools/matrix.sh $(MATRIX)

study: $(INSTALLED)  ## accuracy over many seeds; by hand, the results go to docs/
	@$(BIN)/python benchmarks/accuracy_study.py
	@$(BIN)/python benchmarks/coverage_study.py
	@$(BIN)/python benchmarks/presets_study.py
	@$(BIN)/python benchmarks/ring_study.py
	@$(BIN)/python benchmarks/emulated_ring.py --output docs/emulated_ring.md
	@$(BIN)/python benchmarks/conditions_study.py --output docs/conditions.md
	@$(BIN)/python benchmarks/delays_study.py --output docs/delays.md
	@$(BIN)/python benchmarks/causes_study.py --joints 100 --output docs/causes.md
	@$(BIN)/python benchmarks/causes_study.py --joints 30 --seed 7001 --size .1 --output docs/causes.md --append
	@$(BIN)/python benchmarks/robot_study.py --hour --output docs/robot_accuracy.md

bench: $(INSTALLED) .venv/.bench-tools build/oldest/.installed  ## speed against other libraries (20 min); writes docs/performance.md
	@$(BIN)/python benchmarks/speed.py $(BENCH)
	@$(BIN)/python benchmarks/simulation_speed.py --output docs/simulation_speed.md
	@$(BIN)/python benchmarks/latency.py --oldest build/oldest/bin/python --output docs/latency.md
	@OPENBLAS_NUM_THREADS=1 $(BIN)/python benchmarks/projections.py --output docs/projection.md

# Version 0.1.0 as it was when limits in milliseconds were set: they are for a machine on which it takes 7.1 ms.
OLDEST := 6800cc5c31f4fcec87d93d620137ff07dbc62481
build/oldest/.installed: .venv/.created
	@echo "Building version 0.1.0, for limits that are milliseconds"
	@git cat-file -e $(OLDEST) || { echo "make bench: it builds version 0.1.0 from the history, which a shallow clone or an sdist lacks" >&2; exit 1; }
	@rm -rf build/oldest build/oldest-sources
	@mkdir -p build/oldest-sources
	@git archive $(OLDEST) | tar --extract --directory build/oldest-sources
	@$(BIN)/python -m venv build/oldest
	@build/oldest/bin/python -m pip install --quiet --no-input --disable-pip-version-check ./build/oldest-sources
	@touch $@

notebooks: $(INSTALLED) .venv/.test-tools  ## run the notebooks and keep what they show; by hand
	@$(BIN)/python tools/notebooks.py $(NOTEBOOKS)

docs: $(INSTALLED) .venv/.docs-tools  ## the documentation site, build/docs/site; LINKS=1 asks other hosts, too
	@PYTHONPATH=tools $(BIN)/python -m documentation $(if $(LINKS),--links)

# CASES=5000 SEED=0 MINUTES=60 PROCESSES=1 make fuzz: another number, where to begin, and for how long. build/fuzz.jsonl
# has what was done: the next run goes on there.
fuzz: $(INSTALLED) .venv/.test-tools  ## a million damaged files for each reader, core under ASan+UBSan; by hand, hours
	@tools/fuzz.sh build/fuzz.jsonl --cases $(or $(CASES),1000000) --first $(or $(SEED),0) \
	  --minutes $(or $(MINUTES),1000000) --processes $(or $(PROCESSES),$$(getconf _NPROCESSORS_ONLN))

mutants: $(INSTALLED) .venv/.test-tools  ## change single lines, see whether tests notice; by hand, docs/mutants.md
	@PYTHONPATH=tools $(BIN)/python -m mutants --output docs/mutants.md $(MUTANTS)

write-faults: $(INSTALLED) .venv/.test-tools  ## a full disk, a bad one, a power loss at 1,000 calls that write; by hand
	@JOINTID_WRITE_FAULTS=all $(BIN)/python -m pytest -s tests/base/test_write_faults.py

soak: $(INSTALLED)  ## minutes of identification, 30 emulated minutes of sessions; by hand
	@$(BIN)/python benchmarks/soak.py

clean:  ## remove everything made here, .venv too
	@rm -rf .venv build dist demo .pytest_cache .mypy_cache .ruff_cache .hypothesis
	@find . -name __pycache__ -type d -prune -exec rm -rf {} +

tools: .venv/.test-tools .venv/.lint-tools .venv/.docs-tools  # before two of the others run at the same time

.venv/.created:
	@python="$$(tools/find_python.sh)"; \
	  echo "Making .venv with $$($$python --version)"; \
	  $$python -m venv .venv
	@$(INSTALL) --upgrade 'pip>=25.1'  # dependency groups
	@touch $@

.venv/.build-tools: .venv/.created pyproject.toml
	@$(TOOLS) build
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

ifeq ($(IN_PLACE),)
.venv/.installed: .venv/.created $(SOURCES)
	@echo "Building and installing jointid (a minute or two)"
	@$(INSTALL) .
	@touch $@

ifeq ($(CI),true)  # what CI tests is the wheel that comes out of the sdist, so it is built once
.venv/.strict: .venv/.created dist/.wheel
	@$(PIP) uninstall -qq --yes jointid  # the version of a wheel does not tell that it is another
	@$(INSTALL) dist/jointid-*.whl
	@touch .venv/.installed $@
else
.venv/.strict: .venv/.created $(SOURCES)
	@echo "Building and installing jointid, warnings are errors (a minute or two)"
	@$(INSTALL) $(STRICT) .
	@touch .venv/.installed $@
endif
else
.venv/.installed: .venv/.created $(filter-out $(MODULES) README.md LICENSE,$(SOURCES)) $(MOVED)
	$(INSTALL_IN_PLACE)

.venv/.strict: .venv/.installed
	@touch $@
endif
