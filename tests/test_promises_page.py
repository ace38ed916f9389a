"""The page on promises: its examples are projects in which nothing is wrong, and every rule that it names is there."""

from __future__ import annotations

import re

import pytest

from archgen.diagnostics.diagnostic import Severity
from archgen.pipeline import SHIPPED_RULES
from tests.judged_projects import check_text
from tests.running import ROOT

PAGE = (ROOT / "docs" / "promises.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"^```yaml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("example", EXAMPLES)
def test_nothing_is_wrong_in_an_example(example: str) -> None:
    found = [f"{d.rule}: {d.message}" for d in check_text(example) if d.effective_severity > Severity.NOTE]
    assert found == []


def test_every_rule_of_the_page_is_one() -> None:
    names = re.findall(r"\(rules/([a-z-]+)\.md\)", PAGE)
    assert len(names) > 5
    assert set(names) <= {rule.name for rule in SHIPPED_RULES}
