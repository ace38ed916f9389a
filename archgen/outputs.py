"""From a checked project to files: which views are made, which emitter writes them, and where to."""

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
"""Digits of a commit's hash that are printed: enough to be unique in a repository of this size."""
Progress = Callable[[int, int], None]
"""Called with the number of pictures drawn so far, and of all pictures."""


@dataclass(frozen=True, slots=True)
class Ask:
    """What to show and how to print it: a selection, a level of detail, a revision.

    `selector_text` is the selector as the user wrote it. `progress` is called during long work, `warn` for what an
    output could not contain as asked for.
    """

    selection: Selection | None = None
    words: str = ""
    level: Level | None = None
    revision: str | None = None
    progress: Progress | None = None
    warn: Callable[[str], None] = lambda _text: None
    history: bool = True
    """Whether documents show how the project grew; only possible where git can tell."""
    allowed: Collection[str] | None = None
    """The only backends of the project itself that may run; None allows all of them."""


def select(checked: Checked, words: str) -> tuple[Selection, tuple[Problem, ...]]:
    """Evaluate a selector against a project; `finding:` refers to the project's findings.

    Return the selection and the problems of the selector; errors among them make the selection unusable.
    """
    return selector.select(words, checked.architecture, _found(checked))


def _found(checked: Checked) -> Mapping[str, frozenset[str]]:
    """Return the ids of elements with findings, by rule."""
    found: dict[str, set[str]] = {}
    for finding in checked.findings:
        if finding.element:
            found.setdefault(finding.rule, set()).add(finding.element)
    return {rule: frozenset(elements) for rule, elements in found.items()}


def view(checked: Checked, ask: Ask) -> Index:
    """Build the look-ups for the selected part of a project."""
    scope = Scope(ask.selection.components, ask.selection.nodes, ask.words) if ask.selection else Scope()
    return index(checked.architecture, checked.findings, scope)


def report(checked: Checked, ask: Ask, target: Path, template: Path | None = None) -> None:
    """Write the Word report. Raise OSError, or OutputError for what the user can mend."""
    made = make(checked, ask)
    # A PNG for programs that know no SVG; an SVG with text as outlines, since the reader's Word may lack the font.
    outline = report_view.report(made.view, made.edition)
    tree.write_file(target, docx(checked, outline, draw_all(made, ask, ("png", "svg_outlines")), ask, template))


def site(checked: Checked, ask: Ask, target: Path) -> None:
    """Write the static site into a folder."""
    made = make(checked, ask)
    listed = tuple(pages.pages(made.view, made.edition))
    tree.write(site_tree(checked, made, listed, draw_all(made, ask, ("svg",))), target)


def diagrams(checked: Checked, ask: Ask, target: Path, forms: Sequence[str], only: Sequence[str] = ()) -> int:
    """Write pictures in the given formats (svg, png, pdf, dot) and return how many there are.

    `name_patterns` select pictures by id. Raise OutputError where none matches, or where no picture can be drawn.
    """
    made = make(checked, ask)
    chosen = {name: graph for name, graph in made.graphs.items() if not only or _matches(name, only)}
    if only and not chosen:
        shown = ", ".join(list(made.graphs)[:8])
        msg = f"no picture is called {' or '.join(only)}"
        raise tree.OutputError(msg, f"there are {shown}, ...")
    # `dot` is not drawn: it is the source, which every picture carries.
    pictures = draw(tuple(chosen.values()), tuple(form for form in forms if form != "dot"), ask)
    # `draw_or_warn` only warns without the drawing libraries; here the pictures are all that was asked for.
    if chosen and not pictures:
        msg = "no picture could be drawn, nothing was written"
        raise tree.OutputError(msg)
    tree.write(folder.write(pictures, forms), target)
    return len(pictures)


def pack(checked: Checked, target: Path) -> None:
    """Write the packed project."""
    tree.write_file(target, packed(checked).encode())


def resolved(checked: Checked, ask: Ask, target: Path) -> None:
    """Write the resolved model as YAML for other programs."""
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
    """Make the views: look-ups with timing, drawings, history, and what the documents contain."""
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
    """Return how the project grew, month by month.

    Empty where it is not wanted, for a part of the project, for a project read from a commit, and outside of a
    repository.
    """
    if not ask.history or ask.selection is not None or checked.loaded.files.commit:
        return History()
    try:
        # `least` 2: one month makes no chart, so it is not even counted.
        return history(checked.loaded.files.root / checked.loaded.first, "month", cache=kept.folder(), least=2)
    except (git.GitError, ProjectNotFoundError):
        return History()


def history_stamp(checked: Checked, ask: Ask) -> str:
    """Return a text that changes whenever the history may change; much cheaper than reading the history.

    The conditions must be those of `read_history`.
    """
    if not ask.history or ask.selection is not None or checked.loaded.files.commit:
        return ""
    try:
        found = git.repository(checked.root)
        # Completing a shallow clone lengthens the history without moving HEAD.
        return f"{git.resolve(found, 'HEAD')} {found.shallow}"
    except git.GitError:
        return ""


def revision_of(checked: Checked, ask: Ask) -> str:
    """Return the revision to print: the one asked for, else the commit that the files belong to."""
    if ask.revision is not None:
        return ask.revision
    commit = checked.loaded.files.commit
    return commit[:_SHORT] if commit else revision(checked.root, checked.all_files)


def _matches(name: str, patterns: Sequence[str]) -> bool:
    """Whether a name matches any of the patterns, with case as it is."""
    return any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns)


def draw_all(made: Made, ask: Ask, formats: Sequence[str], ready: Sequence[Worker] = ()) -> Mapping[str, Picture]:
    """Draw all pictures of a project, on idle `workers` where there are some."""
    return draw(tuple(made.graphs.values()), formats, ask, ready)


def draw(
    graphs: Sequence[Drawing], formats: Sequence[str], ask: Ask, ready: Sequence[Worker] = ()
) -> Mapping[str, Picture]:
    """Draw graphs and charts; links in a picture lead to `#` and an element's anchor.

    Where the machine lacks the drawing libraries, warn and return nothing: everything else can still be written.
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
    """Return the Word report as bytes: from the cache, or written anew."""
    data = template.read_bytes() if template else None

    # Called on a miss only. The cache hands in a reader that records which chapter pictures the writer asks for.
    def write(chapter_files: kept.ChapterFiles) -> kept.Written:
        """Write the report, with a broken template as the user's mistake."""
        from archgen.emit import docx

        try:
            return docx.write(outline, pictures, template=data, chapter_files=chapter_files)
        except docx.TemplateError as error:
            raise tree.OutputError(str(error)) from None

    shown = checked.chapters.picture
    document, warnings = kept.report(kept.folder(), outline, pictures, template=data, chapter_files=shown, write=write)
    # Warnings are cached with the report: a report from the cache must warn as the first one did.
    for warning in warnings:
        ask.warn(warning)
    return document


def site_tree(checked: Checked, made: Made, listed: Sequence[Page], pictures: Mapping[str, Picture]) -> tree.FileTree:
    """Return the files of the site."""
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
    """Return the packed project as YAML."""
    from archgen.emit import yaml

    packed = checked.packed()
    return yaml.write(packed.data, packed.comments)
