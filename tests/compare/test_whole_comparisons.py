r"""Projects and edits of them, with all that a comparison says: who is who, what changed, why, and whom it breaks.

A case is a project and, below each line `--- old => new` (several edits: ` && `, a new line: `\n`, nothing:
`()`), what is said of it; `--update-golden` writes that (read it).
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from archgen.compare import Change, Comparison
from archgen.compare.change_spans import find_change_span, find_old_file
from archgen.compare.comparison import ChainChange
from archgen.views.changes.boundary_lines import write_boundary_lines
from archgen.views.changes.figure_lines import write_load_lines
from archgen.views.changes.named_elements import name_partners
from tests.compare.conftest import Compared
from tests.timing.printed import show_ms

FOLDER = Path(__file__).parent / "cases"
_MARK = "\n--- "


def _read_blocks(name: str) -> list[str]:
    """Return a case's project, then its edits, each with what is said of it."""
    return (FOLDER / f"{name}.txt").read_text(encoding="utf-8").removesuffix("\n").split(_MARK)


CASES = [
    pytest.param(case.stem, number, id=f"{case.stem}-{number}")
    for case in sorted(FOLDER.glob("*.txt"))
    for number in range(1, len(_read_blocks(case.stem)))
]


@pytest.mark.parametrize(("name", "number"), CASES)
def test_all_that_is_said_of_an_edit(
    name: str, number: int, compared: Compared, request: pytest.FixtureRequest
) -> None:
    blocks = _read_blocks(name)
    project, edits = blocks[0], blocks[number].partition("\n")[0]
    expected = "\n".join([edits, *_list_all(compared(project, _edit(project, edits)))])
    if request.config.getoption("--update-golden"):
        blocks[number] = expected
        (FOLDER / f"{name}.txt").write_text(f"{_MARK.join(blocks)}\n", encoding="utf-8")
    assert expected == blocks[number]


def _edit(project: str, edits: str) -> str:
    for edit in edits.split(" && "):
        old, new = (part.replace("\\n", "\n") for part in edit.split(" => "))
        assert old in project, old
        project = project.replace(old, "" if new == "()" else new)
    return project


def _list_all(comparison: Comparison) -> list[str]:
    names = name_partners(comparison)
    return [
        *(line for change in comparison.changes for line in _write_change(change, comparison, "")),
        *(_write_chain(chain) for chain in comparison.chains),
        *(f"boundary: {line.text}" for line in write_boundary_lines(comparison, names)),
        *(f"load: {line.text}" for line in write_load_lines(comparison, names)),
        *(f"new finding: {finding.rule} {finding.element}" for finding in comparison.new_findings),
        *(f"cured finding: {finding.rule} {finding.element}" for finding in comparison.cured_findings),
        f"concerns: {' '.join(comparison.concerned_owners)}{', refused' if comparison.is_refused else ''}",
    ]


def _write_change(change: Change, comparison: Comparison, indent: str) -> Iterator[str]:
    span = find_change_span(change, comparison)
    place = f"@{span.line}:{span.column}" if span.file else f"@{find_old_file(change, comparison)} before"
    old_id = f" (was {change.old_id})" if change.old_id else ""
    confidence = f" {change.confidence}" if change.confidence != 1 else ""
    yield f"{indent}{change.kind} {change.element_kind} {change.element_id}{old_id}{confidence}: {change.text} {place}"
    for each in change.breaks:
        agreement = f" (agreed: {each.agreement})" if each.agreement else ""
        yield f"{indent}  breaks {each.partner} ({each.category}){agreement}: {each.reason}"
    yield from (f"{indent}  claims: {claim.reason}" for claim in change.claims)
    for part in change.parts:
        yield from _write_change(part, comparison, f"{indent}  ")


def _write_chain(chain: ChainChange) -> str:
    bounds = " -> ".join(
        f"{show_ms(each.bound)} {each.verdict}" if each else "none" for each in (chain.before, chain.after)
    )
    causes = ", ".join(f"{change.element_kind} {change.element_id}" for change in chain.causes)
    return f"chain {chain.id}: {bounds}; because of {causes}; concerns {' '.join(sorted(chain.concerned_partners))}"
