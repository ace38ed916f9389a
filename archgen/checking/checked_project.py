"""A checked project: its architecture, its findings, and all that was read for them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from archgen.checking.all_rules import READING_RULES, index_all_rules
from archgen.conformance.seen_record import RECORD_FILE
from archgen.diagnostics import Diagnostic, Severity, SourceTexts
from archgen.diagnostics.rule_options import OptionValues
from archgen.frozen import dataclass, field
from archgen.link.report_chapters import ReportChapters
from archgen.model.architecture import Architecture
from archgen.project import LoadedProject
from archgen.syntax.yaml_tree import MappingNode
from archgen.timing.analysis import Analysis

if TYPE_CHECKING:
    from archgen.passes import TransformedProject


@dataclass(frozen=True, slots=True)
class CheckedProject:
    """A checked project: its architecture, without what could not be read, and its findings."""

    loaded_project: LoadedProject
    merged_table: MappingNode
    architecture: Architecture
    chapters: ReportChapters
    findings: tuple[Diagnostic, ...]
    """Settled and sorted, without those that a comment or a setting silences."""
    silenced_findings: tuple[Diagnostic, ...] = ()
    """The findings that a comment or a setting of the project silences."""
    analysis: Analysis | None = None
    """The timing analysis that its rules judged, None where the project has no `timing`."""
    rule_options: Mapping[str, OptionValues] = field(default_factory=dict)
    """The options of rules that the project sets, by rule."""
    waiting_rules: frozenset[str] = frozenset()
    """The rules that wait until errors of reading and linking are mended."""
    parameter_texts: Mapping[str, str] = field(default_factory=dict)
    """The texts of the parameter files that nodes name and the project holds, by path."""
    packed_parameters: Mapping[str, str] = field(default_factory=dict)
    """The same by the name under which a packed file holds them."""
    variants: Mapping[str, CheckedProject] = field(default_factory=dict)
    """The project as it stands in each of its variants, each with the findings that hold there."""
    own_findings: tuple[Diagnostic, ...] = ()
    """The findings that hold in the project itself, whatever its variants give; empty where it has no variants."""
    steps: tuple[str, ...] = ()
    """The variants that are laid over the project as it stands here, in order."""
    transformed: TransformedProject | None = None
    """What passes made of the project, None where it is as it was written."""

    @property
    def root(self) -> Path:
        """The project's folder."""
        return self.loaded_project.root

    @property
    def output_folder(self) -> Path:
        """The default folder for outputs."""
        return self.loaded_project.root / "archgen-out"

    @property
    def sources(self) -> SourceTexts:
        """The texts of the project's files, which diagnostics quote."""
        return self.loaded_project.sources

    @property
    def yaml_files(self) -> tuple[str, ...]:
        """The paths of the project's YAML files, relative to its folder."""
        return tuple(document.file for document in self.loaded_project.documents)

    @property
    def input_files(self) -> tuple[str, ...]:
        """The paths of all files that outputs depend on: YAML, libraries, interface definitions, chapters, parameter files, records."""
        kept = (RECORD_FILE,) if self.loaded_project.files.has_path(RECORD_FILE) else ()
        interface_paths = self.loaded_project.interface_files
        library_paths = self.loaded_project.library_files
        return (*self.yaml_files, *library_paths, *interface_paths, *self.chapters.texts, *self.parameter_texts, *kept)

    @property
    def has_errors(self) -> bool:
        """Whether there are errors."""
        return any(finding.severity is Severity.ERROR for finding in self.findings)

    @property
    def structural_errors(self) -> tuple[Diagnostic, ...]:
        """The errors of reading and linking: what they are about is missing in the architecture."""
        return tuple(d for d in self.findings if d.severity is Severity.ERROR and index_all_rules()[d.rule].fixed)

    @property
    def reading_errors(self) -> tuple[Diagnostic, ...]:
        """The errors of reading: what stands there is unknown, not only what it refers to."""
        return tuple(error for error in self.structural_errors if error.rule in READING_RULES)
