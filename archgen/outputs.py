"""From a checked project to files: which views are made, which emitters draw them, and where they go."""

from __future__ import annotations

import fnmatch
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from archgen import git
from archgen.emit import folder, kept, tree
from archgen.emit.picture import Picture
from archgen.history import history
from archgen.model import selector
from archgen.model.history import History
from archgen.model.selector import Selection
from archgen.model.selector_words import Problem
from archgen.pipeline import Checked
from archgen.project import ProjectNotFoundError
from archgen.revision import revision
from archgen.views import drawings, growth, pages, record, statistics
from archgen.views import report as report_view
from archgen.views.bars import Drawing
from archgen.views.index import Index, Scope, index
from archgen.views.report import Edition, Level
from archgen.views.shapes import Outline, Page
from archgen.views.timed import timing

if TYPE_CHECKING:
    from archgen.emit.graphviz.pool import Worker

_SHORT = 10
"""So many digits of a commit's hash tell it from all others of a repository that holds a robot's architecture."""
Progress = Callable[[int, int], None]
"""Told how many pictures are drawn, of how many."""


@dataclass(frozen=True, slots=True)
class Ask:
    """What the user wants to see: a part, a level, a revision to print. `progress` is told of long work, `warn` of what an
    output could not hold as asked.
    """

    selection: Selection | None = None
    words: str = ""
    level: Level | None = None
    revision: str | None = None
    progress: Progress | None = None
    warn: Callable[[str], None] = lambda _text: None
    history: bool = True
    """Whether documents show how the project grew, as far as git tells."""
    allowed: Collection[str] | None = None
    """The only ones of the project's own backends that may run; None for all."""


def select(checked: Checked, words: str) -> tuple[Selection, tuple[Problem, ...]]:
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


def report(checked: Checked, ask: Ask, target: Path, template: Path | None = None) -> None:
    """Write the Word report."""
    made = make(checked, ask)
    outline = report_view.report(made.view, made.edition)
    tree.write_file(target, docx(checked, outline, draw_all(made, ask, ("png", "svg_outlines")), ask, template))


def site(checked: Checked, ask: Ask, target: Path) -> None:
    """Write the static site."""
    made = make(checked, ask)
    listed = tuple(pages.pages(made.view, made.edition))
    tree.write(site_tree(checked, made, listed, draw_all(made, ask, ("svg",))), target)


def diagrams(checked: Checked, ask: Ask, target: Path, forms: Sequence[str], only: Sequence[str] = ()) -> int:
    """Write pictures, in the formats asked for (svg, png, pdf, dot), and give their number."""
    made = make(checked, ask)
    chosen = {name: graph for name, graph in made.graphs.items() if not only or _matches(name, only)}
    if only and not chosen:
        shown = ", ".join(list(made.graphs)[:8])
        msg = f"no picture is called {' or '.join(only)}"
        raise tree.OutputError(msg, f"there are {shown}, ...")
    pictures = draw(tuple(chosen.values()), tuple(form for form in forms if form != "dot"), ask)
    if chosen and not pictures:
        msg = "no picture could be drawn, nothing was written"
        raise tree.OutputError(msg)
    tree.write(folder.write(pictures, forms), target)
    return len(pictures)


def pack(checked: Checked, target: Path) -> None:
    """Write the packed project."""
    tree.write_file(target, packed(checked).encode())


def resolved(checked: Checked, ask: Ask, target: Path) -> None:
    """Write the resolved model as a record for other programs."""
    from archgen.emit import yaml

    data = record.record(view(checked, ask))
    tree.write_file(target, yaml.write(data).encode())


@dataclass(frozen=True, slots=True)
class Made:
    """The views that documents are written from."""

    view: Index
    edition: Edition
    graphs: Mapping[str, Drawing]


def make(checked: Checked, ask: Ask) -> Made:
    """Make the views."""
    found = replace(view(checked, ask), timed=timing(checked.architecture))
    grown = history_of(checked, ask)
    drawn = drawings.drawings(found, ask.selection, ask.level or "implementation")
    drawn |= {chart.id: chart for chart in growth.charts(grown)}
    edition = Edition(
        revision=revision_of(checked, ask),
        level=ask.level or "implementation",
        chapters=checked.chapters.order,
        texts=checked.chapters.texts,
        graphs=drawn,
        statistics=statistics.statistics(checked.architecture),
        history=grown,
        broken=checked.broken,
    )
    return Made(found, edition, drawn)


def history_of(checked: Checked, ask: Ask) -> History:
    """Give how the project grew month by month; empty where it is not asked for, of a part, or outside of a repository."""
    if not ask.history or ask.selection is not None or checked.loaded.files.commit:
        return History()
    try:
        return history(checked.loaded.files.root / checked.loaded.first, "month", cache=kept.folder(), least=2)
    except (git.GitError, ProjectNotFoundError):
        return History()


def history_stamp(checked: Checked, ask: Ask) -> str:
    """Give a text that changes whenever the history may: cheap beside reading it."""
    if not ask.history or ask.selection is not None or checked.loaded.files.commit:
        return ""
    try:
        found = git.repository(checked.root)
        return f"{git.resolve(found, 'HEAD')} {found.shallow}"
    except git.GitError:
        return ""


def revision_of(checked: Checked, ask: Ask) -> str:
    """Give the revision to print: what was asked for, else the commit that the files were read from, or stand at."""
    if ask.revision is not None:
        return ask.revision
    commit = checked.loaded.files.commit
    return commit[:_SHORT] if commit else revision(checked.root, checked.all_files)


def _matches(name: str, patterns: Sequence[str]) -> bool:
    return any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns)


def draw_all(made: Made, ask: Ask, formats: Sequence[str], ready: Sequence[Worker] = ()) -> Mapping[str, Picture]:
    """Draw all pictures of a project."""
    return draw(tuple(made.graphs.values()), formats, ask, ready)


def draw(
    graphs: Sequence[Drawing], formats: Sequence[str], ask: Ask, ready: Sequence[Worker] = ()
) -> Mapping[str, Picture]:
    """Draw graphs and charts; links in a picture lead to `#` and an element's anchor.

    Where the machine cannot draw, there is a warning and no picture: everything else can still be made.
    """
    from archgen.emit import graphviz

    try:
        pictures = graphviz.draw(
            graphs, formats, link=lambda ref: f"#{ref}", cache=kept.folder(), progress=ask.progress, ready=ready
        )
    except graphviz.MissingGraphviz as missing:
        ask.warn(str(missing))
        return {}
    for picture in pictures.values():
        if picture.warning:
            ask.warn(f"{picture.id}: {picture.warning}")
    return pictures


def docx(checked: Checked, outline: Outline, pictures: Mapping[str, Picture], ask: Ask, template: Path | None) -> bytes:
    """Give the Word report: as kept from before, or written anew."""
    data = template.read_bytes() if template else None

    def write(chapter_files: kept.ChapterFiles) -> kept.Written:
        from archgen.emit import docx

        try:
            return docx.write(outline, pictures, template=data, chapter_files=chapter_files)
        except docx.TemplateError as error:
            raise tree.OutputError(str(error)) from None

    shown = checked.chapters.picture
    document, warnings = kept.report(kept.folder(), outline, pictures, template=data, chapter_files=shown, write=write)
    for warning in warnings:
        ask.warn(warning)
    return document


def site_tree(checked: Checked, made: Made, listed: Sequence[Page], pictures: Mapping[str, Picture]) -> tree.FileTree:
    """Give the site's files."""
    from archgen.emit import site as emitter

    return emitter.write(
        listed,
        pictures,
        title=checked.architecture.project.title,
        revision=made.edition.revision,
        notices=report_view.notices(made.view, made.edition),
        chapter_files=checked.chapters.picture,
    )


def packed(checked: Checked) -> str:
    """Give the packed project as YAML."""
    from archgen.emit import yaml

    packed = checked.packed()
    return yaml.write(packed.data, packed.comments)
