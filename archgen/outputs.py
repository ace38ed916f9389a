"""From a checked project to files: which views are made, which emitters draw them, and where they go."""

from __future__ import annotations

import fnmatch
import os
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from archgen.diagnostic import Diagnostic
from archgen.emit import kept, tree
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
from archgen.views.shapes import Graph
from archgen.views.timed import timing

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
    made = _make(checked, ask)
    tree.write_file(target, _docx(checked, made, _draw(made, ask, ("png", "svg_outlines")), ask, template))


def site(checked: Checked, ask: Ask, target: Path) -> None:
    """Write the static site."""
    made = _make(checked, ask)
    tree.write(_site(checked, made, _draw(made, ask, ("svg",))), target)


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
    tree.write(_picture_files(pictures, forms), target)
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
    """Write report, site, diagrams and packed file below a folder, and what further backends make; give the paths."""
    chosen = _backends(checked, extra, ask.allowed)
    made = _make(checked, ask)
    pictures = _draw(made, ask, ("svg", "png", "svg_outlines"))
    tree.write_file(target / "report.docx", _docx(checked, made, pictures, ask, template))
    yield target / "report.docx"
    tree.write(_site(checked, made, pictures), target / "site")
    yield target / "site" / "index.html"
    tree.write(_picture_files(pictures, ("svg", "png")), target / "diagrams")
    if pictures:
        yield target / "diagrams"
    pack(checked, target / "packed.yaml")
    yield target / "packed.yaml"
    for backend in chosen:
        _extra(made, backend, target / backend.id)
        yield target / backend.id


def _backends(checked: Checked, names: Sequence[str], allowed: Collection[str] | None) -> list[Backend]:
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
        if found[name].own and allowed is not None and name not in allowed:
            msg = f"the project's own backend `{name}` is not run here: the revision that is trusted does not name it"
            raise tree.OutputError(msg, "add it to `review.backends` there, in a change of its own")
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
        revision=_revision(checked) if ask.revision is None else ask.revision,
        level=ask.level or "implementation",
        chapters=checked.chapters.order,
        texts=checked.chapters.texts,
        graphs=drawn,
        statistics=statistics.statistics(checked.architecture),
        broken=checked.broken,
    )
    return _Made(found, edition, drawn)


def _revision(checked: Checked) -> str:
    commit = checked.loaded.files.commit
    return commit[:_SHORT] if commit else revision(checked.root, checked.all_files)


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
            graphs, formats, link=lambda ref: f"#{ref}", cache=cache_folder(), progress=ask.progress
        )
    except graphviz.MissingGraphviz as missing:
        ask.warn(str(missing))
        return {}
    for picture in pictures.values():
        if picture.warning:
            ask.warn(f"{picture.id}: {picture.warning}")
    return pictures


def cache_folder() -> Path | None:
    """Give the folder in which drawn pictures are kept, None where there is no place for it."""
    base = os.environ.get("XDG_CACHE_HOME")
    try:
        return Path(base) / "archgen" if base else Path.home() / ".cache" / "archgen"
    except RuntimeError:  # nobody's home
        return None


def _docx(checked: Checked, made: _Made, pictures: Mapping[str, Picture], ask: Ask, template: Path | None) -> bytes:
    outline = report_view.report(made.view, made.edition)
    data = template.read_bytes() if template else None

    def write(chapter_files: kept.ChapterFiles) -> kept.Written:
        from archgen.emit import docx

        try:
            return docx.write(outline, pictures, template=data, chapter_files=chapter_files)
        except docx.TemplateError as error:
            raise tree.OutputError(str(error)) from None

    shown = checked.chapters.picture
    document, warnings = kept.report(cache_folder(), outline, pictures, template=data, chapter_files=shown, write=write)
    for warning in warnings:
        ask.warn(warning)
    return document


def _site(checked: Checked, made: _Made, pictures: Mapping[str, Picture]) -> tree.FileTree:
    from archgen.emit import site as emitter

    return emitter.write(
        pages.pages(made.view, made.edition),
        pictures,
        title=checked.architecture.project.title,
        revision=made.edition.revision,
        notices=report_view.notices(made.view, made.edition),
        chapter_files=checked.chapters.picture,
    )


def _picture_files(pictures: Mapping[str, Picture], forms: Sequence[str]) -> tree.FileTree:
    found = [
        (f"{name}.{form}", _picture_file(picture, form, pictures))
        for name, picture in pictures.items()
        for form in forms
    ]
    return tree.tree((path, data) for path, data in found if data is not None)


def _picture_file(picture: Picture, form: str, others: Mapping[str, Picture]) -> bytes | None:
    """Give a picture's file; the links of an SVG lead to the other pictures of the folder."""
    from archgen.emit.site import pictures

    if form == "dot":
        return picture.dot.encode()
    data: bytes | None = getattr(picture, form)
    if form != "svg" or data is None:
        return data
    up = "../" * picture.id.count("/")

    def href(anchor: str) -> str | None:
        kind, _, name = anchor.partition(":")
        at = f"{_FOLDERS.get(kind, kind)}/{name}"
        return f"{up}{at}.svg" if at in others and at != picture.id else None

    return pictures.alone(data, href)


_FOLDERS = {"group": "groups", "component": "components", "view": "views", "chain": "chains", "host": "load"}
"""Where the picture of an element lies, by the sort of element."""


def _packed(checked: Checked) -> str:
    from archgen.emit import yaml

    packed = checked.packed()
    return yaml.write(packed.data, packed.comments)
