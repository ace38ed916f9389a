"""Every rule has a case that shows its finding, with its place, labels and help; and what reading a project finds."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.conformance.conformance_rules import RULE_NAMES
from archgen.diagnostics.diagnostic import Rule
from archgen.pipeline import SHIPPED_RULES
from tests.rule_cases import RuleCase, case_ids, read_cases, renew_case

TESTS = Path(__file__).parent
CASES = tuple(read_cases(TESTS / "cases"))


@pytest.mark.parametrize("case", CASES, ids=case_ids(CASES))
def test_findings_stand_where_the_case_says(case: RuleCase, tmp_path: Path, pytestconfig: pytest.Config) -> None:
    annotated = case.annotate(tmp_path)
    if pytestconfig.getoption("--update-golden"):
        renew_case(case, annotated)
    else:
        assert annotated == case.text


@pytest.fixture(scope="module")
def expected_rules() -> frozenset[str]:
    """Return the rules that some case expects a finding of."""
    folders = [TESTS / "cases", *sorted(TESTS.glob("*/cases"))]
    return frozenset(rule for folder in folders for case in read_cases(folder) for rule in case.expected_rules)


RULES_OF_REPOSITORIES = frozenset({"expired-use", "missed-milestone", "stale-codeowners"})
"""Rules that need a repository, which a case has not: tests/project/test_commit_days.py, tests/checking/test_codeowners_age.py."""


@pytest.mark.parametrize(
    "rule",
    # Those of a robot are in tests/conformance: a case has none.
    [rule for rule in SHIPPED_RULES if rule.name not in RULES_OF_REPOSITORIES | RULE_NAMES],
    ids=lambda rule: rule.name,
)
def test_every_rule_has_a_case(rule: Rule, expected_rules: frozenset[str]) -> None:
    assert rule.name in expected_rules, "write one in cases/*.txt beside the tests of the rule's room"
