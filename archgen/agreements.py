"""From a checked project to an interface agreement: between whom, since when, in which format, and where to."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Literal, get_args

from archgen import outputs
from archgen.emit import tree
from archgen.emit.picture import Picture
from archgen.outputs import Ask
from archgen.pipeline import Checked
from archgen.revision import revision
from archgen.sides import Side
from archgen.suggest import did_you_mean
from archgen.views import words
from archgen.views.agreement import Made, agreement, between
from archgen.views.index import Index
from archgen.views.shapes import Graph, Paragraph, Section
from archgen.views.tables import severities
from archgen.views.timed import timing

Format = Literal["docx", "markdown", "html"]
FORMATS: tuple[Format, ...] = get_args(Format)
"""The formats, as the command line names them."""
ENDINGS: Mapping[str, Format] = {
    ".docx": "docx",
    ".md": "markdown",
    ".markdown": "markdown",
    ".html": "html",
    ".htm": "html",
}
"""The format by the ending of a file's name."""
_LISTED = 8
"""At most this many partners are named in a message."""


class PartnersError(ValueError):
    """Two partners cannot have an agreement; the text says why and what can be done."""


def made(checked: Checked, first: str, second: str, since: Side | None = None, printed: str | None = None) -> Made:
    """Make the agreement of two partners.

    Changes since `earlier_version` are marked; `printed_revision` is printed instead of git's last commit. Raise
    PartnersError where there can be no agreement.
    """
    _partners(checked, first, second)
    found = agreement(
        _view(checked),
        first,
        second,
        revision=revision(checked.root, checked.all_files) if printed is None else printed,
        since=(_named(since), _view(since.checked)) if since else None,
        notices=tuple(_notices(checked, since)),
    )
    # Without interfaces there may still be removed ones to agree on.
    if not found.interfaces and not (found.changes and found.changes.removed):
        raise PartnersError(_nothing(checked, first, second))
    return found


def _named(since: Side) -> str:
    """Name an earlier version as the user typed it, with its commit where that says more."""
    # A hash that begins with what the user typed says nothing new.
    known = not since.commit or since.commit.startswith(since.name)
    return since.name if known else f"{since.name} ({since.commit[:7]})"


def _view(checked: Checked) -> Index:
    """Build the look-ups of the whole project, with timing."""
    return replace(outputs.view(checked, Ask()), timed=timing(checked.architecture))


def _partners(checked: Checked, first: str, second: str) -> None:
    """Raise PartnersError unless both ids are declared and different."""
    known = checked.architecture.partners
    if not known:
        msg = "the project has no partners: declare them below `partners`, and name them as `owner` of groups or components"
        raise PartnersError(msg)
    for name in (first, second):
        if name not in known:
            guess = did_you_mean(name, known)
            there = ", ".join(list(known)[:_LISTED]) + (", ..." if len(known) > _LISTED else "")
            msg = f"there is no partner `{name}`; {guess or f'there are {there}'}"
            raise PartnersError(msg)
    if first == second:
        msg = f"an agreement is between two partners, and `{first}` was given twice"
        raise PartnersError(msg)


def _nothing(checked: Checked, first: str, second: str) -> str:
    """Explain that two partners share no interface, and with whom they do."""
    found = checked.architecture
    owners = [each.owners for each in found.components.values()] + [each.owners for each in found.nodes.values()]
    # A partner without elements is the more basic reason, so it is named before neighbours are searched.
    for name in (first, second):
        if not any(name in each for each in owners):
            return f"nothing flows between `{first}` and `{second}`: `{name}` owns no component and no node"
    view, others = outputs.view(checked, Ask()), []
    for name in (first, second):
        near = [other for other in found.partners if other != name and between(view, name, other)]
        others.append(f"`{name}` has interfaces with {', '.join(near) or 'nobody'}")
    return f"nothing flows between `{first}` and `{second}`; {'; '.join(others)}"


def _notices(checked: Checked, since: Side | None) -> Iterator[Paragraph]:
    """Yield a notice for each version that has errors."""
    for name, found in (("", checked), *(((f" at {_named(since)}", since.checked),) if since else ())):
        if found.broken:
            said = f"The architecture{name} has errors ({severities(found.findings)}). What is sound is shown all the same."
            yield Paragraph(words.text(said), "error")


def markdown(found: Made) -> str:
    """Write an agreement as GitHub-flavoured Markdown, with its picture as Mermaid."""
    from archgen.emit import backends, text

    files = (backends.File("outline.md.j2", "agreement.md"),)
    backend = replace(backends.shipped("wiki"), files=files, views=("outline", "graphs", "places"))
    # Markdown has no page for an element; the template may link only to sections of this document.
    places = [section.anchor for section in _sections(found.outline.sections)]
    written, problems = text.write(backend, {"outline": found.outline, "graphs": (found.graph,), "places": places})
    if written is None:
        raise tree.OutputError(problems[0].message, problems[0].help)
    return written.files["agreement.md"].decode()


def _sections(sections: tuple[Section, ...]) -> Iterator[Section]:
    """Yield all sections, each before those below it."""
    for section in sections:
        yield section
        yield from _sections(section.sections)


def html(found: Made, ask: Ask) -> bytes:
    """Write an agreement as one self-contained HTML page."""
    from archgen.emit.site import alone

    return alone.write(found.outline, _drawn(found.graph, ("svg",), ask))


def docx(found: Made, ask: Ask) -> bytes:
    """Write an agreement as a Word document."""
    from archgen.emit import docx as emitter

    pictures = _drawn(found.graph, ("png", "svg_outlines"), ask)
    # An agreement has no chapters, hence no pictures of chapters.
    document, warnings = emitter.write(found.outline, pictures, chapter_files=lambda _path: None)
    for warning in warnings:
        ask.warn(warning)
    return document


def _drawn(graph: Graph, formats: tuple[str, ...], ask: Ask) -> Mapping[str, Picture]:
    return outputs.draw((graph,), formats, ask)


def write(found: Made, form: Format, target: Path, ask: Ask | None = None) -> None:
    """Write an agreement into a file."""
    ask = ask or Ask()
    if form == "markdown":
        tree.write_file(target, markdown(found).encode())
    else:
        tree.write_file(target, html(found, ask) if form == "html" else docx(found, ask))
