"""Write matrices: the files of one (classic script, CSV and SVG), and the table that reads without a script."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence

from archgen.emit.safe_names import make_safe_path
from archgen.emit.site.html_text import escape_breakable, escape_html, replace_forbidden
from archgen.emit.site.page_links import CurrentPage
from archgen.emit.terminal.list_formats import format_csv
from archgen.views.inline_text import count_noun
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


_MAX_CELLS = 4_000
"""The cells of a table: with more of them a page would be slow to load, and nobody could read it."""
_MAX_UNFOLDED_ROWS = 30
"""A matrix with groups and more rows is folded at first."""
_STEPS = (8, 4, 2, 1)
"""From how many on a cell is darker."""


def write_matrix(matrix: Matrix, current_page: CurrentPage) -> str:
    """Write a matrix with its summary, its files and what its colours mean. A script makes it one to work with."""
    shown = fold_matrix(matrix) if _is_folded(matrix) else matrix
    cells = count_cells(shown)
    is_readable = len(shown.rows) * len(shown.column_entries) <= _MAX_CELLS
    table = _write_table(shown, cells, current_page) if is_readable else _write_refusal(shown)
    files = "".join(
        f'<a class="button" href="{current_page.root}{matrix_path(matrix, ending)}" download>{ending.upper()}</a> '
        for ending in (("csv", "svg") if is_drawable(matrix) else ("csv",))
    )
    return (
        f'<section class="matrix-view" aria-label="{escape_html(matrix.title)}">\n'
        f'<div class="matrix-tools"><p class="matrix-summary">{escape_html(_describe_matrix(shown, cells))}</p>{files}</div>\n{_write_related(matrix, current_page)}'
        f'<div class="matrix-frame">\n<div class="matrix-box" role="group" tabindex="0" aria-label="{escape_html(matrix.title)}">\n{table}\n</div>\n'
        f"{_write_side(matrix)}\n</div>\n</section>"
        f"{_write_scripts(matrix, current_page) if is_drawable(matrix) else ''}"
    )


def _write_scripts(matrix: Matrix, current_page: CurrentPage) -> str:
    return (
        "\n"
        f'<script src="{current_page.root}{matrix_path(matrix, "js")}" defer></script>\n'
        f'<script src="{current_page.root}assets/matrix.js" defer></script>'
    )


def _write_related(matrix: Matrix, current_page: CurrentPage) -> str:
    links = [
        f'<a href="{href}">{escape_html(title)}</a>'
        for title, ref in matrix.related
        if (href := current_page.href(ref))
    ]
    return f'<p class="matrix-related">Also as a matrix: {" · ".join(links)}</p>\n' if links else ""


def _is_folded(matrix: Matrix) -> bool:
    """Whether a matrix is shown as that of its groups."""
    return matrix.is_square and len(matrix.groups) > 1 and len(matrix.rows) > _MAX_UNFOLDED_ROWS


def _describe_matrix(matrix: Matrix, cells: Mapping[tuple[int, int], Sequence[MatrixFlow]]) -> str:
    """Return what a matrix shows on one line: `rows give, columns take; 126 flows between 10 groups, 18 run back`."""
    between = sum(len(flows) for (row, column), flows in cells.items() if not matrix.is_square or row != column)
    words = f"{matrix.giver_word}; {count_noun(between, matrix.flow_word)}"
    if not matrix.is_square:
        return f"{words} of {count_noun(len(matrix.rows), matrix.row_word)}"
    words = f"{words} between {count_noun(len(matrix.rows), matrix.row_word)}"
    if not matrix.marks_back:
        return words
    back = sum(len(flows) for (row, column), flows in cells.items() if matrix.runs_back(row, column))
    return f"{words}, {back or 'none'} of them {'runs' if back == 1 else 'run'} back"


def _write_table(
    matrix: Matrix, cells: Mapping[tuple[int, int], Sequence[MatrixFlow]], current_page: CurrentPage
) -> str:
    columns = matrix.column_entries
    heads = "".join([f'<th scope="col"><div>{_write_link(entry, current_page)}</div></th>' for entry in columns])
    rows = "\n".join(
        [
            f'<tr><th scope="row">{_write_link(entry, current_page)}{_write_remark(entry)}</th>'
            + "".join([_write_cell(matrix, row, column, cells, current_page) for column in range(len(columns))])
            + "</tr>"
            for row, entry in enumerate(matrix.rows)
        ]
    )
    return (
        f'<table class="matrix{"" if matrix.is_square else " oblong"}"><caption class="spoken">{escape_html(f"{matrix.title}: {matrix.giver_word}")}</caption>\n'
        f"<thead><tr><td></td>{heads}</tr></thead>\n<tbody>\n{rows}\n</tbody></table>"
    )


def _write_link(entry: MatrixEntry, current_page: CurrentPage) -> str:
    href = current_page.href(entry.ref)
    title = escape_breakable(entry.title)
    return f'<a href="{href}">{title}</a>' if href else title


def _write_remark(entry: MatrixEntry) -> str:
    return f' <span class="remark">{escape_html(entry.remark)}</span>' if entry.remark else ""


def _write_cell(
    matrix: Matrix,
    row: int,
    column: int,
    cells: Mapping[tuple[int, int], Sequence[MatrixFlow]],
    current_page: CurrentPage,
) -> str:
    flows = cells.get((row, column), ())
    if matrix.is_square and row == column:
        return f'<td class="self">{f"{len(flows)}<small>inside</small>" if flows else ""}</td>'
    if not flows:
        return "<td></td>"
    step = next(step for step in _STEPS if len(flows) >= step)
    is_back = matrix.runs_back(row, column)
    href = current_page.href(flows[0].ref) if flows[0].ref else None
    text = f"{len(flows)}{'<span class=spoken> runs back</span>' if is_back else ''}"
    return f'<td class="f{step}{" back" if is_back else ""}">{f"""<a href="{href}">{text}</a>""" if href else f"<b>{text}</b>"}</td>'


def _write_refusal(matrix: Matrix) -> str:
    count = count_noun(len(matrix.rows), matrix.row_word)
    return (
        f'<p class="notice note">{count} are too many for a table without a script. The whole is in the CSV above.</p>'
    )


def _write_side(matrix: Matrix) -> str:
    """Write what colours mean, and how the rows are ordered."""
    word = escape_html(matrix.flow_word)
    most = max((len(flows) for flows in count_cells(matrix).values()), default=0) if not matrix.groups else _STEPS[0]
    keys = [
        key
        for key in (("f1", f"1 {word}"), ("f2", "2 to 3"), ("f4", "4 to 7"), ("f8", "8 and more"))
        if int(key[0][1:]) <= most
    ]
    keys += [("back", "runs back (below the diagonal)")] if matrix.is_square and matrix.marks_back else []
    keys += [("self", "inside")] if matrix.groups and matrix.is_square else []
    items = "\n".join([f'<li><span class="key {name}"></span>{text}</li>' for name, text in keys])
    return (
        f'<aside class="matrix-side" aria-label="How to read it"><section class="matrix-keys"><h2>How to read it</h2>\n<ul>\n{items}\n</ul>\n'
        f'<p class="muted">Order of the rows: <span class="matrix-order">{escape_html(matrix.order)}</span>.</p></section></aside>'
    )
