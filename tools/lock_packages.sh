#!/bin/sh
# Writes the packages that are installed where it counts, each with its version and the hashes of its files: ci/locked/.
# run.txt is what archgen needs and what builds it, check.txt also what tests and checks it, supply.txt what looks at these two,
# fuzz.txt what finds its way through the readers, docs.txt what makes a site of the manual.
set -eu
cd "$(dirname "$0")/.."
lock=.make/lock
test -x "$lock/bin/uv" || { ${PYTHON:-python3} -m venv "$lock" && "$lock/bin/python" -m pip install --quiet --disable-pip-version-check uv; }
compile() {
    out=$1
    shift
    "$lock/bin/uv" pip compile "$@" --upgrade --universal --python-version 3.11 --generate-hashes --no-header --no-annotate \
        --no-emit-index-url --quiet --output-file "ci/locked/$out"
}
compile run.txt pyproject.toml --group build
compile check.txt pyproject.toml --extra xlsx --extra slides --extra sources --group build --group check
compile supply.txt --group supply
compile fuzz.txt --group fuzz
compile docs.txt --group docs
