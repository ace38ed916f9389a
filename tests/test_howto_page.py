"""The page of worked examples: each of them is a project in which nothing is wrong."""

from __future__ import annotations

import re

import pytest

from archgen.diagnostics.diagnostic import Severity
from tests.judged_projects import check_text
from tests.running import ROOT

PAGE = (ROOT / "docs" / "howto.md").read_text(encoding="utf-8")
SECTIONS = re.findall(r"^## ([^\n]*)\n(.*?)(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL)
EXAMPLES = {
    heading: block
    for heading, text in SECTIONS
    for block in re.findall(r"^```yaml\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
}
"""The example of each section by its heading."""


def test_every_section_has_an_example() -> None:
    assert list(EXAMPLES) == [heading for heading, _ in SECTIONS]
    assert len(EXAMPLES) == PAGE.count("```yaml")


@pytest.mark.parametrize("heading", EXAMPLES)
def test_nothing_is_wrong_in_an_example(heading: str) -> None:
    findings = check_text(EXAMPLES[heading])
    assert [f"{d.span.line} {d.rule}: {d.message}" for d in findings if d.effective_severity > Severity.NOTE] == []
