"""`make test CHANGED=1` tries what has to do with a change."""

from __future__ import annotations

import pytest

from tests.changed_tests import list_tests_of


@pytest.mark.parametrize(
    ("file", "test"),
    [
        ("archgen/language/key_paths.py", "tests/language/test_key_paths.py"),
        ("archgen/merge/tree_merge.py", "tests/merge/test_slice_merge.py"),
        # Only covered_by.yaml leads from the one to the other.
        ("archgen/analyses/answer_times.py", "tests/test_rule_pages.py"),
        ("tests/schema/test_short_forms.py", "tests/schema/test_short_forms.py"),
        ("language/types.yaml", "tests/language/test_description.py"),
        ("docs/rules/absent-core.md", "tests/test_rule_pages.py"),
        ("docs/media.md", "tests/test_media_page.py"),
        ("CONTRIBUTING.md", "tests/test_contributing.py"),
    ],
)
def test_a_change_leads_to_its_tests(file: str, test: str) -> None:
    tests = list_tests_of([file])
    assert test in tests
    assert len(tests) < 150


def test_without_a_change_there_is_nothing_to_try() -> None:
    assert list_tests_of([]) == []
