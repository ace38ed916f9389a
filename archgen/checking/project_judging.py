"""A merged project is linked and judged by all rules.

Guess the element whose title stands where its id is asked: `owner: LogTech GmbH` means the partner `logtech`.

What a project names beside its YAML: chapters, pictures, parameter files, results of tests.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import chain

from archgen import analyses
from archgen.checking.all_rules import index_all_rules, list_structural_errors
from archgen.checking.checked_project import CheckedProject
from archgen.checking.linked_project import LinkedProject, MergedProject, PartMemory, link_merged_project
from archgen.diagnostics import Diagnostic, Label, Severity, SourceTexts, Span, find_closest, settle_diagnostics
from archgen.diagnostics.rule_options import OptionValues
from archgen.findings import error_aftermath, ignore_comments, instance_findings, rule_table
from archgen.frozen import NamedTuple, replace
from archgen.installed_plugins import RULES, list_entries
from archgen.language.language_tables import PLAIN_SECTIONS
from archgen.link import hint_checks, named_files, node_parameter_files, report_chapters
from archgen.link.known_programs import find_shadowed_packages, find_unlike_programs
from archgen.link.report_chapters import ReportChapters
from archgen.model.architecture import Architecture
from archgen.timing.run_analysis import AnalysisMemory


def read_named_contents(
    merged_project: MergedProject, linked_project: LinkedProject, part_memory: PartMemory | None = None
) -> tuple[ReportChapters, tuple[Diagnostic, ...]]:
    """Return the chapters of a project's report, and what is wrong with the files that the project names."""
    loaded_project, merged_table = merged_project.loaded_project, merged_project.table
    is_folder = merged_project.is_folder
    project_chapters, chapter_findings = report_chapters.read_chapters(merged_table, loaded_project.files)
    missing_pictures = report_chapters.find_missing_pictures(
        project_chapters, report_chapters.locate_packed_texts(merged_table), loaded_project.sources
    )
    files_by_element = tuple(
        named_files.list_named_files(merged_table, part_memory.named_files if part_memory else None)
    )
    project_chapters = replace(project_chapters, image_paths=named_files.list_image_paths(files_by_element))
    named_file_findings = named_files.find_missing_files(files_by_element, project_chapters, is_folder=is_folder)
    missing_files = (
        tuple(node_parameter_files.find_missing_parameter_files(merged_table, loaded_project.files))
        if is_folder
        else ()
    )
    missing_verifications = named_files.find_missing_verifications(
        linked_project.linked_architecture, loaded_project.files if is_folder else None
    )
    wrong_hints = (
        tuple(hint_checks.find_wrong_hints(linked_project.linked_architecture, loaded_project.files))
        if is_folder
        else ()
    )
    problems = (
        *chapter_findings,
        *missing_pictures,
        *missing_files,
        *named_file_findings,
        *missing_verifications,
        *wrong_hints,
    )
    return project_chapters, problems


def judge_merged_project(
    merged_project: MergedProject, analysis_memory: AnalysisMemory | None, part_memory: PartMemory | None = None
) -> CheckedProject:
    """Run the stages behind merging; what `part_memory` knows from another variant is not made anew.

    Without `analysis_memory` timing is not judged.
    """
    loaded_project = merged_project.loaded_project
    linked_project = link_merged_project(merged_project, part_memory)
    architecture, read_parameters = linked_project.architecture, linked_project.parameters
    analysis = analyses.analyse_timing(architecture, analysis_memory) if analysis_memory else None
    project_chapters, content_findings = read_named_contents(merged_project, linked_project, part_memory)
    linking_errors = list_structural_errors(
        (*merged_project.diagnostics, *linked_project.interface_findings, *linked_project.link_findings)
    )
    waiting_rules = error_aftermath.list_waiting_rules(
        (*merged_project.reading_errors, *linking_errors),
        loaded_project.lost_keys,
        is_partial=loaded_project.partial,
    )
    rule_options, option_findings = rule_table.settle_rule_options(loaded_project.rule_options, index_all_rules())
    link_findings = linked_project.link_findings
    if loaded_project.unread_names and link_findings:
        from archgen.project.source_patterns import blame_unread_files

        link_findings = tuple(blame_unread_files(link_findings, loaded_project.unread_names))
    all_diagnostics = (
        *add_title_guesses((*loaded_project.diagnostics, *link_findings), architecture, loaded_project.sources),
        *merged_project.diagnostics,
        *linked_project.interface_findings,
        *content_findings,
        *read_parameters.diagnostics,
        *error_aftermath.drop_aftermath(
            (
                *analyses.check_architecture(architecture, analysis, rule_options, waiting_rules),
                *find_shadowed_packages(architecture),
                *find_unlike_programs(architecture),
                *_judge_by_packages(architecture, rule_options),
            ),
            merged_project.reading_errors,
            waiting_rules,
        ),
        *option_findings,
        *rule_table.check_rule_settings(loaded_project.rule_spans.items(), index_all_rules()),
    )
    reported_findings, silenced_findings = _settle_findings(
        all_diagnostics, merged_project, linked_project, is_complete=not waiting_rules and analysis_memory is not None
    )
    return CheckedProject(
        loaded_project,
        merged_project.table,
        architecture,
        project_chapters,
        reported_findings,
        silenced_findings,
        analysis,
        rule_options,
        waiting_rules,
        read_parameters.texts,
        read_parameters.packed_texts,
    )


def _judge_by_packages(architecture: Architecture, rule_options: Mapping[str, OptionValues]) -> Iterable[Diagnostic]:
    """Return what the rules of installed packages find. Where no package has any, nothing is loaded for them."""
    if not list_entries(RULES):
        return ()
    from archgen.findings.plugged_rules import judge_plugged

    return judge_plugged(architecture, rule_options)


def _settle_findings(
    all_diagnostics: Iterable[Diagnostic],
    merged_project: MergedProject,
    linked_project: LinkedProject,
    *,
    is_complete: bool,
) -> tuple[tuple[Diagnostic, ...], tuple[Diagnostic, ...]]:
    """Return the findings to report, sorted, and those that a comment or a setting of the project silences."""
    loaded_project, architecture = merged_project.loaded_project, linked_project.architecture
    raw_diagnostics = instance_findings.gather_instance_findings(
        all_diagnostics,
        architecture,
        [entry.value.span for entry in linked_project.expansion.type_entries.values()],
        frozenset(library.at for library in loaded_project.libraries if library.is_shipped),
    )
    ignores = [ignore for file_ignores in loaded_project.ignores.values() for ignore in file_ignores]
    ignores += (*linked_project.parameters.ignores, *loaded_project.library_ignores)
    # Only projects that ignore something pay for this.
    first_lines = ignore_comments.find_first_lines(architecture) if ignores else {}
    settled_findings = settle_diagnostics(
        ignore_comments.apply_ignores(
            raw_diagnostics,
            ignores,
            index_all_rules(),
            first_lines,
            shared_files=frozenset(loaded_project.library_files),
            is_complete=is_complete,
        ),
        index_all_rules(),
        loaded_project.rule_settings,
    )
    silenced_findings = (
        _find_silenced(raw_diagnostics, settled_findings, loaded_project.rule_settings)
        if ignores or Severity.OFF in loaded_project.rule_settings.values()
        else ()
    )
    return instance_findings.limit_findings(settled_findings), silenced_findings


def _find_silenced(
    raw_diagnostics: Iterable[Diagnostic], settled_findings: Iterable[Diagnostic], settings: Mapping[str, Severity]
) -> tuple[Diagnostic, ...]:
    """Return the findings that only comments, or settings that switch a rule off, keep out of the settled ones."""
    shown_findings = frozenset(settled_findings)
    all_findings = settle_diagnostics(
        raw_diagnostics,
        index_all_rules(),
        {rule: severity for rule, severity in settings.items() if severity != Severity.OFF},
    )
    return tuple(finding for finding in all_findings if finding not in shown_findings)


_MAX_COMPARISONS = 300_000
"""How many titles may be compared in one run, as for misspelt ids. What comes later is reported without a guess."""


class _TitledElement(NamedTuple):
    """An element that a title means: its complete id, and where it is declared."""

    id: str
    at: Span


def add_title_guesses(
    diagnostics: Iterable[Diagnostic], architecture: Architecture, sources: SourceTexts
) -> Iterator[Diagnostic]:
    """Yield the diagnostics; one about a word that is the title of an element says which id was meant."""
    indexes: dict[str, dict[str, _TitledElement]] = {}
    comparisons_left = _MAX_COMPARISONS
    for diagnostic in diagnostics:
        asked_name = diagnostic.asked_name
        if asked_name is None:
            yield diagnostic
            continue
        if asked_name.kind not in indexes:  # built once, and only where something is wrong
            indexes[asked_name.kind] = _index_titles(architecture, asked_name.kind)
        index = indexes[asked_name.kind]
        written_text = _quoted_text(diagnostic, sources)
        element = index.get(written_text.casefold())
        if element is None and not asked_name.is_list and len(index) <= comparisons_left:
            comparisons_left -= len(index)
            element = index.get(find_closest(written_text.casefold(), index) or "")
        if element is None or element.id == written_text:  # the element itself is of the wrong kind there
            yield diagnostic
        else:
            label = Label(element.at, "declared here")
            yield replace(diagnostic, help=f"did you mean `{element.id}`?", labels=(label,))


def _index_titles(architecture: Architecture, kind: str) -> dict[str, _TitledElement]:
    """Return the elements of a kind by title, in one case, and by id. Of several with one title the first counts."""
    # Components first: most references are to them.
    parts = (architecture.components.values(), architecture.groups.values())
    plain = PLAIN_SECTIONS.get(kind.replace(" ", "_"))
    tables: Iterable[Iterable[object]] = (getattr(architecture, plain).values(),) if plain else parts
    index: dict[str, _TitledElement] = {}
    for element in chain.from_iterable(tables):
        titled_element = _TitledElement(element.id, element.at)  # type: ignore[attr-defined]
        index.setdefault(element.title.casefold(), titled_element)  # type: ignore[attr-defined]
        index.setdefault(element.id, titled_element)  # type: ignore[attr-defined]
    return index


def _quoted_text(diagnostic: Diagnostic, sources: SourceTexts) -> str:
    span = diagnostic.span
    line = sources.line_of(span.file, span.line) or ""
    return line[span.column - 1 : span.end_column - 1].strip("\"'") if span.line == span.end_line else ""
