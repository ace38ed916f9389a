"""What writing out types finds: message, columns, labels and help, as cases/*.txt say at the lines that they are about."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rule_cases import RuleCase, case_ids, read_cases, renew_case

CASES = tuple(read_cases(Path(__file__).parent / "cases"))


@pytest.mark.parametrize("case", CASES, ids=case_ids(CASES))
def test_findings_stand_where_the_case_says(case: RuleCase, tmp_path: Path, pytestconfig: pytest.Config) -> None:
    annotated = case.annotate(tmp_path)
    if pytestconfig.getoption("--update-golden"):
        renew_case(case, annotated)
    else:
        assert annotated == case.text
