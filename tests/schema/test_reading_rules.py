"""The examples on the pages of the reading rules, and of those that find and merge files, do what they say."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from archgen import project, schema
from archgen.diagnostics.diagnostic import Rule
from archgen.diagnostics.stage_rules import MERGING_RULES, READING_RULES
from archgen.findings.rule_pages import read_rule_page
from archgen.link.slice_merging import merge_documents
from archgen.passes.patterns.pattern_registry import find_wrong_passes
from archgen.pipeline import SHIPPED_RULES

RULES = (*(rule for rule in READING_RULES if rule.name != "invalid-interface"), *MERGING_RULES)


def example(rule: Rule, heading: str) -> dict[str, str]:
    """Give the files of an example: lines `# file: NAME` part them, without any it is archgen.yaml."""
    page = read_rule_page(rule)
    parts = re.split(r"^# file: (\S+)\n", (page.bad if heading == "Bad" else page.good) + "\n", flags=re.MULTILINE)
    if len(parts) == 1:
        return {"archgen.yaml": parts[0]}
    return dict(zip(parts[1::2], parts[2::2], strict=True))


def found(root: Path, files: dict[str, str]) -> set[str]:
    """Read and merge an example, and name the rules that it breaks."""
    for name, text in files.items():
        (root / name).parent.mkdir(exist_ok=True)
        (root / name).write_text(text)
    loaded = project.load_project(root)
    wrong_passes = find_wrong_passes(loaded.files, loaded.sources)
    return {
        d.rule for d in (*loaded.diagnostics, *merge_documents(loaded.documents, loaded.lost_keys)[1], *wrong_passes)
    }


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule.name)
def test_examples(tmp_path: Path, rule: Rule) -> None:
    assert all(read_rule_page(rule))
    for heading, expected in (("Bad", {rule.name}), ("Good", set[str]())):
        root = tmp_path / heading
        root.mkdir()
        assert found(root, example(rule, heading)) == expected


def test_every_rule_that_is_used_has_a_page() -> None:
    package = Path(schema.__file__).parents[1]
    rooms = [*package.glob("syntax/*.py"), *package.glob("schema/*.py"), *package.glob("project/*.py")]
    text = "".join(path.read_text() for path in (*rooms, package / "link" / "slice_merging.py"))
    used = set(re.findall(r'Diagnostic\(\s*"([a-z-]+)"', text)) | set(
        re.findall(r'"(too-large|wrong-type|wrong-value)"', text)
    )
    assert used - {rule.name for rule in SHIPPED_RULES} == set()
    assert "recursive-alias" in used
