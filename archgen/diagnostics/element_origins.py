"""Where elements that a pass made come from: which passes made them, and from what in the user's files."""

from __future__ import annotations

from archgen.diagnostics.source_span import Span
from archgen.frozen import NamedTuple

TreePath = tuple[str | int, ...]
"""The keys, and positions in lists, that lead to a value of a project."""


class Origin(NamedTuple):
    """What one value of a transformed project was made from."""

    passes: tuple[str, ...]
    """The passes that made or changed it, in the order in which they ran; empty for what is as it was written."""
    at: Span
    """Where what it was made from is written."""
    path: TreePath
    """Where that stood in the project before any pass."""
    is_moved: bool = False
    """Whether it is the same, at another place: what is inside of it was inside of that."""
