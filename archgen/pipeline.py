"""Every stage in order: whoever reads this first has seen the whole way from YAML files to documents.

project -> syntax -> schema -> link -> model -> transform -> analyses -> views -> emit -> files
"""

from __future__ import annotations

import gc
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from archgen import analyses, findings, link, project, schema, transform
from archgen.diagnostic import Diagnostic, Rule, Severity, settle
from archgen.findings import aftermath, rules, suppress
from archgen.frozen import dataclass
from archgen.link import chapters, interfaces, merge, shipped
from archgen.link.chapters import Chapters
from archgen.link.pack import Attachments, Packed, pack
from archgen.model.architecture import Architecture
from archgen.model.interfaces import Interfaces
from archgen.project import Loaded, Slices, Tracked
from archgen.source import Sources
from archgen.syntax import files
from archgen.syntax import interfaces as interface_files
from archgen.syntax.tree import Scalar, Table

ALL_RULES: tuple[Rule, ...] = (
    *interface_files.RULES,
    *schema.RULES,
    *project.RULES,
    *link.RULES,
    *analyses.RULES,
    *findings.RULES,
)
"""Every rule there is, in the order in which the stages run."""
_BY_NAME = rules.by_name(ALL_RULES)


@dataclass(frozen=True, slots=True)
class Checked:
    """A project, read and judged: the architecture as far as it is sound, and what was found."""

    loaded: Loaded
    merged: Table
    architecture: Architecture
    chapters: Chapters
    findings: tuple[Diagnostic, ...]
    """Settled and sorted; those that a comment silences are left out."""
    silenced: tuple[Diagnostic, ...] = ()
    """What a comment or a setting of the project keeps out of the findings."""

    @property
    def root(self) -> Path:
        """Give the project's folder."""
        return self.loaded.root

    @property
    def out(self) -> Path:
        """Give the folder that outputs go to where nobody says otherwise."""
        return self.loaded.root / "archgen-out"

    @property
    def sources(self) -> Sources:
        """Give the texts that diagnostics quote."""
        return self.loaded.sources

    @property
    def files(self) -> tuple[str, ...]:
        """Name the project's YAML files."""
        return tuple(document.file for document in self.loaded.documents)

    @property
    def all_files(self) -> tuple[str, ...]:
        """Name every file that the outputs are made from: YAML, interfaces, chapters."""
        return (*self.files, *self.loaded.interfaces, *self.chapters.texts)

    @property
    def broken(self) -> bool:
        """Say whether there are errors."""
        return any(finding.severity is Severity.ERROR for finding in self.findings)

    @property
    def unsound(self) -> tuple[Diagnostic, ...]:
        """Give the errors of reading and linking: what they speak of is not in the architecture."""
        return tuple(d for d in self.findings if d.severity is Severity.ERROR and _BY_NAME[d.rule].fixed)

    def packed(self) -> Packed:
        """Give the whole project as one mapping, with what stands in other files put in."""
        texts, _ = definitions(self.loaded)
        attached = Attachments(
            {name: text for file, text in texts.items() if (name := interfaces.name_of(file))},
            {path: chapter.text for path, chapter in self.chapters.texts.items()},
            self.chapters.pictures(),
        )
        ignores = [ignore for found in self.loaded.ignores.values() for ignore in found]
        return pack(self.merged, self.architecture, ignores, attached)


def check(path: Path | None = None, known: Slices | None = None) -> Checked:
    """Read the project at a path (a folder, a file, or None for the one around the current folder) and judge it.

    Whoever reads several versions of one project keeps its slices in `known`: what is the same is parsed once.

    Raises `project.ProjectNotFoundError` where there is none.
    """
    with _without_collection():
        return judge(project.load(path, known))


def check_at(path: Path | None, revision: str, known: Slices | None = None) -> Checked:
    """Judge the project at a path as a revision of its repository holds it, read from git's objects.

    Raises `git.GitError`, `project.NotAtRevisionError` where the project does not exist there, and
    `project.ProjectNotFoundError` where there is neither a project nor a repository.
    """
    return check_tracked(project.tracked(path), revision, known)


def check_tracked(tracked: Tracked, revision: str, known: Slices | None = None) -> Checked:
    """Judge a project at a revision; whoever wants many revisions finds the project once, and keeps the slices in `known`."""
    with _without_collection():
        return judge(project.load_at(tracked, revision, known))


def judged(loaded: Loaded) -> Checked:
    """Judge a project that was read."""
    with _without_collection():
        return judge(loaded)


@contextmanager
def _without_collection() -> Iterator[None]:
    """Keep the garbage collector out: trees and models hold no circles, and it walks all of them again and again."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            gc.enable()


def check_text(text: str) -> tuple[Diagnostic, ...]:
    """Judge a one-file project given as text; the file is called `project.yaml` in its findings."""
    with tempfile.TemporaryDirectory(prefix="archgen-") as folder:
        file = Path(folder) / "project.yaml"
        file.write_text(text, encoding="utf-8")
        return check(file).findings


def judge(loaded: Loaded) -> Checked:
    """Take a project that was read through all stages up to its findings."""
    merged, merge_findings = merge.merge(loaded.documents, loaded.lost)
    known, interface_findings = _interfaces(loaded, merged)
    linked, link_findings = link.link(
        merged,
        default_id=loaded.id,
        default_title=loaded.title,
        shipped=shipped.shipped_types(loaded.distro),
        interfaces=known,
        lost=loaded.lost,
        partial=loaded.partial,
    )
    architecture = transform.transform(linked)
    read, chapter_findings = chapters.chapters(merged, loaded.files)
    unread = [d for d in loaded.diagnostics if _BY_NAME[d.rule].fixed and d.severity in {None, Severity.ERROR}]
    raw = (
        *loaded.diagnostics,
        *merge_findings,
        *interface_findings,
        *link_findings,
        *chapter_findings,
        *aftermath.quiet(analyses.check(architecture), unread, loaded.sources),
        *rules.judge_settings(loaded.rule_places.items(), _BY_NAME),
    )
    ignores = [ignore for found in loaded.ignores.values() for ignore in found]
    first_lines = suppress.first_lines(architecture) if ignores else {}
    kept = settle(suppress.suppress(raw, ignores, _BY_NAME, first_lines), _BY_NAME, loaded.rules)
    silenced = _silenced(raw, kept, loaded.rules) if ignores or Severity.OFF in loaded.rules.values() else ()
    return Checked(loaded, merged, architecture, read, kept, silenced)


def _silenced(
    raw: Iterable[Diagnostic], kept: Iterable[Diagnostic], settings: Mapping[str, Severity]
) -> tuple[Diagnostic, ...]:
    """Give the findings that there would be without comments and rules that are switched off."""
    shown = frozenset(kept)
    every = settle(raw, _BY_NAME, {rule: severity for rule, severity in settings.items() if severity != Severity.OFF})
    return tuple(finding for finding in every if finding not in shown)


def _interfaces(loaded: Loaded, merged: Table) -> tuple[Interfaces, tuple[Diagnostic, ...]]:
    """Read the project's own interface definitions, and lay them over those that ship."""
    texts, diagnostics = definitions(loaded)
    ros = merged.get("ros")
    inline = ros.get("definitions") if isinstance(ros, Table) else None
    entries = inline if isinstance(inline, Table) else ()
    written = {e.key: (e.value.text, e.value.at) for e in entries if isinstance(e.value, Scalar)}
    known, found = interfaces.load(loaded.distro, tuple(texts.items()), written)
    return known, (*diagnostics, *found)


def definitions(loaded: Loaded) -> tuple[dict[str, str], tuple[Diagnostic, ...]]:
    """Read the interface files that the project names, by their path."""
    texts, diagnostics = {}, []
    for file in loaded.interfaces:
        read = files.read(loaded.files, file)
        if read.problem:
            diagnostics.append(read.problem)
        else:
            texts[file] = read.text
            loaded.sources.add(file, read.text)
    return texts, tuple(diagnostics)
