"""From two compared versions to a document: Markdown for a pull request, an HTML page, or a picture."""

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
"""Digits of a commit's hash beside a name, as git prints them."""


def named(side: Side) -> str:
    """Name a version as the user typed it, with its commit where that says more."""
    # A hash that begins with what the user typed says nothing new.
    known = not side.commit or side.commit.startswith(side.name)
    return side.name if known else f"{side.name} ({side.commit[:_SHORT]})"


def markdown(found: Comparison, old: Side, new: Side) -> str:
    """Write a comparison as the comment on a pull request."""
    names = diff_markdown.Names(named(old), named(new), _command(old, new))
    return diff_markdown.render(found, names, (old.checked.unsound, new.checked.unsound))


def _command(old: Side, new: Side) -> str:
    """Return the command that shows the same comparison in a terminal."""
    # A name with a blank is a description of ours ("where this branch left main"), no revision that git understands.
    words = [old.commit[:10] if " " in old.name else old.name]
    words += [] if new.name == WORKING_TREE else [new.name]
    return " ".join(["archgen diff", *map(shlex.quote, words)])


def html(found: Comparison, old: Side, new: Side, ask: Ask) -> bytes:
    """Write a comparison as one self-contained HTML page."""
    from archgen.emit.site import alone

    graphs = pictures.pictures(found)
    told = Told(found, named(old), named(new), (old.checked.unsound, new.checked.unsound), graphs)
    return alone.write(outline(told), outputs.draw(graphs, ("svg",), ask) if graphs else {})


def svg(found: Comparison, ask: Ask) -> bytes:
    """Draw what changed among components, or among nodes where no component changed.

    Raise OutputError where there is nothing to draw.
    """
    graphs = pictures.pictures(found)
    if not graphs:
        msg = "nothing changed that a picture could show: no component, no connection and no node"
        raise tree.OutputError(msg, "`--format text` tells what changed")
    # The first graph is the functional one wherever there is one.
    drawn: Picture | None = outputs.draw(graphs[:1], ("svg",), ask).get(graphs[0].id)
    if drawn is None or drawn.svg is None:
        msg = "the picture could not be drawn"
        raise tree.OutputError(msg)
    from archgen.emit.site import pictures as files

    # There is no page to link to: every link of the picture is dropped.
    return files.alone(drawn.svg, lambda _anchor: None)
