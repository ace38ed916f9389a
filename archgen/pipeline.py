"""Every stage in order: whoever reads this first has seen the whole way from YAML files to documents.

project -> syntax -> schema -> link -> model -> transform -> analyses -> views -> emit -> files
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from archgen import analyses, link, project, schema, syntax, transform
from archgen.diagnostic import Diagnostic, Rule, Severity, settle
from archgen.findings import suppress
from archgen.model import selector
from archgen.model.architecture import Architecture
from archgen.project import Loaded
from archgen.source import Sources
from archgen.syntax.tree import Table

ALL_RULES: tuple[Rule, ...] = (
    *syntax.RULES,
    *schema.RULES,
    *project.RULES,
    *link.RULES,
    *analyses.RULES,
    *suppress.RULES,
)
"""Every rule there is, in the order in which the stages run."""
_BY_NAME = {rule.name: rule for rule in ALL_RULES}


@dataclass(frozen=True, slots=True)
class Checked:
    """A project, read and judged: the architecture as far as it is sound, and what was found."""

    loaded: Loaded
    merged: Table
    architecture: Architecture
    findings: tuple[Diagnostic, ...]
    """Settled and sorted; those that a comment silences are left out."""

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
    def broken(self) -> bool:
        """Say whether there are errors."""
        return any(finding.severity is Severity.ERROR for finding in self.findings)


def check(path: Path | None = None) -> Checked:
    """Read the project at a path (a folder, a file, or None for the one around the current folder) and judge it.

    Raises `project.ProjectNotFoundError` where there is none.
    """
    return judge(project.load(path))


def check_text(text: str) -> tuple[Diagnostic, ...]:
    """Judge a one-file project given as text; the file is called `project.yaml` in its findings."""
    with tempfile.TemporaryDirectory(prefix="archgen-") as folder:
        file = Path(folder) / "project.yaml"
        file.write_text(text, encoding="utf-8")
        return check(file).findings


def judge(loaded: Loaded) -> Checked:
    """Take a project that was read through all stages up to its findings."""
    merged, merge_findings = link.merge.merge(loaded.documents)
    known, interface_findings = link.interfaces.load(
        loaded.distro, loaded.interface_files, link.interfaces.inline(merged)
    )
    linked, link_findings = link.link(
        merged,
        default_id=loaded.default_id,
        default_title=loaded.default_title,
        shipped=link.shipped.Shipped(loaded.distro),
        interfaces=known,
    )
    architecture = transform.transform(linked)
    raw = [
        *loaded.diagnostics,
        *merge_findings,
        *interface_findings,
        *link_findings,
        *analyses.check(architecture),
        *findings.rules.judge_settings(loaded.rule_places, _BY_NAME),
    ]
    ignores = [ignore for document in loaded.documents for ignore in document.ignores]
    kept = findings.suppress.suppress(raw, ignores, _BY_NAME, findings.suppress.first_lines(architecture))
    return Checked(loaded, merged, architecture, settle(kept, _BY_NAME, loaded.settings))
