"""The table of generators in docs/quality.md holds what is counted today."""

from __future__ import annotations

import re
import runpy

from tests.running import ROOT

TOOL = runpy.run_path(str(ROOT / "tools" / "generator_table.py"))
PAGE = (ROOT / "docs" / "quality.md").read_text(encoding="utf-8")


def test_the_table_is_fresh() -> None:
    assert TOOL["renew_table"](PAGE) == PAGE, "run tools/make_rule_pages.py"


def test_every_generator_has_a_row_with_its_templates() -> None:
    rows = dict(re.findall(r"^\| `(\w+)` \| (\d+) \| [0-9.]+ \| [1-9]\d* \| [0-9.]+ \|", PAGE, re.MULTILINE))
    manifests = [*ROOT.glob("backends/*/backend.yaml"), *ROOT.glob("archgen/plugins/*/backends/*/backend.yaml")]
    generators = [file.parent for file in manifests if "makes: workspace" in file.read_text()]
    assert rows == {
        each.name: str(sum(file.is_file() for file in (each / "templates").rglob("*"))) for each in generators
    }


def test_numbers_that_are_old_are_replaced() -> None:
    old = re.sub(r"(?m)^\| `orca` \| \d+", "| `orca` | 99", PAGE)
    assert old != PAGE
    assert TOOL["renew_table"](old) == PAGE
