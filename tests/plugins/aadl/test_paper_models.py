"""The models of the paper on AADL and ROS, written by us, become what stands in `expected`."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.diagnostics.diagnostic import Severity
from archgen.plugins.aadl.aadl_import import read_aadl
from archgen.syntax.yaml_writer import write_yaml
from tests.judged_projects import check_text
from tests.plugins.aadl.aadl_texts import MODELS, merge_slices

LIBRARY = ("cnc", "ros", "topic_properties")
CASES = {
    "talking": (*LIBRARY, "chat_msgs", "chatter"),
    "amcl": ("amcl", "topic_properties"),
    "mobility_kit": (*LIBRARY, "mobility_kit"),
}


@pytest.mark.parametrize("name", CASES)
def test_a_model_of_the_paper_is_imported(name: str, pytestconfig: pytest.Config) -> None:
    imported = read_aadl([MODELS / f"{file}.aadl" for file in CASES[name]])
    expected = Path(__file__).with_name("expected") / f"{name}.yaml"
    text = write_yaml(merge_slices(imported))
    if pytestconfig.getoption("--update-golden"):
        expected.write_text(text, encoding="utf-8")
    assert text == expected.read_text(encoding="utf-8")
    assert [note for note in imported.notes if note.fate == "not taken"] == []


@pytest.mark.parametrize("name", CASES)
def test_the_result_is_a_project_without_errors_or_warnings(name: str) -> None:
    imported = read_aadl([MODELS / f"{file}.aadl" for file in CASES[name]])
    findings = check_text("archgen: 1\n" + write_yaml(merge_slices(imported)))
    assert [finding.message for finding in findings if finding.effective_severity > Severity.NOTE] == []


def test_schemas_of_internal_states_are_looked_for_beside_the_file_alone(tmp_path: Path) -> None:
    for name in LIBRARY:
        (tmp_path / f"{name}.aadl").write_bytes((MODELS / f"{name}.aadl").read_bytes())
    text = (MODELS / "chatter.aadl").read_text(encoding="utf-8")
    text = text.replace("talker.schema.json", "../outside.json").replace("listen.schema.json", "none.json")
    (tmp_path.parent / "outside.json").write_text("{}", encoding="utf-8")
    (tmp_path / "chatter.aadl").write_text(text, encoding="utf-8")
    imported = read_aadl(sorted(tmp_path.glob("*.aadl")))
    assert [note.message for note in imported.notes if note.kind == "internal_state"] == [
        "the schema `../outside.json` of the internal state is not beside this file, so nobody looked whether it exists",
        "there is no schema `none.json` of the internal state",
    ]
