"""tools/count_uml_constructs.py counts what became of each construct."""

from __future__ import annotations

import runpy
from pathlib import Path

import pytest

from tests.plugins.xmi.uml_models import write_model
from tests.running import ROOT

TOOL = runpy.run_path(str(ROOT / "tools" / "count_uml_constructs.py"))
MODEL = write_model(
    """\
<packagedElement xmi:type="uml:Component" xmi:id="c" name="c"><xmi:Extension extender="tool"/></packagedElement>
<packagedElement xmi:type="uml:Class" xmi:id="k" name="k"/>
<packagedElement xmi:type="uml:Activity" xmi:id="a" name="a"><node xmi:type="uml:JoinNode" xmi:id="n"/></packagedElement>"""
)


def test_constructs_are_counted_by_what_became_of_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "lab.xmi").write_text(MODEL, encoding="utf-8")
    (tmp_path / "none.xmi").write_text("<x/>", encoding="utf-8")
    assert TOOL["main"]([str(tmp_path / "none.xmi"), str(tmp_path / "lab.xmi")]) == 0
    printed = capsys.readouterr()
    assert printed.err.startswith(f"refused: {tmp_path / 'none.xmi'}:1:1: there is no UML model in it")
    assert printed.out.splitlines() == [
        f"A: {tmp_path / 'lab.xmi'}",
        "| construct | A |",
        "|---|---|",
        "| `Class` | 1 · 0 · 0 |",
        "| `Component` | 0 · 1 · 0 |",
        "| `Model` | 1 · 0 · 0 |",
        "| `Activity` | 0 · 0 · 1 |",
        "| `Extension` of the tool | 0 · 0 · 1 |",
        "| **all** | 2 · 1 · 2 |",
    ]
