"""Write the files of a matrix: its data as a classic script, which works from the disk, and the whole as CSV and as SVG."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence

from archgen.emit.safe_names import make_safe_path
from archgen.emit.site.html_text import escape_html, replace_forbidden
from archgen.emit.site.page_links import CurrentPage
from archgen.emit.terminal.list_formats import format_csv
from archgen.views.matrix_shapes import Matrix, MatrixEntry, MatrixFlow, count_cells, fold_matrix

MAX_DRAWN_ROWS = 150
"""The rows that a script or a picture still draws, groups folded: of so many squared a page is made within a second."""
MAX_DRAWN_CELLS = 40_000
_MAX_CSV_ROWS = 300
"""Above, a CSV lists the filled cells: nearly all others are empty, and their commas alone would be megabytes."""
_CELL = 22
"""The length of a cell in a picture, in px."""
_LABEL_WIDTH = 7
"""What a letter of a label takes at most, in px."""
_MAX_LABEL = 40
_FILLS = {1: ("#eaf2fa", "#1b2127"), 2: ("#c6dcef", "#1b2127"), 4: ("#2171b5", "#ffffff"), 8: ("#08519c", "#ffffff")}
_BACK_FILL, _SELF_FILL = ("#fdf3e0", "#8a5300"), ("#e1e5e9", "#1b2127")


def matrix_path(matrix: Matrix, ending: str) -> str:
    """Return the path of a matrix's file in the site."""
    return make_safe_path(f"matrix/{matrix.id}.{ending}")


def is_drawable(matrix: Matrix) -> bool:
    """Whether a matrix is small enough, with its groups folded, for a script that works it."""
    shown = fold_matrix(matrix) if matrix.is_square and matrix.groups else matrix
    return len(shown.rows) <= MAX_DRAWN_ROWS and len(shown.rows) * len(shown.column_entries) <= MAX_DRAWN_CELLS


def list_file_endings(matrix: Matrix) -> tuple[str, ...]:
    """Return the endings of the files to download: the picture only where it can be drawn."""
    return ("csv", "svg") if is_drawable(matrix) else ("csv",)


def build_matrix_files(matrix: Matrix, current_page: CurrentPage) -> Iterator[tuple[str, bytes]]:
    """Yield the matrix as CSV and, where it can be drawn, as SVG and as the data for the page's script."""
    yield matrix_path(matrix, "csv"), _write_csv(matrix)
    if is_drawable(matrix):
        yield matrix_path(matrix, "js"), _write_data(matrix, current_page)
        is_small = len(matrix.rows) <= MAX_DRAWN_ROWS or not matrix.is_square
        yield matrix_path(matrix, "svg"), _write_svg(matrix if is_small else fold_matrix(matrix))


def _write_data(matrix: Matrix, current_page: CurrentPage) -> bytes:
    # What flows is told once: many cells have the same type.
    titles: dict[tuple[str, str], int] = {}
    flows = []
    for flow in matrix.flows:
        key = replace_forbidden(flow.title), current_page.href(flow.ref) or "" if flow.ref else ""
        flows.append([flow.row, flow.column, titles.setdefault(key, len(titles))])
    data = {
        "rows": _list_entries(matrix.rows, current_page),
        "columns": _list_entries(matrix.columns, current_page),
        "groups": _list_entries(matrix.groups, current_page),
        "titles": [list(key) for key in titles],
        "flows": flows,
        "words": [matrix.row_word, matrix.group_word, matrix.flow_word, matrix.giver_word],
        "order": matrix.order,
        "back": matrix.is_square and matrix.marks_back,
    }
    text = json.dumps(data, ensure_ascii=False, separators=(",", ":"))
    return f"const archgenMatrix = {text};\n".encode()


def _list_entries(entries: Sequence[MatrixEntry], current_page: CurrentPage) -> list[list[object]]:
    return [
        [
            replace_forbidden(entry.title),
            current_page.href(entry.ref) or "",
            replace_forbidden(entry.remark),
            -1 if entry.group is None else entry.group,
        ]
        for entry in entries
    ]


def _write_csv(matrix: Matrix) -> bytes:
    """Write the counts, those of one row on a line; of a large matrix each filled cell on a line."""
    cells = count_cells(matrix)
    columns = matrix.column_entries
    if len(matrix.rows) > _MAX_CSV_ROWS:
        lines = [
            [matrix.rows[row].title, columns[column].title, str(len(flows))]
            for (row, column), flows in sorted(cells.items())
        ]
        return format_csv(["row", "column", f"{matrix.flow_word}s"], lines).encode()
    rows = [
        [entry.title, *(str(len(cells.get((row, column), ())) or "") for column in range(len(columns)))]
        for row, entry in enumerate(matrix.rows)
    ]
    # The heads as a row: they are titles, too, which a spreadsheet must not take for formulas.
    return format_csv([matrix.giver_word], [["", *(entry.title for entry in columns)], *rows]).encode()


def _write_svg(matrix: Matrix) -> bytes:
    columns = matrix.column_entries
    left = _label_length(matrix.rows)
    top = _label_length(columns)
    width, height = left + _CELL * len(columns) + 8, top + _CELL * len(matrix.rows) + 8
    size = f'width="{width}" height="{height}"'
    face = 'font-family="Inter, DejaVu Sans, sans-serif" font-size="11"'
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="0 0 {width} {height}" {face}>',
        f"<title>{escape_html(f'{matrix.title}: {matrix.giver_word}')}</title>",
        f'<rect {size} fill="#ffffff"/>',
    ]
    for row, entry in enumerate(matrix.rows):
        y = top + row * _CELL
        parts.append(f'<text x="{left - 8}" y="{y + 15}" text-anchor="end" fill="#1b2127">{_cut_label(entry)}</text>')
        parts.append(f'<path d="M{left} {y}H{width - 8}" stroke="#e1e5e9"/>')
    for column, entry in enumerate(columns):
        x = left + column * _CELL
        parts.append(
            f'<text transform="translate({x + 15} {top - 8}) rotate(-90)" fill="#1b2127">{_cut_label(entry)}</text>'
        )
        parts.append(f'<path d="M{x} {top}V{height - 8}" stroke="#e1e5e9"/>')
    parts += _draw_cells(matrix, count_cells(matrix), left, top)
    parts.append("</svg>\n")
    return "\n".join(parts).encode()


def _draw_cells(
    matrix: Matrix, cells: Mapping[tuple[int, int], Sequence[MatrixFlow]], left: int, top: int
) -> Iterator[str]:
    if matrix.is_square:
        for place in range(len(matrix.rows)):
            x, y = left + place * _CELL, top + place * _CELL
            yield f'<rect x="{x + 1}" y="{y + 1}" width="{_CELL - 2}" height="{_CELL - 2}" rx="3" fill="{_SELF_FILL[0]}"/>'
    for (row, column), flows in sorted(cells.items()):
        if matrix.is_square and row == column:
            continue
        is_back = matrix.runs_back(row, column)
        step = next(step for step in (8, 4, 2, 1) if len(flows) >= step)
        fill, ink = _BACK_FILL if is_back else _FILLS[step]
        dashes = f' stroke="{ink}" stroke-dasharray="3 2"' if is_back else ""
        x, y = left + column * _CELL, top + row * _CELL
        yield f'<rect x="{x + 1}" y="{y + 1}" width="{_CELL - 2}" height="{_CELL - 2}" rx="3" fill="{fill}"{dashes}/>'
        yield f'<text x="{x + _CELL / 2:g}" y="{y + 15}" text-anchor="middle" fill="{ink}">{len(flows)}</text>'


def _label_length(entries: Sequence[MatrixEntry]) -> int:
    longest = max((min(len(entry.title), _MAX_LABEL) for entry in entries), default=0)
    return 16 + longest * _LABEL_WIDTH


def _cut_label(entry: MatrixEntry) -> str:
    title = entry.title if len(entry.title) <= _MAX_LABEL else f"{entry.title[: _MAX_LABEL - 1]}…"
    return escape_html(title)
