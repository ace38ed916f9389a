"""Any table becomes a project without errors; what `archgen list` writes comes back as it was."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st

from archgen.cli import main as verbs
from archgen.pipeline import CheckedProject, check_project
from archgen.plugins.tables import table_import
from archgen.start import project_plan, start_answers
from tests.judged_projects import judge_ramcip
from tests.property_sizes import count_examples
from tests.running import RAMCIP, ROOT, archgen_here

FIRST = ROOT / "examples" / "first_robot"


def read(data: bytes) -> table_import.TableImport:
    return table_import.import_tables([("t.csv", data)], "jazzy")


def made(imported: table_import.TableImport) -> CheckedProject:
    """Check the files that the data become."""
    given = start_answers.add_partners(start_answers.collect_answers("r"), imported.data.get("partners", {}))
    return project_plan.judge_files(project_plan.imported_files(given, imported.data), "r")


NAMES = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=12) | st.sampled_from(
    [
        "A",
        "a",
        "A b",
        "a_b",
        "B.c",
        "=1",
        "true",
        "3D",
        "{x}",
        "&a",
        "# no",
        "- x",
        "none",
        "機械",
        "a: b",
        "sensor_msgs/Image",
    ]
)
HEADS = st.sampled_from(
    [
        "Group",
        "Component",
        "Title",
        "Description",
        "Owner",
        "Inputs",
        "Outputs",
        "From",
        "To",
        "Type",
        "Message",
        "Node",
        "Topic",
        "Rate",
        "Requirement",
        "Role",
        "Kind",
        "Else",
    ]
)


@settings(max_examples=count_examples(150), deadline=None)
@given(
    st.lists(HEADS, min_size=2, max_size=7), st.lists(st.lists(NAMES, max_size=7), max_size=6), st.sampled_from(",;\t")
)
def test_whatever_stands_in_a_table_checks_without_an_error(heads: list[str], rows: list[list[str]], mark: str) -> None:
    quoted = ["".join(f'"{cell.replace(chr(34), chr(34) * 2)}"{mark}' for cell in row) for row in [heads, *rows]]
    found = read("\n".join(quoted).encode("utf-8", "replace"))
    if found.data:
        assert [f"{d.rule} {d.message}" for d in made(found).findings if d.severity == "error"] == []
    else:
        assert found.diagnostics


@settings(max_examples=count_examples(100), deadline=None)
@given(st.binary(max_size=200))
def test_no_bytes_are_too_strange(data: bytes) -> None:
    read(b"Group,Component,Inputs\n" + data)


@pytest.mark.slow
def test_what_archgen_list_writes_comes_back() -> None:
    told: list[tuple[str, bytes]] = []
    for sort in ("components", "groups", "edges", "nodes", "types", "requirements"):
        listed = CliRunner().invoke(verbs, ["list", "--of", sort, "--format", "csv", "-C", str(RAMCIP)])
        assert listed.exit_code == 0, listed.output
        told.append((f"{sort}.csv", listed.stdout_bytes))
    found = table_import.import_tables(told, "jazzy")
    assert found.diagnostics == ()
    before, after = judge_ramcip().architecture, made(found).architecture
    assert {(e.output, e.input) for e in after.edges} == {(e.output, e.input) for e in before.edges}
    assert {c.id: (c.title, c.owner, c.role) for c in after.components.values()} == {
        c.id: (c.title, c.owner, c.role) for c in before.components.values()
    }
    assert {n.id: (n.implements, n.package, n.status) for n in after.nodes.values() if n.written} == {
        n.id: (n.implements, n.package, n.status) for n in before.nodes.values() if n.written and n.implements
    }
    assert {name: r.title for name, r in after.requirements.items()} == {
        name: r.title for name, r in before.requirements.items()
    }
    used = {output.type for output in before.outputs.values()}
    assert {output.type for output in after.outputs.values()} <= used


def test_connections_as_listed_come_back(tmp_path: Path) -> None:
    table = archgen_here("list", "--of", "connections", "--format", "csv", "-C", FIRST, cwd=tmp_path).stdout
    before, after = (
        check_project(FIRST).architecture,
        made(table_import.import_tables([("c.csv", table)], "jazzy")).architecture,
    )
    assert {(c.input, c.target) for c in after.connections} == {(c.input, c.target) for c in before.connections}
