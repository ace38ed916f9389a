"""From a checked project to files: which views are made, which emitters draw them, and where they go."""

from __future__ import annotations

import fnmatch
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

from archgen.diagnostic import Diagnostic
from archgen.emit import folder, kept, stamp, tree
from archgen.emit.backends import Backend
from archgen.emit.picture import Picture
from archgen.model import selector
from archgen.model.selector import Selection
from archgen.model.selector_words import Problem
from archgen.pipeline import Checked
from archgen.revision import revision
from archgen.views import drawings, pages, record, statistics
from archgen.views import report as report_view
from archgen.views.bars import Drawing
from archgen.views.index import Index, Scope, index
from archgen.views.report import Edition, Level
from archgen.views.shapes import Graph, Outline, Page
from archgen.views.timed import timing

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
    made = _make(checked, ask)
    outline = report_view.report(made.view, made.edition)
    tree.write_file(target, _docx(checked, outline, _draw(made, ask, ("png", "svg_outlines")), ask, template))


def site(checked: Checked, ask: Ask, target: Path) -> None:
    """Write the static site."""
    made = _make(checked, ask)
    listed = tuple(pages.pages(made.view, made.edition))
    tree.write(_site(checked, made, listed, _draw(made, ask, ("svg",))), target)


def diagrams(checked: Checked, ask: Ask, target: Path, forms: Sequence[str], only: Sequence[str] = ()) -> int:
    """Write pictures, in the formats asked for (svg, png, pdf, dot), and give their number."""
    made = _make(checked, ask)
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
    tree.write_file(target, _packed(checked).encode())


def resolved(checked: Checked, ask: Ask, target: Path) -> None:
    """Write the resolved model as a record for other programs."""
    from archgen.emit import yaml

    data = record.record(view(checked, ask))
    tree.write_file(target, yaml.write(data).encode())


def build(
    checked: Checked, ask: Ask, target: Path, template: Path | None = None, extra: Sequence[str] = ()
) -> Iterator[Path]:
    """Write report, site, diagrams and packed file below a folder, and what further backends make; give the paths.

    Where all of it lies there as the same inputs gave it before, nothing is made again.
    """
    chosen = _backends(checked, extra)
    ask = replace(ask, revision=_revision(checked, ask))
    name = "" if chosen else stamp.key(_inputs(checked, ask, template))
    parts = stamp.fresh(kept.folder(), name, target, checked.chapters.picture) if name else None
    warned: list[str] = []
    done: list[str] = []
    for part in parts or _build(checked, replace(ask, warn=_noting(ask.warn, warned)), target, template, chosen):
        done.append(part)
        yield target / part / ("index.html" if part == "site" else "")
    if name and parts is None and not warned:
        stamp.keep(kept.folder(), name, target, done, checked.chapters.asked)


def _noting(warn: Callable[[str], None], said: list[str]) -> Callable[[str], None]:
    def warned(text: str) -> None:
        said.append(text)
        warn(text)

    return warned


def _inputs(checked: Checked, ask: Ask, template: Path | None) -> Iterator[object]:
    """Give all that the outputs depend on, but for this program and the pictures of chapters."""
    project, sources, chapters = checked.architecture.project, checked.sources, checked.chapters
    yield project.id, project.title, ask.words, ask.level, ask.revision
    yield checked.files, checked.all_files, [(file, sources.text(file)) for file in sources.files()]
    yield chapters.order, [(name, chapter.text) for name, chapter in chapters.texts.items()], checked.findings
    yield template and template.read_bytes()


def _build(checked: Checked, ask: Ask, target: Path, template: Path | None, chosen: Sequence[Backend]) -> Iterator[str]:
    """Write each part; give its name."""
    made = _make(checked, ask)
    with ThreadPoolExecutor(1) as beside:  # other processes draw: meanwhile all that needs no picture is made
        drawing = beside.submit(_draw, made, ask, ("svg", "png", "svg_outlines"))
        outline, listed = report_view.report(made.view, made.edition), tuple(pages.pages(made.view, made.edition))
        packed = _packed(checked).encode()
        pictures = drawing.result()
    tree.write_file(target / "report.docx", _docx(checked, outline, pictures, ask, template))
    yield "report.docx"
    tree.write(_site(checked, made, listed, pictures), target / "site")
    yield "site"
    tree.write(folder.write(pictures, ("svg", "png")), target / "diagrams")
    if pictures:
        yield "diagrams"
    tree.write_file(target / "packed.yaml", packed)
    yield "packed.yaml"
    for backend in chosen:
        _extra(made, backend, target / backend.id)
        yield backend.id


def _backends(checked: Checked, names: Sequence[str]) -> list[Backend]:
    """Find the further backends that the user asks for, before any long work."""
    if not names:
        return []
    from archgen.emit import backends

    found, problems = backends.find(checked.root)
    wrong = [problem for problem in problems if any(f"backends/{name}/" in problem.span.file for name in names)]
    _refuse(wrong)
    for name in names:
        if name not in found or found[name].emitter != "text":
            known = ", ".join(name for name, backend in found.items() if backend.emitter == "text")
            msg = f"there is no text backend `{name}`"
            raise tree.OutputError(msg, f"there are {known}")
    return [found[name] for name in names]


def _extra(made: _Made, backend: Backend, target: Path) -> None:
    """Write what one text backend makes."""
    from archgen.emit import text

    shapes: dict[str, Callable[[], object]] = {
        "outline": lambda: report_view.report(made.view, made.edition),
        "pages": lambda: pages.pages(made.view, made.edition),
        "graphs": lambda: tuple(graph for graph in made.graphs.values() if isinstance(graph, Graph)),
        "record": lambda: record.record(made.view),
        "tables": lambda: statistics.statistics(made.view.architecture),
    }
    files, problems = text.write(backend, {name: shapes[name]() for name in backend.views})
    _refuse(problems)
    if files is not None:
        tree.write(files, target)


def _refuse(problems: Sequence[Diagnostic]) -> None:
    if problems:
        said = "; ".join(f"{problem.span}: {problem.message}" for problem in problems)
        raise tree.OutputError(said, problems[0].help)


@dataclass(frozen=True, slots=True)
class _Made:
    """The views that documents are written from."""

    view: Index
    edition: Edition
    graphs: Mapping[str, Drawing]


def _make(checked: Checked, ask: Ask) -> _Made:
    found = replace(view(checked, ask), timed=timing(checked.architecture))
    drawn = drawings.drawings(found, ask.selection, ask.level or "implementation")
    edition = Edition(
        revision=_revision(checked, ask),
        level=ask.level or "implementation",
        chapters=checked.chapters.order,
        texts=checked.chapters.texts,
        graphs=drawn,
        statistics=statistics.statistics(checked.architecture),
        broken=checked.broken,
    )
    return _Made(found, edition, drawn)


def _revision(checked: Checked, ask: Ask) -> str:
    return revision(checked.root, checked.all_files) if ask.revision is None else ask.revision


def _matches(name: str, patterns: Sequence[str]) -> bool:
    return any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns)


def _draw(made: _Made, ask: Ask, formats: Sequence[str]) -> Mapping[str, Picture]:
    return draw(tuple(made.graphs.values()), formats, ask)


def draw(graphs: Sequence[Drawing], formats: Sequence[str], ask: Ask) -> Mapping[str, Picture]:
    """Draw graphs and charts; links in a picture lead to `#` and an element's anchor.

    Where the machine cannot draw, there is a warning and no picture: everything else can still be made.
    """
    from archgen.emit import graphviz

    try:
        pictures = graphviz.draw(
            graphs, formats, link=lambda ref: f"#{ref}", cache=kept.folder(), progress=ask.progress
        )
    except graphviz.MissingGraphviz as missing:
        ask.warn(str(missing))
        return {}
    for picture in pictures.values():
        if picture.warning:
            ask.warn(f"{picture.id}: {picture.warning}")
    return pictures


def _docx(
    checked: Checked, outline: Outline, pictures: Mapping[str, Picture], ask: Ask, template: Path | None
) -> bytes:
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


def _site(checked: Checked, made: _Made, listed: Sequence[Page], pictures: Mapping[str, Picture]) -> tree.FileTree:
    from archgen.emit import site as emitter

    return emitter.write(
        listed,
        pictures,
        title=checked.architecture.project.title,
        revision=made.edition.revision,
        notices=report_view.notices(made.view, made.edition),
        chapter_files=checked.chapters.picture,
    )


def _packed(checked: Checked) -> str:
    from archgen.emit import yaml

    packed = checked.packed()
    return yaml.write(packed.data, packed.comments)
