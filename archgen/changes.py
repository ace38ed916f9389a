"""From two sides of a comparison to a document: Markdown for a pull request, a page that stands by itself, a picture."""

from __future__ import annotations

import shlex

from archgen import outputs
from archgen.compare import Comparison
from archgen.emit import tree
from archgen.emit.picture import Picture
from archgen.findings import diff_markdown
from archgen.outputs import Ask
from archgen.sides import WORKING_TREE, Side
from archgen.views.changes.outline import Told, outline
from archgen.views.graphs import changes as pictures

_SHORT = 7


def named(side: Side) -> str:
    """Name a side as it was asked for, with its commit where that says more."""
    known = not side.commit or side.commit.startswith(side.name)
    return side.name if known else f"{side.name} ({side.commit[:_SHORT]})"


def markdown(found: Comparison, old: Side, new: Side) -> str:
    """Write the comment on a pull request."""
    names = diff_markdown.Names(named(old), named(new), _command(old, new))
    return diff_markdown.render(found, names, (old.checked.unsound, new.checked.unsound))


def _command(old: Side, new: Side) -> str:
    """Give the command that compares the same in a terminal."""
    words = [old.commit[:10] if " " in old.name else old.name]
    words += [] if new.name == WORKING_TREE else [new.name]
    return " ".join(["archgen diff", *map(shlex.quote, words)])


def html(found: Comparison, old: Side, new: Side, ask: Ask) -> bytes:
    """Write one page that stands by itself."""
    from archgen.emit.site import alone

    graphs = pictures.pictures(found)
    told = Told(found, named(old), named(new), (old.checked.unsound, new.checked.unsound), graphs)
    return alone.write(outline(told), outputs.draw(graphs, ("svg",), ask) if graphs else {})


def svg(found: Comparison, ask: Ask) -> bytes:
    """Draw what changed among components, among nodes where only they did. Raises OutputError where there is no picture."""
    graphs = pictures.pictures(found)
    if not graphs:
        msg = "nothing changed that a picture could show: no component, no connection and no node"
        raise tree.OutputError(msg, "`--format text` tells what changed")
    drawn: Picture | None = outputs.draw(graphs[:1], ("svg",), ask).get(graphs[0].id)
    if drawn is None or drawn.svg is None:
        msg = "the picture could not be drawn"
        raise tree.OutputError(msg)
    from archgen.emit.site import pictures as files

    return files.alone(drawn.svg, lambda _anchor: None)
