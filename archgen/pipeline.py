"""All stages in order, from YAML files to findings. Read this module first for an overview of archgen.

project -> syntax -> schema -> link -> model -> transform -> analyses -> findings

`archgen.products` goes on from there: views -> emit -> files.
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
"""All rules, in the order in which the stages run."""
_BY_NAME = rules.by_name(ALL_RULES)


@dataclass(frozen=True, slots=True)
class Checked:
    """A checked project: its architecture, without what could not be read, and its findings."""

    loaded: Loaded
    merged: Table
    architecture: Architecture
    chapters: Chapters
    findings: tuple[Diagnostic, ...]
    """Settled and sorted, without those that a comment or a setting silences."""
    silenced: tuple[Diagnostic, ...] = ()
    """The findings that a comment or a setting of the project silences."""

    @property
    def root(self) -> Path:
        """The project's folder."""
        return self.loaded.root

    @property
    def out(self) -> Path:
        """The default folder for outputs."""
        return self.loaded.root / "archgen-out"

    @property
    def sources(self) -> Sources:
        """The texts of the project's files, which diagnostics quote."""
        return self.loaded.sources

    @property
    def files(self) -> tuple[str, ...]:
        """The paths of the project's YAML files, relative to its folder."""
        return tuple(document.file for document in self.loaded.documents)

    @property
    def all_files(self) -> tuple[str, ...]:
        """The paths of all files that outputs depend on: YAML, interface definitions, chapters."""
        return (*self.files, *self.loaded.interfaces, *self.chapters.texts)

    @property
    def broken(self) -> bool:
        """Whether there are errors."""
        return any(finding.severity is Severity.ERROR for finding in self.findings)

    @property
    def unsound(self) -> tuple[Diagnostic, ...]:
        """The errors of reading and linking: what they are about is missing in the architecture."""
        return tuple(d for d in self.findings if d.severity is Severity.ERROR and _BY_NAME[d.rule].fixed)

    def packed(self) -> Packed:
        """Return the whole project as one mapping, with the contents of interface files, chapters and pictures."""
        texts, _ = definitions(self.loaded)
        attached = Attachments(
            {name: text for file, text in texts.items() if (name := interfaces.name_of(file))},
            {path: chapter.text for path, chapter in self.chapters.texts.items()},
            self.chapters.pictures(),
        )
        ignores = [ignore for found in self.loaded.ignores.values() for ignore in found]
        return pack(self.merged, self.architecture, ignores, attached)


def check(path: Path | None = None, known: Slices | None = None) -> Checked:
    """Read and check the project at a path (a folder, a file, or None for the one around the current folder).

    `parsed_slices` is a cache that is filled: pass the same one for several versions of a project, and files that are
    the same in them are parsed once. Raises `project.ProjectNotFoundError` if there is no project.
    """
    with _without_collection():
        return judge(project.load(path, known))


def check_at(path: Path | None, revision: str, known: Slices | None = None) -> Checked:
    """Check the project at a path as it is at a revision of its repository, read from git's objects.

    Raises `git.GitError`, `project.NotAtRevisionError` if the project does not exist at the revision, and
    `project.ProjectNotFoundError` if there is neither a project nor a repository.
    """
    return check_tracked(project.tracked(path), revision, known)


def check_tracked(tracked: Tracked, revision: str, known: Slices | None = None) -> Checked:
    """Check a tracked project at a revision. For many revisions, find the project once, and share `parsed_slices`."""
    with _without_collection():
        return judge(project.load_at(tracked, revision, known))


def judged(loaded: Loaded) -> Checked:
    """Check a project that is loaded already."""
    with _without_collection():
        return judge(loaded)


@contextmanager
def _without_collection() -> Iterator[None]:
    """Pause the garbage collector: trees and models contain no cycles, and it walks all of them again and again."""
    # The command line has disabled it for good; this is for users of the Python API, whose setting is restored.
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            gc.enable()


def check_text(text: str) -> tuple[Diagnostic, ...]:
    """Check a project of one file, given as text; findings call the file `project.yaml`."""
    with tempfile.TemporaryDirectory(prefix="archgen-") as folder:
        file = Path(folder) / "project.yaml"
        file.write_text(text, encoding="utf-8")
        return check(file).findings


def judge(loaded: Loaded) -> Checked:
    """Run all stages on a loaded project, up to its findings.

    No stage stops at errors: each yields its diagnostics and passes on what is sound.
    """
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
    # These errors mean that something is missing in the architecture: `quiet` drops the findings of analyses that they
    # explain, so that one mistake is reported once.
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
    # Only projects that ignore something pay for this.
    first_lines = suppress.first_lines(architecture) if ignores else {}
    kept = settle(suppress.suppress(raw, ignores, _BY_NAME, first_lines), _BY_NAME, loaded.rules)
    silenced = _silenced(raw, kept, loaded.rules) if ignores or Severity.OFF in loaded.rules.values() else ()
    return Checked(loaded, merged, architecture, read, kept, silenced)


def _silenced(
    raw: Iterable[Diagnostic], kept: Iterable[Diagnostic], settings: Mapping[str, Severity]
) -> tuple[Diagnostic, ...]:
    """Return the findings that only comments, or settings that switch a rule off, keep out of the settled ones."""
    shown = frozenset(kept)
    every = settle(raw, _BY_NAME, {rule: severity for rule, severity in settings.items() if severity != Severity.OFF})
    return tuple(finding for finding in every if finding not in shown)


def _interfaces(loaded: Loaded, merged: Table) -> tuple[Interfaces, tuple[Diagnostic, ...]]:
    """Read the project's own interface definitions (files, and `ros.definitions`), which override the shipped ones."""
    texts, diagnostics = definitions(loaded)
    ros = merged.get("ros")
    inline = ros.get("definitions") if isinstance(ros, Table) else None
    entries = inline if isinstance(inline, Table) else ()
    written = {e.key: (e.value.text, e.value.at) for e in entries if isinstance(e.value, Scalar)}
    known, found = interfaces.load(loaded.distro, tuple(texts.items()), written)
    return known, (*diagnostics, *found)


def definitions(loaded: Loaded) -> tuple[dict[str, str], tuple[Diagnostic, ...]]:
    """Read the interface files that the project names; return their texts by path, and what could not be read."""
    texts, diagnostics = {}, []
    for file in loaded.interfaces:
        read = files.read(loaded.files, file)
        if read.problem:
            diagnostics.append(read.problem)
        else:
            texts[file] = read.text
            loaded.sources.add(file, read.text)
    return texts, tuple(diagnostics)
