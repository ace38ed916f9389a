#!/bin/sh
# Tests what archgen reads and writes with the lowest versions that pyproject.toml allows, in an environment of its own.
set -eu
cd "$(dirname "$0")/.."
lock=.make/lock
test -x "$lock/bin/uv" || { ${PYTHON:-python3} -m venv "$lock" && "$lock/bin/python" -m pip install --quiet --disable-pip-version-check uv; }
lowest=.make/lowest
test -x "$lowest/bin/python" || ${PYTHON:-python3} -m venv "$lowest"
"$lock/bin/uv" pip compile pyproject.toml --resolution lowest-direct --quiet --no-header --no-annotate --output-file .make/lowest.txt
"$lowest/bin/python" -m pip install --quiet --disable-pip-version-check -r .make/lowest.txt
# What the tests themselves need: as it comes, but for what archgen needs.
"$lowest/bin/python" -m pip install --quiet --disable-pip-version-check --upgrade "pip>=25.1"
"$lowest/bin/python" -m pip install --quiet --disable-pip-version-check --constraint .make/lowest.txt --group test
PYTHONPATH=$PWD "$lowest/bin/python" -m pytest -n "$(getconf _NPROCESSORS_ONLN)" ${TESTS:-tests/test_golden.py tests/syntax tests/edit tests/emit tests/schema tests/cli}
