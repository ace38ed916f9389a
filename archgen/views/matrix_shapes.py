"""The plain shape of a matrix: who gives whom what, with rows and columns that may be folded into groups."""

from __future__ import annotations

from archgen.frozen import dataclass
from archgen.grouping import group_pairs


@dataclass(frozen=True, slots=True)
class MatrixEntry:
    """A row or a column: its title, the page that it leads to, a remark (its owner) and its group, by index."""

    title: str
    ref: str
    remark: str = ""
    group: int | None = None


@dataclass(frozen=True, slots=True)
class MatrixFlow:
    """One thing that stands in a cell, by the indexes of row and column, with the page that it leads to."""

    row: int
    column: int
    title: str
    ref: str = ""


@dataclass(frozen=True, slots=True)
class Matrix:
    """A matrix. `columns` is empty where rows are columns too: then cells below the diagonal run back.

    `groups` fold rows (of a square matrix also columns; else columns only). `row_word` and the others name what is
    counted: `component`, `group`, `flow`. `order` says how rows are ordered.
    """

    id: str
    title: str
    rows: tuple[MatrixEntry, ...]
    flows: tuple[MatrixFlow, ...]
    columns: tuple[MatrixEntry, ...] = ()
    groups: tuple[MatrixEntry, ...] = ()
    row_word: str = "component"
    group_word: str = "group"
    flow_word: str = "flow"
    giver_word: str = "rows give, columns take"
    order: str = ""
    marks_back: bool = True
    """Whether what stands below the diagonal of a square matrix is shown as running back."""
    related: tuple[tuple[str, str], ...] = ()
    """Titles and anchors of the other matrices."""

    @property
    def is_square(self) -> bool:
        """Whether the columns are the rows."""
        return not self.columns

    def runs_back(self, row: int, column: int) -> bool:
        """Whether what stands in a cell runs back: against the order of the rows."""
        return self.is_square and self.marks_back and row > column

    @property
    def column_entries(self) -> tuple[MatrixEntry, ...]:
        """Return the entries of the columns."""
        return self.columns or self.rows


def fold_matrix(matrix: Matrix) -> Matrix:
    """Return a square matrix with a row for each group; entries without a group stay rows of their own."""
    places: dict[int, int] = {}
    folded_rows: list[MatrixEntry] = []
    places_by_group: dict[int, int] = {}
    for index, entry in enumerate(matrix.rows):
        if entry.group is None:
            places[index] = len(folded_rows)
            folded_rows.append(entry)
            continue
        if entry.group not in places_by_group:
            places_by_group[entry.group] = len(folded_rows)
            folded_rows.append(matrix.groups[entry.group])
        places[index] = places_by_group[entry.group]
    flows = tuple(MatrixFlow(places[flow.row], places[flow.column], flow.title, flow.ref) for flow in matrix.flows)
    return Matrix(
        matrix.id,
        matrix.title,
        tuple(folded_rows),
        flows,
        row_word=matrix.group_word,
        flow_word=matrix.flow_word,
        giver_word=matrix.giver_word,
        order=matrix.order,
        marks_back=matrix.marks_back,
    )


def count_cells(matrix: Matrix) -> dict[tuple[int, int], list[MatrixFlow]]:
    """Return what stands in each cell that is not empty, by row and column."""
    return group_pairs(((flow.row, flow.column), flow) for flow in matrix.flows)
