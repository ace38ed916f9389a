"""Write matrices as tables that read without a script: the matrix itself where it is small, else that of its groups."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.emit.site.html_text import escape_breakable, escape_html
from archgen.emit.site.matrix_files import is_drawable, list_file_endings, matrix_path
from archgen.emit.site.page_links import CurrentPage
from archgen.views.inline_text import count_noun
from archgen.views.matrix_shapes import Matrix, MatrixEntry, MatrixFlow, count_cells, fold_matrix

MAX_CELLS = 4_000
"""The cells of a table: with more of them a page would be slow to load, and nobody could read it."""
MAX_UNFOLDED_ROWS = 30
"""A matrix with groups and more rows is folded at first."""
_STEPS = (8, 4, 2, 1)
"""From how many on a cell is darker."""


def write_matrix(matrix: Matrix, current_page: CurrentPage) -> str:
    """Write a matrix with its summary, its files and what its colours mean. A script makes it one to work with."""
    shown = fold_matrix(matrix) if _is_folded(matrix) else matrix
    cells = count_cells(shown)
    is_readable = len(shown.rows) * len(shown.column_entries) <= MAX_CELLS
    table = _write_table(shown, cells, current_page) if is_readable else _write_refusal(shown)
    files = "".join(
        f'<a class="button" href="{current_page.root}{matrix_path(matrix, ending)}" download>{ending.upper()}</a> '
        for ending in list_file_endings(matrix)
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
    return matrix.is_square and len(matrix.groups) > 1 and len(matrix.rows) > MAX_UNFOLDED_ROWS


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
