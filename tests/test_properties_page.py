"""The page on properties: each of its examples is a project in which nothing is wrong."""

from __future__ import annotations

import re

import pytest

from archgen.diagnostics.diagnostic import Severity
from archgen.language.language_tables import ANNOTATED_KINDS
from tests.judged_projects import check_text
from tests.running import ROOT

PAGE = (ROOT / "docs" / "properties.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"^```yaml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("example", EXAMPLES)
def test_nothing_is_wrong_in_an_example(example: str) -> None:
    findings = check_text(example)
    assert [f"{d.span.line} {d.rule}: {d.message}" for d in findings if d.effective_severity > Severity.NOTE] == []


def test_the_page_names_every_kind() -> None:
    (kinds,) = re.findall(r"the kinds of elements that have it: `([^`]*)`", PAGE)
    assert sorted(kinds.split()) == sorted(ANNOTATED_KINDS)
