# What people type: demo, test, check, bench. Everything is set up in .venv; system packages come from apt-get where
# the user may install them, and are named where not.
PYTHON ?= python3
BIN := .venv/bin
TESTS ?= tests
# A process of tests more than cores, since some wait for others; to collect the tests costs each of them as much as hundreds of tests.
WORKERS ?= $(shell expr $$(getconf _NPROCESSORS_ONLN) + 1)

.PHONY: demo test test-all properties check lint format bench mutants fuzz golden covered size language pages lock audit sbom docs vscode dist release test-lowest clean
.DEFAULT_GOAL := help

.PHONY: help
help:
	@echo "make demo      set up, and make report, site, diagrams and packed file of example_ramcip"
	@echo "make check     ruff, mypy, lint-imports and the tests of make test"
	@echo "make test      set up, and run the tests that are quick and need nothing but Python and its packages"
	@echo "make test CHANGED=1  only the tests of what differs from main, and of what is not committed"
	@echo "make covered   write tests/covered_by.yaml anew, by what the tests execute"
	@echo "make size      count the package's lines by what they are for"
	@echo "make test-all  all tests: also those that take longer, and those that need browsers, an office, compilers, judges or ROS"
	@echo "make properties  the property tests again, on new random draws each time, and the samples that make test-all leaves out"
	@echo "make mutants   change one condition at a time, and see which changes no test notices"
	@echo "make fuzz      feed changed fixtures to all readers and verbs, guided by coverage: SECONDS=600 SEED=1 TARGETS="
	@echo "make bench     measure speed and scale"
	@echo "make golden    renew the expected outputs of example_ramcip"
	@echo "make language  renew what follows from the description of the language in language/"
	@echo "make lock      renew the versions and hashes in ci/locked, of all packages that CI and the actions install"
	@echo "make audit     look up known holes in these packages; make sbom lists them with their licences"
	@echo "make docs      make a site of the manual, with each link held: archgen-out/manual/index.html"
	@echo "make vscode    check and pack the extension for Visual Studio Code: archgen-out/archgen.vsix"
	@echo "make release VERSION=1.2.3  write the version; docs/releasing.md goes on"
	@echo "make dist      build the wheel and the sdist of the last commit, the same bytes everywhere"
	@echo "make test-lowest  the tests of what is written, with the lowest versions of packages that are allowed"
	@echo "make pages     renew what is generated: rule pages, interface data, the page of the ROS library"

demo: .make/run
	$(BIN)/archgen build example_ramcip -o archgen-out/example_ramcip
	@echo
	@echo "Open archgen-out/example_ramcip/site/index.html and archgen-out/example_ramcip/report.docx"

# With CHANGED=1 only the tests of what differs from main, and of what is not committed.
test: .make/test
ifdef CHANGED
	$(BIN)/python -m tests.changed_tests > .make/changed-tests
	test ! -s .make/changed-tests || $(BIN)/python -m pytest -n $(WORKERS) --dist worksteal $$(cat .make/changed-tests)
	@echo "That were $$(wc -l < .make/changed-tests) files of tests of what was changed; make test runs all."
else
	$(BIN)/python -m pytest -n $(WORKERS) --dist worksteal $(TESTS)
endif

# The rest comes after, not among them: what builds or takes long would push others over their time limits. `-rs` says what was
# not tried here, such as a Python that is not installed.
test-all: .make/test-all test .make/ros
	$(BIN)/python -m pytest -m "slow or build or browser or office or compilers or judges or ros" -rs -n $(WORKERS) --dist worksteal $(TESTS)

covered: .make/test
	-$(BIN)/python -m pytest -q tests/test_modules_are_tested.py -k has_a_test --update-covered

# Lines by what they are for; docs/quality.md holds the table as it was last printed.
size:
	$(PYTHON) tools/capability_sizes.py

properties: .make/test-all
	ARCHGEN_DRAW_ANEW=1 $(BIN)/python -m pytest -m hypothesis -n $(WORKERS) --dist worksteal $(TESTS)

check: lint test

lint: .make/check
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports

format: .make/check
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

bench: .make/test
	$(BIN)/python benchmarks/run.py
	$(BIN)/python benchmarks/timing.py
	$(BIN)/python benchmarks/simulation.py

mutants: .make/test
	$(BIN)/python tools/run_mutants.py --seed $(or $(SEED),1) --count $(or $(COUNT),200)

# What breaks lies in .make/fuzzed/found: mended, and kept in tests/fuzz/kept. What was learnt of the readers is gone on from.
fuzz: .make/fuzz
	.make/fuzz-tools/bin/python -m tests.fuzz.run_fuzz --seconds $(or $(SECONDS),600) --seed $(or $(SEED),1) --work .make/fuzzed $(TARGETS)

golden: .make/test
	$(BIN)/python -m pytest tests/test_golden.py --update-golden

# From the description in language/: the schema of files and the tables of archgen/language/.
language: .make/run
	$(BIN)/python tools/make_language.py

pages: .make/test
	$(BIN)/python tools/make_rule_pages.py
	$(BIN)/python tools/make_ros_interfaces.py
	$(BIN)/python tools/make_ros_library_page.py
	$(BIN)/python tools/make_plugin_page.py

lock:
	mkdir -p .make
	PYTHON=$(PYTHON) sh tools/lock_packages.sh

# What is known of holes in what is locked, by the database of the Python Packaging Authority.
audit: .make/supply
	.make/supply-tools/bin/pip-audit --strict --disable-pip --require-hashes -r ci/locked/run.txt
	.make/supply-tools/bin/pip-audit --strict --disable-pip --require-hashes -r ci/locked/check.txt

# What archgen comes with: each package, its version, its licence, as CycloneDX.
sbom: .make/supply
	rm -rf .make/sbom && $(PYTHON) -m venv --without-pip .make/sbom
	.make/supply-tools/bin/python -m pip --python .make/sbom/bin/python install --quiet --require-hashes -r ci/locked/run.txt
	mkdir -p archgen-out
	.make/supply-tools/bin/cyclonedx-py environment --output-reproducible --pyproject pyproject.toml -o archgen-out/sbom.json .make/sbom/bin/python

docs: .make/docs
	NO_MKDOCS_2_WARNING=1 .make/docs-tools/bin/mkdocs build --strict --quiet
	@echo "Open archgen-out/manual/index.html"

# The extension: its types, its tests against a stand-in of the editor, and the packed file.
vscode:
	npm install --prefix editors/vscode --no-package-lock --no-audit --no-fund --loglevel=error
	cd editors/vscode && npm run --silent bundle && npm run --silent check && npm run --silent package
	mkdir -p archgen-out && mv editors/vscode/archgen.vsix archgen-out/

# The wheel and the sdist of the last commit: whoever builds it again, anywhere, gets the same bytes.
dist: .make/test
	rm -rf dist .make/dist && mkdir -p .make/dist
	git archive HEAD | tar -x -C .make/dist
	SOURCE_DATE_EPOCH=$$(git log -1 --format=%ct) $(BIN)/python -m build --no-isolation --outdir dist .make/dist
	rm -rf .make/dist

# The version into the package and CHANGELOG.md; docs/releasing.md says what comes next.
release:
	python3 tools/cut_release.py $(VERSION)

# Tests with the lowest versions that pyproject.toml allows.
test-lowest: .make/test
	sh tools/test_lowest_versions.sh

clean:
	rm -rf .venv .make archgen-out dist tests/judges/node_modules

# With LOCKED=1 the versions are those of ci/locked, each file known by its hash, as in our own CI.
ifdef LOCKED
PACKAGES := --require-hashes --requirement ci/locked/check.txt
TEST_PACKAGES := $(PACKAGES)
CHECK_PACKAGES := $(PACKAGES)
else
TEST_PACKAGES := --group test
CHECK_PACKAGES := --group check
endif

# What archgen needs to run: a virtual environment, and the system libraries that draw pictures.
.make/run: pyproject.toml tools/system_packages.sh
	sh tools/system_packages.sh run
	test -x $(BIN)/python || $(PYTHON) -m venv .venv
ifdef LOCKED
	$(BIN)/python -m pip install --quiet --disable-pip-version-check $(PACKAGES)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --no-index --editable .
else
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable .
endif
	mkdir -p .make && touch $@

# What `make test` needs beside: packages of Python, for which nobody must be root.
.make/test: .make/run
ifndef LOCKED
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --upgrade "pip>=25.1"
endif
	$(BIN)/python -m pip install --quiet --disable-pip-version-check $(TEST_PACKAGES)
	touch $@

# The tools of the check, which are packages of Python, too.
.make/check: .make/test
	$(BIN)/python -m pip install --quiet --disable-pip-version-check $(CHECK_PACKAGES)
	touch $@

# The fuzzer, with what the tests need whose fixtures it changes: its counters of coverage are in the way elsewhere.
.make/fuzz: pyproject.toml tools/system_packages.sh
	sh tools/system_packages.sh run
	mkdir -p .make && $(PYTHON) -m venv .make/fuzz-tools
ifdef LOCKED
	.make/fuzz-tools/bin/python -m pip install --quiet --disable-pip-version-check $(PACKAGES)
	.make/fuzz-tools/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes --requirement ci/locked/fuzz.txt
	.make/fuzz-tools/bin/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --no-index --editable .
else
	.make/fuzz-tools/bin/python -m pip install --quiet --disable-pip-version-check --upgrade "pip>=25.1"
	.make/fuzz-tools/bin/python -m pip install --quiet --disable-pip-version-check --editable . --group test --group fuzz
endif
	touch $@

.make/supply: ci/locked/supply.txt
	mkdir -p .make && $(PYTHON) -m venv .make/supply-tools
	.make/supply-tools/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes --requirement ci/locked/supply.txt
	touch $@

.make/docs: ci/locked/docs.txt
	mkdir -p .make && $(PYTHON) -m venv .make/docs-tools
	.make/docs-tools/bin/python -m pip install --quiet --disable-pip-version-check --require-hashes --requirement ci/locked/docs.txt
	touch $@

# What the other tests need: browsers, an office, compilers and the judges.
.make/test-all: .make/check .make/fuzz tests/judges/package.json tools/system_packages.sh
	sh tools/system_packages.sh test-all
	npm install --prefix tests/judges --no-package-lock --no-audit --no-fund --loglevel=error
	touch $@

# ROS 1, for the tests that run generated nodes on it.
.make/ros: .make/run tools/system_packages.sh
	sh tools/system_packages.sh ros
	touch $@
