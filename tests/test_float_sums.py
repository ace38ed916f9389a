"""No float `sum` reaches an output: from Python 3.12 on it is compensated, so that the last digit differs from 3.11's."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
FILES = sorted(file for room in ("emit", "views", "plugins") for file in (ROOT / "archgen" / room).rglob("*.py"))
WHOLE_NUMBERS = frozenset(
    {
        ("archgen/emit/docx/table_pieces.py", "sum(widths)"),
        ("archgen/emit/picture_files.py", "sum(words)"),
        ("archgen/emit/pptx/slide_drawing.py", "sum(bytes.fromhex(digits))"),
        (
            "archgen/plugins/recordings/bag_messages.py",
            "sum((each.stat().st_size for each in list_regular_files(path)))",
        ),
        ("archgen/views/timing/timing_tables.py", "sum(times.values())"),
        ("archgen/emit/graphviz/box_styles.py", "sum((width + gap for width, _ in cells))"),
        ("archgen/views/search/entry_ranking.py", "sum(ranks)"),
        ("archgen/views/graphs/group_columns.py", "sum([place[each] for each in near])"),
        ("archgen/views/sequences/lane_sheets.py", "sum((abs(places[one] - places[other]) for one, other in ways))"),
        ("archgen/plugins/ros/sources/walk_values.py", "sum(map(measure_value, self.parts))"),
    }
)
"""Sums of integers (twips, characters, places, bytes) and fractions that do not look like it."""
COUNTS = (ast.Compare, ast.BoolOp, ast.Constant, ast.UnaryOp)


def _may_be_float(call: ast.Call) -> bool:
    """Whether a sum may be of floats: not that of a generator of truth values, lengths or counts."""
    argument = call.args[0]
    element = argument.elt if isinstance(argument, ast.GeneratorExp | ast.ListComp) else argument
    if isinstance(element, COUNTS):
        return False
    text = ast.unparse(element)
    return not any(
        word in text
        for word in ("len", "count", "Fraction", "is_file()", "endswith", "_segments_cross", "flows_within.values()")
    )


def _list_float_sums(file: Path) -> Iterator[str]:
    """Yield the sums of a file that may be of floats, each with its line; one without any is not parsed."""
    text, name = file.read_text(encoding="utf-8"), file.relative_to(ROOT).as_posix()
    for node in ast.walk(ast.parse(text)) if "sum(" in text else ():
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "sum":
            written = ast.unparse(node)
            if _may_be_float(node) and (name, written) not in WHOLE_NUMBERS:
                yield f"{name}:{node.lineno}: use math.fsum: {written}"


def test_floats_are_summed_exactly() -> None:
    assert [line for file in FILES for line in _list_float_sums(file)] == []
