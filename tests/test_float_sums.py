"""No float `sum` reaches an output: from Python 3.12 on it is compensated, so that the last digit differs from 3.11's."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
FILES = sorted([*(ROOT / "archgen/emit").rglob("*.py"), *(ROOT / "archgen/views").rglob("*.py")])
WHOLE_NUMBERS = frozenset({("archgen/emit/docx/table_rows.py", "sum(widths)")})
"""Sums of integers (twips) that do not look like it."""
COUNTS = (ast.Compare, ast.BoolOp, ast.Constant, ast.UnaryOp)


def _may_be_float(call: ast.Call) -> bool:
    """Whether a sum may be of floats: not that of a generator of truth values, lengths or counts."""
    argument = call.args[0]
    element = argument.elt if isinstance(argument, ast.GeneratorExp | ast.ListComp) else argument
    if isinstance(element, COUNTS):
        return False
    text = ast.unparse(element)
    return not any(word in text for word in ("len", "count", "Fraction", "_segments_cross", "flows_within.values()"))


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.relative_to(ROOT).as_posix())
def test_floats_are_summed_exactly(file: Path) -> None:
    calls = (node for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))) if isinstance(node, ast.Call))
    sums = [call for call in calls if isinstance(call.func, ast.Name) and call.func.id == "sum" and _may_be_float(call)]
    name = file.relative_to(ROOT).as_posix()
    sums = [call for call in sums if (name, ast.unparse(call)) not in WHOLE_NUMBERS]
    assert [f"line {call.lineno}: use math.fsum: {ast.unparse(call)}" for call in sums] == []
