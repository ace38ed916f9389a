"""From a checked project to files: which views are made, which emitters draw them, and where they go."""

from __future__ import annotations

import fnmatch
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from archgen import link, views
from archgen.diagnostic import Severity
from archgen.emit import tree
from archgen.emit.picture import Picture
from archgen.model import selector
from archgen.model.selector import Selection
from archgen.pipeline import Checked
from archgen.revision import revision
from archgen.views.index import Index, Scope, index
from archgen.views.report import Edition, Level
from archgen.views.shapes import Graph

Progress = Callable[[str, int, int], None]
"""Told what is being done, how many are done, of how many."""


class OutputError(Exception):
    """An output could not be written, for a reason that the user can mend; the message says which."""


@dataclass(frozen=True, slots=True)
class Ask:
    """What the user wants to see: a part, a level, a revision to print. `progress` is told of long work."""

    selection: Selection | None = None
    words: str = ""
    level: Level = "implementation"
    revision: str | None = None
    progress: Progress | None = None


def select(checked: Checked, words: str) -> tuple[Selection, tuple[selector.Problem, ...]]:
    """Evaluate a selector against a project; `finding:` sees its findings."""
    return selector.select(words, checked.architecture, _found(checked))


def _found(checked: Checked) -> Mapping[str, frozenset[str]]:
    found: dict[str, set[str]] = {}
    for finding in checked.findings:
        if finding.element:
            found.setdefault(finding.rule, set()).add(finding.element)
    return {rule: frozenset(elements) for rule, elements in found.items()}


def view(checked: Checked, ask: Ask) -> Index:
    """Make the look-ups for what the user wants to see."""
    scope = Scope(ask.selection.components, ask.selection.nodes, ask.words) if ask.selection else Scope()
    return index(checked.architecture, checked.findings, scope)
