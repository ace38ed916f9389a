"""The page about variants: in each of its examples nothing is wrong, in no variant."""

from __future__ import annotations

import re

import pytest

from archgen.diagnostics.diagnostic import Severity
from tests.judged_projects import check_text
from tests.running import ROOT

PAGE = (ROOT / "docs" / "variants.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"^```yaml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


def test_the_page_has_its_examples() -> None:
    assert len(EXAMPLES) == PAGE.count("```yaml") == 2


@pytest.mark.parametrize("number", range(len(EXAMPLES)))
def test_nothing_is_wrong_in_an_example(number: int) -> None:
    findings = check_text(EXAMPLES[number])
    assert [f"{d.span.line} {d.rule}: {d.message}" for d in findings if d.effective_severity > Severity.NOTE] == []
