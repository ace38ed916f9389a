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
from typing import TYPE_CHECKING

from archgen import pipeline
from archgen.analyses import size_counts as size_analysis
from archgen.checking import code_ownership
from archgen.diagnostics import Diagnostic
from archgen.frozen import dataclass, replace
from archgen.model.architecture import Architecture
from archgen.model.selector_evaluation import Selection
from archgen.pipeline import CheckedProject
from archgen.products import (
    agreement_documents,
    project_outputs,
    project_views,
    signed_agreements,
)
from archgen.products.output_options import OutputOptions
from archgen.simulation.chain_witnesses import judge_chains
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.run_analysis import analyse_architecture
from archgen.views.pages.report_outline import DetailLevel, ReportDocument
from archgen.views.partner_ownership import Ownership
from archgen.views.records import resolved_record
from archgen.views.shapes import Record

if TYPE_CHECKING:
    from networkx import MultiDiGraph

AnyPath = str | PathLike[str]


class SelectorError(ValueError):
    """A selector is invalid; the text says why."""


@dataclass(frozen=True, slots=True)
class Project:
    """A checked project. Everything is frozen: load it again to see changed files."""

    checked: CheckedProject

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
        return not self.checked.has_errors

    @property
    def size(self) -> size_analysis.ArchitectureSize:
        """The counts of `archgen stats`, with means as exact fractions."""
        return size_analysis.measure_size(self.architecture)

    @property
    def progress(self) -> tuple[size_analysis.ProgressCounts, ...]:
        """How complete the project, each group and each partner are, as counts of components."""
        return size_analysis.measure_progress(self.architecture)

    def in_variant(self, *names: str) -> Project:
        """Return the project as it stands in a variant, or in several, laid over it in this order.

        Raises `archgen.pipeline.UnknownVariantError` for a variant that it does not have.
        """
        return Project(pipeline.stand_in_variants(self.checked, names))

    def timing(self) -> Analysis:
        """Analyse rates, response times, loads and traffic. Durations are in ns, rates in Hz; all values are exact."""
        return analyse_architecture(self.architecture)

    def chains(self) -> dict[str, ChainResult]:
        """Return the latency of each chain (ns), its terms and the verdict on its deadline, by the chain's id."""
        return judge_chains(self.timing(), self.architecture)

    def select(self, words: str) -> Selection:
        """Evaluate a selector. Raises `SelectorError` if it is invalid."""
        selection, problems = project_views.select_elements(self.checked, words)
        errors = [problem.message for problem in problems if problem.severity == "error"]
        if errors:
            raise SelectorError("; ".join(errors))
        return selection

    def record(self, select: str | None = None) -> Record:
        """Return the resolved model, or the selected part of it, as plain data (`schemas/resolved.schema.json`)."""
        return resolved_record.make_record(project_views.make_scoped_lookup(self.checked, self._output_options(select)))

    def rows(self, kind: str, select: str | None = None) -> list[dict[str, str]]:
        """Return what `archgen list --of KIND` lists, a dict a row. Raises KeyError for another kind."""
        columns, rows = project_views.list_rows(self.checked, self._output_options(select), kind)
        return [dict(zip(columns, row, strict=True)) for row in rows]

    def graph(self, select: str | None = None) -> MultiDiGraph:
        """Return who reads whom as a graph of networkx (`pip install 'archgen[graph]'`).

        Its nodes are the ids of components, with what `rows("components")` says of them; its edges have the row of
        `rows("edges")`, and their output and input as key. What lies outside of a selection is left out.
        """
        from networkx import MultiDiGraph

        graph = MultiDiGraph(name=self.architecture.project.title)
        for row in self.rows("components", select):
            graph.add_node(row["id"], **row)
        for row in self.rows("edges", select):
            ends = row["output"], row["input"]
            giver, taker = self.architecture.outputs[ends[0]].component, self.architecture.inputs[ends[1]].component
            if giver in graph and taker in graph:
                graph.add_edge(giver, taker, key=ends, **row)
        return graph

    def write_report(  # noqa: PLR0913 - what may be asked for
        self,
        file: AnyPath,
        *,
        template: AnyPath | None = None,
        document: ReportDocument = "deliverable",
        select: str | None = None,
        level: DetailLevel | None = None,
        revision: str | None = None,
    ) -> None:
        """Write the report, or another of its documents: `data-sheets`, `workbook` (.xlsx), `full`.

        Raises OSError, and `emit.tree.OutputError` for what the user can fix.
        """
        options = replace(self._output_options(select, level, revision), document=document)
        if document == "workbook":
            project_outputs.write_report_workbook(self.checked, options, Path(fspath(file)))
            return
        template_path = Path(fspath(template)) if template is not None else None
        project_outputs.write_report(self.checked, options, Path(fspath(file)), template_path)

    def write_site(
        self,
        folder: AnyPath,
        *,
        select: str | None = None,
        level: DetailLevel = "implementation",
        revision: str | None = None,
    ) -> None:
        """Write the static site."""
        project_outputs.write_site(self.checked, self._output_options(select, level, revision), Path(fspath(folder)))

    def write_diagrams(
        self,
        folder: AnyPath,
        *,
        formats: tuple[str, ...] = ("svg",),
        only: tuple[str, ...] = (),
        select: str | None = None,
    ) -> int:
        """Write diagrams (svg, png, pdf, dot) and return their number."""
        return project_outputs.write_diagrams(
            self.checked, self._output_options(select), Path(fspath(folder)), formats, only
        )

    def write_agreement(  # noqa: PLR0913 - what may be printed instead of what git says
        self,
        file: AnyPath,
        first: str,
        second: str,
        *,
        since: str | None = None,
        revision: str | None = None,
        date: str | None = None,
    ) -> None:
        """Write what flows between two partners. The file's suffix (.docx, .md, .html, .json) determines the format.

        `since` marks what changed since a git revision (or a folder or packed file); `date` (`2026-03-31`) and `revision`
        are printed instead of git's. Raises `PartnersError` if the two have no interfaces, ValueError for another suffix
        or what is no date, `git.GitError` for a revision that does not exist.
        """
        target = Path(fspath(file))
        file_format = agreement_documents.FORMAT_BY_ENDING.get(target.suffix.lower())
        if file_format is None:
            raise ValueError(f"the ending of `{target.name}` names no format: .docx, .md, .html or .json")
        issue_date = agreement_documents.parse_issue_date(date) if date else None
        earlier_version = (
            signed_agreements.read_agreed_version(since, self.checked, self._source_path()) if since else None
        )
        agreement_documents.write_agreement(
            agreement_documents.make_project_agreement(
                self.checked, first, second, earlier_version, revision, issue_date=issue_date
            ),
            file_format,
            target,
        )

    def ownership(self) -> Ownership:
        """Return the elements and files that each partner owns."""
        return code_ownership.find_ownership(self.checked)

    def codeowners(self) -> str:
        """Return the text of the file CODEOWNERS: the reviewers of each file."""
        return code_ownership.make_codeowners(self.checked).text

    def write_packed(self, file: AnyPath) -> None:
        """Write the whole project as one YAML file."""
        project_outputs.write_packed(self.checked, Path(fspath(file)))

    def _source_path(self) -> Path:
        """Return what the project was read from: its folder, or its only file."""
        files = self.checked.yaml_files
        return self.root / files[0] if len(files) == 1 else self.root

    def _output_options(
        self, select: str | None, level: DetailLevel | None = "implementation", revision: str | None = None
    ) -> OutputOptions:
        return OutputOptions(self.select(select) if select else None, select or "", level, revision)


def load(path: AnyPath | None = None) -> Project:
    """Read and check the project at a path (a folder or a single file; None: the one around the current folder).

    Raises `archgen.project.ProjectNotFoundError` if there is none. Mistakes in its files are findings, not exceptions.
    """
    return Project(pipeline.check_project(Path(fspath(path)) if path is not None else None))
