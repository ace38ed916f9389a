"""archgen in Python: load a project, look at its architecture and findings, write what people need.

import archgen

project = archgen.load("example_ramcip")
for finding in project.findings:
    print(finding.severity, finding.span, finding.message)
print(project.size.components, "components")
project.write_report("report.docx", select="owner:certh")
"""

from __future__ import annotations

from os import PathLike, fspath
from pathlib import Path

from archgen import agreements, outputs, ownership, pipeline, sides
from archgen.analyses import size as size_analysis
from archgen.diagnostic import Diagnostic
from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.selector import Selection
from archgen.outputs import Ask
from archgen.pipeline import Checked
from archgen.timing import chains as timing_chains
from archgen.timing.analyse import analyse
from archgen.timing.analysis import Analysis, ChainResult
from archgen.views import record
from archgen.views.owners import Ownership
from archgen.views.report import Level
from archgen.views.shapes import Record

Name = str | PathLike[str]


class SelectorError(ValueError):
    """A selector is invalid; the text says why."""


@dataclass(frozen=True, slots=True)
class Project:
    """A checked project. Everything is frozen: load it again to see changed files."""

    checked: Checked

    @property
    def root(self) -> Path:
        """The project's folder."""
        return self.checked.root

    @property
    def architecture(self) -> Architecture:
        """The linked architecture, without what could not be read."""
        return self.checked.architecture

    @property
    def findings(self) -> tuple[Diagnostic, ...]:
        """All findings with their effective severities, sorted by span."""
        return self.checked.findings

    @property
    def ok(self) -> bool:
        """Whether there are no errors; warnings and notes do not count."""
        return not self.checked.broken

    @property
    def size(self) -> size_analysis.Size:
        """The counts of `archgen stats`, with means as exact fractions."""
        return size_analysis.size(self.architecture)

    @property
    def progress(self) -> tuple[size_analysis.Progress, ...]:
        """How complete the project, each group and each partner are, as counts of components."""
        return size_analysis.progress(self.architecture)

    def timing(self) -> Analysis:
        """Analyse rates, response times, loads and traffic. Durations are in ns, rates in Hz; all values are exact."""
        return analyse(self.architecture)

    def chains(self) -> dict[str, ChainResult]:
        """Return the latency of each chain (ns), its terms and the verdict on its deadline, by the chain's id."""
        return timing_chains.chains(self.timing(), self.architecture)

    def select(self, words: str) -> Selection:
        """Evaluate a selector. Raises `SelectorError` if it is invalid."""
        selection, problems = outputs.select(self.checked, words)
        errors = [problem.message for problem in problems if problem.severity == "error"]
        if errors:
            raise SelectorError("; ".join(errors))
        return selection

    def record(self, select: str | None = None) -> Record:
        """Return the resolved model, or the selected part of it, as plain data (`schemas/resolved.schema.json`)."""
        return record.record(outputs.view(self.checked, self._ask(select)))

    def write_report(
        self,
        file: Name,
        *,
        template: Name | None = None,
        select: str | None = None,
        level: Level = "implementation",
        revision: str | None = None,
    ) -> None:
        """Write the Word report. Raises OSError, and `emit.tree.OutputError` for what the user can fix."""
        made = Path(fspath(template)) if template is not None else None
        outputs.report(self.checked, self._ask(select, level, revision), Path(fspath(file)), made)

    def write_site(
        self, folder: Name, *, select: str | None = None, level: Level = "implementation", revision: str | None = None
    ) -> None:
        """Write the static site."""
        outputs.site(self.checked, self._ask(select, level, revision), Path(fspath(folder)))

    def write_diagrams(
        self,
        folder: Name,
        *,
        formats: tuple[str, ...] = ("svg",),
        only: tuple[str, ...] = (),
        select: str | None = None,
    ) -> int:
        """Write diagrams (svg, png, pdf, dot) and return their number."""
        return outputs.diagrams(self.checked, self._ask(select), Path(fspath(folder)), formats, only)

    def write_agreement(
        self, file: Name, first: str, second: str, *, since: str | None = None, revision: str | None = None
    ) -> None:
        """Write what flows between two partners. The file's suffix (.docx, .md, .html) determines the format.

        `since` marks what changed since a git revision (or a folder or packed file). Raises `PartnersError` if the two
        have no interfaces, ValueError for another suffix, `git.GitError` for a revision that does not exist.
        """
        target = Path(fspath(file))
        form = agreements.ENDINGS.get(target.suffix.lower())
        if form is None:
            msg = f"the ending of `{target.name}` names no format: .docx, .md or .html"
            raise ValueError(msg)
        earlier = sides.side(since, self._path()) if since else None
        agreements.write(agreements.made(self.checked, first, second, earlier, revision), form, target)

    def ownership(self) -> Ownership:
        """Return the elements and files that each partner owns."""
        return ownership.ownership(self.checked)

    def codeowners(self) -> str:
        """Return the text of the file CODEOWNERS: the reviewers of each file."""
        return ownership.codeowners(self.checked).text

    def write_packed(self, file: Name) -> None:
        """Write the whole project as one YAML file."""
        outputs.pack(self.checked, Path(fspath(file)))

    def _path(self) -> Path:
        """Return what the project was read from: its folder, or its only file."""
        files = self.checked.files
        return self.root / files[0] if len(files) == 1 else self.root

    def _ask(self, select: str | None, level: Level = "implementation", revision: str | None = None) -> Ask:
        return Ask(self.select(select) if select else None, select or "", level, revision)


def load(path: Name | None = None) -> Project:
    """Read and check the project at a path (a folder or a single file; None: the one around the current folder).

    Raises `archgen.project.ProjectNotFoundError` if there is none. Mistakes in its files are findings, not exceptions.
    """
    return Project(pipeline.check(Path(fspath(path)) if path is not None else None))
