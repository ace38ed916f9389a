"""Likely new names in own code, as edits of files."""

from __future__ import annotations

from pathlib import Path

from archgen.emit.workspace.own_code import CodeFinding
from archgen.emit.workspace.run_record import RunRecord
from archgen.emit.workspace.workspace_plan import FileStep, WorkspacePlan
from archgen.products.own_code_patch import plan_renames
from archgen.products.workspace_product import WorkspaceResult


def rename(column: int) -> CodeFinding:
    return CodeFinding("", 1, column, old_name="publish_a", new_name="publish_b")


def test_each_file_gets_its_names_and_what_is_no_text_stays(tmp_path: Path) -> None:
    code = b"self.node.publish_a(1); self.node.publish_a(2)\nself.publish_a\nread('a.low')\n"
    (tmp_path / "own.py").write_bytes(code)
    (tmp_path / "odd.py").write_bytes(b"\xff publish_a\n")
    findings = (
        rename(1),
        rename(25),
        CodeFinding("", 3, 6, old_name="a.low", new_name="a.least"),
        CodeFinding("", 2, 1),
    )
    steps = (
        FileStep("own.py", "yours", findings=findings),
        FileStep("odd.py", "yours", findings=(rename(1),)),
    )
    record = RunRecord("code")
    (edit,) = plan_renames(WorkspaceResult(tmp_path, WorkspacePlan(steps, {}, {}, (), (), record, record)))
    assert edit.file == "own.py"
    assert edit.new_content == (b"self.node.publish_b(1); self.node.publish_b(2)\nself.publish_a\nread('a.least')\n")
    assert plan_renames(WorkspaceResult(tmp_path, None)) == ()
