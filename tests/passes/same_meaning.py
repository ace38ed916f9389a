"""What must be equal of a project and of what passes made of it where they change only how it is written."""

from __future__ import annotations

from pathlib import Path

from archgen.checking.checked_packing import pack_checked_project
from archgen.pipeline import CheckedProject, check_project, transform_project
from archgen.syntax.yaml_writer import write_yaml
from tests.judged_projects import SAID_BY_PACKING

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def write_project(folder: Path, text: str) -> CheckedProject:
    """Write a project of one file and check it."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    return check_project(folder)


def list_findings(checked: CheckedProject) -> list[tuple[str, str, str]]:
    """Return the findings with their places."""
    return sorted((each.rule, each.message, str(each.span)) for each in checked.findings)


def list_places(checked: CheckedProject) -> set[tuple[str, str]]:
    """Return where which rules find something, but for `UNEQUAL_RULES`."""
    return {(each.rule, str(each.span)) for each in checked.findings if each.rule not in UNEQUAL_RULES}


def pack(checked: CheckedProject) -> str:
    """Return a packed project."""
    packed = pack_checked_project(checked)
    return write_yaml(packed.data, packed.comments)


UNEQUAL_RULES = frozenset({"unused-type", "unread-output", "unfed-input", "disconnected-component"})
"""What is said once for all instances of a type, and not of what follows by itself, but of what is written."""


def transform_alike(checked: CheckedProject, *names: str, finds_same: bool = True) -> CheckedProject:
    """Return what passes make of a project, which means the same, and of which they make the same again.

    `finds_same`: whether the same is found at the same places, else only by the rules that are not `UNEQUAL_RULES`.
    """
    transformed = transform_project(checked, names)
    before, after = checked.architecture, transformed.architecture
    assert after.edges == before.edges
    if finds_same:
        assert list_findings(transformed) == list_findings(checked)
    assert list_places(transformed) == list_places(checked)
    assert after.nodes == before.nodes
    assert after.topics.keys() == before.topics.keys()
    assert repr(transformed.analysis) == repr(checked.analysis)
    assert pack(transform_project(transformed, names)) == pack(transformed)
    return transformed


def check_packed(transformed: CheckedProject, folder: Path) -> CheckedProject:
    """Return what passes made, packed and read again: it is a project of its own that says and packs the same."""
    folder.mkdir(parents=True, exist_ok=True)
    text = pack(transformed)
    file = folder / "packed.yaml"
    file.write_text(text, encoding="utf-8")
    again = check_project(file)
    assert again.architecture.edges == transformed.architecture.edges
    assert sorted((each.rule, each.message) for each in again.findings) == sorted(
        (each.rule, each.message) for each in transformed.findings if each.rule not in SAID_BY_PACKING
    )
    assert pack(again) == text
    return again
