"""All stages in order, from YAML files to findings. Read this module first for an overview of archgen.

project -> syntax -> schema -> compose -> link -> model -> derivation -> analyses -> findings

`archgen.products` goes on from there: views -> emit -> files.
"""

from __future__ import annotations

import gc
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import field
from pathlib import Path
from typing import TYPE_CHECKING

from archgen import analyses, compose, derivation, findings, link, project, schema
from archgen.derivation.derived_parts import DerivedParts
from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic, Rule, Severity, settle_diagnostics
from archgen.diagnostics.rule_options import OptionValues
from archgen.diagnostics.source_span import SourceTexts
from archgen.diagnostics.suggestions import did_you_mean
from archgen.findings import (
    error_aftermath,
    finding_limit,
    ignore_comments,
    instance_findings,
    option_settings,
    rule_table,
)
from archgen.frozen import dataclass, replace
from archgen.link import (
    chapter_pictures,
    element_outline,
    hint_checks,
    interface_sources,
    library_merging,
    mapping_values,
    named_files,
    parameter_files,
    parameter_reading,
    report_chapters,
    slice_merging,
    title_guesses,
    verification_files,
)
from archgen.link.declare.type_declaration import DeclaredTypes
from archgen.link.interface_sources import TypeMessages
from archgen.link.link_memory import LinkMemory
from archgen.link.project_packing import PackedAttachments, PackedProject, has_packed_path, pack_project
from archgen.link.project_types import declare_project_types
from archgen.link.report_chapters import ReportChapters
from archgen.link.variants import variant_order
from archgen.model.architecture import Architecture
from archgen.model.known_interfaces import Interfaces, guess_distro
from archgen.model.known_parts import KnownParts
from archgen.model.variant import BASE_NAME
from archgen.project import LoadedProject, ParsedSlices, TrackedProject
from archgen.project.commit_days import find_commit_day
from archgen.project.variant_settings import adopt_settings, changes_settings
from archgen.syntax import interface_definitions as interface_files
from archgen.syntax import project_files
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, list_spans
from archgen.timing.analysis import Analysis
from archgen.timing.run_analysis import AnalysisMemory

if TYPE_CHECKING:
    from archgen.passes import Pass, TransformedProject

ALL_RULES: tuple[Rule, ...] = (
    *interface_files.RULES,
    *schema.RULES,
    *project.RULES,
    *compose.RULES,
    *link.RULES,
    *analyses.RULES,
    *findings.RULES,
)
"""All rules, in the order in which the stages run."""
_RULES_BY_NAME = rule_table.index_rules(ALL_RULES)
_READING_RULES = frozenset(rule.name for rule in (*interface_files.RULES, *schema.RULES, *project.RULES))


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
        """The paths of all files that outputs depend on: YAML, libraries, interface definitions, chapters, parameter files."""
        interface_paths = self.loaded_project.interface_files
        library_paths = self.loaded_project.library_files
        return (*self.yaml_files, *library_paths, *interface_paths, *self.chapters.texts, *self.parameter_texts)

    @property
    def has_errors(self) -> bool:
        """Whether there are errors."""
        return any(finding.severity is Severity.ERROR for finding in self.findings)

    @property
    def structural_errors(self) -> tuple[Diagnostic, ...]:
        """The errors of reading and linking: what they are about is missing in the architecture."""
        return tuple(d for d in self.findings if d.severity is Severity.ERROR and _RULES_BY_NAME[d.rule].fixed)

    @property
    def reading_errors(self) -> tuple[Diagnostic, ...]:
        """The errors of reading: what stands there is unknown, not only what it refers to."""
        return tuple(error for error in self.structural_errors if error.rule in _READING_RULES)

    def pack_project(self) -> PackedProject:
        """Return the whole project as one mapping, with the contents of interface files, chapters and pictures."""
        texts, _ = read_interface_files(self.loaded_project)
        judged_variants = tuple(self.variants.values())
        attachments = PackedAttachments(
            {name: text for file, text in texts.items() if (name := interface_sources.interface_name_of(file))},
            {path: chapter.text for path, chapter in self.chapters.texts.items()},
            self.chapters.read_pictures(),
            {**self.packed_parameters, **{k: t for each in judged_variants for k, t in each.packed_parameters.items()}},
        )
        ignores = [ignore for file_ignores in self.loaded_project.ignores.values() for ignore in file_ignores]
        silenced_lines = {(each.span.file, each.span.line) for each in self.silenced_findings}
        # In a packed file nobody knows that other projects need the rest.
        ignores += (
            each for each in self.loaded_project.library_ignores if (each.span.file, each.span.line) in silenced_lines
        )
        silenced_findings = dict.fromkeys(
            finding for each in (self, *judged_variants) for finding in each.silenced_findings
        )
        packed_project = pack_project(
            self.merged_table,
            self.architecture,
            ignores,
            attachments,
            tuple(silenced_findings),
            [each.architecture for each in judged_variants],
        )
        _add_origin_comments(packed_project, self)
        return packed_project


def _add_origin_comments(packed_project: PackedProject, checked_project: CheckedProject) -> None:
    """Say at the elements of a project that passes made, now or before, what each was made from."""
    transformed, architecture = checked_project.transformed, checked_project.architecture
    if transformed is None and not architecture.made_elements:
        return
    from archgen.passes import origin_comments

    comments = (
        origin_comments.list_origin_comments(transformed.root, transformed.provenance, architecture.made_elements)
        if transformed
        else origin_comments.keep_origin_comments(checked_project.merged_table, architecture.made_elements)
    )
    ignores = packed_project.comments
    for path, comment in comments.items():
        if has_packed_path(packed_project.data, path):
            packed_project.comments[path] = f"{comment}  # {ignores[path]}" if path in ignores else comment


class VersionCache:
    """What versions of one project share; checks fill it.

    Pass the same one for all of them: files that are the same are parsed once, and timing that is as in the version
    before is not analysed again.
    """

    def __init__(self) -> None:
        """Start empty."""
        self.parsed_slices: ParsedSlices = {}
        self.analysis_memory = AnalysisMemory()


def check_project(
    path: Path | None = None, version_cache: VersionCache | None = None, variants: Sequence[str] | None = None
) -> CheckedProject:
    """Read and check the project at a path (a folder, a file, or None for the one around the current folder).

    `variants` are those that are asked for: others are not judged; None is all of them. Raises `project.ProjectNotFoundError` if there is no project.
    """
    version_cache = version_cache or VersionCache()
    with _pause_garbage_collection():
        loaded_project = project.load_project(path, version_cache.parsed_slices)
        return judge_project(loaded_project, version_cache.analysis_memory, variants)


def check_at_revision(path: Path | None, revision: str, version_cache: VersionCache | None = None) -> CheckedProject:
    """Check the project at a path as it is at a revision of its repository, read from git's objects.

    Raises `git.GitError`, `project.NotAtRevisionError` if the project does not exist at the revision, and
    `project.ProjectNotFoundError` if there is neither a project nor a repository.
    """
    return check_tracked_project(project.find_tracked_project(path), revision, version_cache)


def check_tracked_project(
    tracked_project: TrackedProject, revision: str, version_cache: VersionCache | None = None
) -> CheckedProject:
    """Check a tracked project at a revision. For many revisions, find the project once, and share a cache."""
    version_cache = version_cache or VersionCache()
    with _pause_garbage_collection():
        loaded_project = project.load_at_revision(tracked_project, revision, version_cache.parsed_slices)
        return judge_project(loaded_project, version_cache.analysis_memory)


def check_loaded_project(loaded_project: LoadedProject, version_cache: VersionCache) -> CheckedProject:
    """Check a project that is loaded already."""
    with _pause_garbage_collection():
        return judge_project(loaded_project, version_cache.analysis_memory)


@contextmanager
def _pause_garbage_collection() -> Iterator[None]:
    """Pause the garbage collector: trees and models contain no cycles, and it walks all of them again and again."""
    # The command line has disabled it for good; this is for users of the Python API, whose setting is restored.
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


def check_text(text: str) -> tuple[Diagnostic, ...]:
    """Check a project of one file, given as text; findings call the file `project.yaml`."""
    # Imported here: a check of files needs none of it.
    import tempfile

    with tempfile.TemporaryDirectory(prefix="archgen-") as folder:
        file = Path(folder) / "project.yaml"
        file.write_text(text, encoding="utf-8")
        return check_project(file).findings


def judge_project(
    loaded_project: LoadedProject,
    analysis_memory: AnalysisMemory | None = None,
    variant_names: Sequence[str] | None = None,
) -> CheckedProject:
    """Run all stages on a loaded project, up to its findings; of one with variants, on it in each of them, too.

    `variant_names` are those that are asked for, None for all of them.

    No stage stops at errors: each yields its diagnostics and passes on what is sound.
    """
    checked_project = _judge_in_variants(
        _merge_project(loaded_project), analysis_memory or AnalysisMemory(), variant_names
    )
    return _read_origins(checked_project)


def _read_origins(checked_project: CheckedProject) -> CheckedProject:
    """Return a project with what its comments say of passes that made it: at its elements and in its findings."""
    sources = checked_project.sources
    texts = (sources.text_of(file) or "" for file in sources.file_names())
    if not any("# archgen: made[" in text or "# archgen: from " in text for text in texts):
        return checked_project
    from archgen.passes import origin_comments

    made_elements = origin_comments.read_origin_comments(sources)
    return replace(
        checked_project,
        architecture=replace(checked_project.architecture, made_elements=made_elements),
        findings=origin_comments.label_findings(checked_project.findings, sources, made_elements, {}),
    )


def _judge_in_variants(
    merged_project: _MergedProject, analysis_memory: AnalysisMemory, variant_names: Sequence[str] | None
) -> CheckedProject:
    if "variants" not in merged_project.table.entries:
        return _judge_merged(merged_project, analysis_memory)
    from archgen.findings import variant_findings

    part_memory = PartMemory()
    analysis_memory.make_room(len(mapping_values.get_mapping(merged_project.table, "variants").entries) + 1)
    checked_project = _judge_merged(merged_project, analysis_memory, part_memory)
    judge = _VariantJudge(merged_project, checked_project, analysis_memory, part_memory)
    judged_names = variant_order.list_judged(checked_project.architecture.variants)
    variants = {
        name: judge.judge_steps(judge.list_steps([name]))
        for name in judged_names
        if variant_names is None or name in variant_names
    }
    judged_projects = {BASE_NAME: checked_project, **variants}
    joined_findings = variant_findings.join_findings(
        {name: each.findings for name, each in judged_projects.items()},
        {name: each.waiting_rules for name, each in judged_projects.items()},
        frozenset(list_spans(merged_project.table.entries["variants"].value)),
    )
    return replace(
        checked_project,
        findings=finding_limit.limit_findings(joined_findings),
        own_findings=checked_project.findings,
        variants=variants,
    )


def stand_in_variants(
    checked_project: CheckedProject, names: Sequence[str], analysis_memory: AnalysisMemory | None = None
) -> CheckedProject:
    """Return a checked project as it stands in some of its variants, laid over it in this order; `base` is the project.

    Raises `UnknownVariantError` for a name that is none of them.
    """
    _refuse_unknown(checked_project, names)
    wanted_names = [name for name in names if name != BASE_NAME]
    if not wanted_names:
        if not checked_project.architecture.variants:
            return checked_project
        from archgen.link.variants.variant_laying import remove_variants

        return replace(
            checked_project,
            architecture=replace(checked_project.architecture, variants={}),
            merged_table=remove_variants(checked_project.merged_table),
            findings=checked_project.own_findings,
            variants={},
        )
    if len(wanted_names) == 1 and wanted_names[0] in checked_project.variants:
        return checked_project.variants[wanted_names[0]]
    merged_project = _merge_project(checked_project.loaded_project)
    judge = _VariantJudge(merged_project, checked_project, analysis_memory or AnalysisMemory())
    return judge.judge_steps(judge.list_steps(wanted_names))


def transform_project(
    checked_project: CheckedProject,
    pass_names: Sequence[str],
    known_passes: Mapping[str, Pass] | None = None,
    analysis_memory: AnalysisMemory | None = None,
) -> CheckedProject:
    """Return what passes make of a checked project, judged again; `transformed` says what was made from what.

    `known_passes` are those that there are by name, None for those that ship with archgen.
    A project with variants is taken as it stands without them where a pass keeps none: see `stand_in_variants`.
    Raise `passes.UnknownPassError` for a name that is none of `known_passes`.
    """
    # Imported here: hardly any run needs it.
    from archgen.passes import PASSES, order_passes, run_passes

    known_passes = PASSES if known_passes is None else known_passes
    ordered_passes = order_passes(pass_names, known_passes)
    if checked_project.variants and not all(each.keeps_variants for each in ordered_passes):
        checked_project = stand_in_variants(checked_project, [BASE_NAME])
    transformed = run_passes(
        checked_project.loaded_project,
        checked_project.merged_table,
        pass_names,
        checked_project.architecture.interfaces,
        known_passes,
        checked_project.transformed,
    )
    if not transformed.is_changed and not transformed.findings:
        # It is judged already: most projects have no generic types to remove.
        return replace(checked_project, transformed=transformed)
    diagnostics = (*_merge_project(checked_project.loaded_project).diagnostics, *transformed.findings)
    reading_errors = tuple(_list_structural_errors(checked_project.loaded_project.diagnostics))
    damaged_elements = frozenset(error.element for error in reading_errors if error.element)
    merged_project = _MergedProject(
        checked_project.loaded_project, transformed.root, diagnostics, reading_errors, damaged_elements
    )
    judged_project = _judge_in_variants(merged_project, analysis_memory or AnalysisMemory(), None)
    from archgen.passes import origin_comments

    made_elements = {
        **checked_project.architecture.made_elements,
        **origin_comments.index_origins(transformed.root, transformed.provenance),
    }
    made_places = origin_comments.list_made_places(transformed.root, transformed.provenance)
    return replace(
        judged_project,
        architecture=replace(judged_project.architecture, made_elements=made_elements),
        findings=origin_comments.label_findings(judged_project.findings, judged_project.sources, {}, made_places),
        transformed=transformed,
        steps=checked_project.steps,
    )


def keep_variant_findings(checked_project: CheckedProject, names: Sequence[str]) -> CheckedProject:
    """Return a checked project with the findings that hold in some of its variants; `base` is the project itself.

    Raises `UnknownVariantError` for a name that is none of them.
    """
    _refuse_unknown(checked_project, names)
    kept = tuple(each for each in checked_project.findings if not each.variants or set(names) & set(each.variants))
    return replace(checked_project, findings=kept)


def list_variant_names(path: Path | None) -> tuple[str, ...]:
    """Return the variants of the project at a path, without judging it. Raises `project.ProjectNotFoundError`."""
    table, _ = slice_merging.merge_documents(project.load_project(path).documents)
    return tuple(mapping_values.get_mapping(table, "variants").entries)


def _refuse_unknown(checked_project: CheckedProject, names: Sequence[str]) -> None:
    known_names = (BASE_NAME, *checked_project.architecture.variants)
    for name in names:
        if name not in known_names:
            raise UnknownVariantError(name, known_names)


class UnknownVariantError(Exception):
    """A variant is asked for that the project does not have."""

    def __init__(self, name: str, known_names: Sequence[str]) -> None:
        """Take the name, and the variants that there are."""
        help_line = (
            did_you_mean(name, known_names) or f"there are {join_words([f'`{each}`' for each in known_names], 'and')}"
        )
        super().__init__(f"no variant named `{name}`: {help_line}")


class PartMemory:
    """The parts of a project that its variants have in common."""

    def __init__(self) -> None:
        """Start empty."""
        self.linked = LinkMemory()
        self.derived = DerivedParts()
        self.named_files: named_files.FilesByGroup = KnownParts()


class _VariantJudge:
    """Judges a project in its variants; steps that several have in common are laid over it once."""

    def __init__(
        self,
        merged_project: _MergedProject,
        checked_project: CheckedProject,
        analysis_memory: AnalysisMemory,
        part_memory: PartMemory | None = None,
    ) -> None:
        from archgen.link.variants import variant_laying, variant_order

        loaded_project = merged_project.loaded_project
        self._merged_project = merged_project
        self._memory = analysis_memory
        self._parts = part_memory or PartMemory()
        self._variants = checked_project.architecture.variants
        self._written = mapping_values.get_mapping(merged_project.table, "variants").entries
        self._order = variant_order
        self._layer = variant_laying.VariantLayer(
            loaded_project.lost_keys,
            loaded_project.incomplete_libraries,
            loaded_project.describe_missing_type,
            self._parts.linked,
        )
        base = replace(merged_project, table=variant_laying.remove_variants(merged_project.table))
        self._merged: dict[tuple[str, ...], _MergedProject] = {(): base}
        self._checked: dict[tuple[str, ...], CheckedProject] = {(): checked_project}

    def list_steps(self, names: Sequence[str]) -> tuple[str, ...]:
        return self._order.list_steps(self._variants, names)

    def judge_steps(self, steps: tuple[str, ...]) -> CheckedProject:
        if steps not in self._checked:
            merged_project = self._lay_steps(steps)
            self._checked[steps] = replace(_judge_merged(merged_project, self._memory, self._parts), steps=steps)
        return self._checked[steps]

    def _lay_steps(self, steps: tuple[str, ...]) -> _MergedProject:
        for count in range(1, len(steps) + 1):
            if steps[:count] not in self._merged:
                self._merged[steps[:count]] = self._lay_step(steps[: count - 1], steps[count - 1])
        return self._merged[steps]

    def _lay_step(self, steps: tuple[str, ...], name: str) -> _MergedProject:
        before = self._merged[steps]
        laid = self._layer.lay_variant(before.table, self._written[name], lambda: self.judge_steps(steps).architecture)
        loaded_project = before.loaded_project
        if changes_settings(self._written[name]):
            loaded_project = adopt_settings(loaded_project, laid.root)
        return replace(
            before,
            loaded_project=loaded_project,
            table=laid.root,
            diagnostics=(*before.diagnostics, *laid.diagnostics),
        )


@dataclass(frozen=True, slots=True)
class _MergedProject:
    """A loaded project whose slices and libraries are one table, and what was found on the way."""

    loaded_project: LoadedProject
    table: MappingNode
    diagnostics: tuple[Diagnostic, ...]
    reading_errors: tuple[Diagnostic, ...]
    damaged_elements: frozenset[str]


def _merge_project(loaded_project: LoadedProject) -> _MergedProject:
    # These errors mean that something is missing in the architecture: the findings that they explain wait, so that one
    # mistake is reported once.
    reading_errors = tuple(_list_structural_errors(loaded_project.diagnostics))
    damaged_elements = frozenset(error.element for error in reading_errors if error.element)
    merged_table, merge_findings = slice_merging.merge_documents(
        loaded_project.documents, loaded_project.lost_keys, damaged_elements
    )
    merged_table, library_findings = library_merging.merge_libraries(merged_table, loaded_project.libraries)
    variant_findings = (
        tuple(variant_order.check_variant_order(merged_table, loaded_project.lost_keys))
        if "variants" in merged_table.entries
        else ()
    )
    pass_findings = _find_wrong_passes(loaded_project)
    all_findings = (*merge_findings, *library_findings, *variant_findings, *pass_findings)
    return _MergedProject(loaded_project, merged_table, all_findings, reading_errors, damaged_elements)


def _find_wrong_passes(loaded_project: LoadedProject) -> tuple[Diagnostic, ...]:
    is_folder = loaded_project.first_file == project.PROJECT_FILE
    if not is_folder or not loaded_project.files.has_path(project.PASS_FOLDER.rstrip("/")):
        return ()
    # Imported here: hardly any project has passes of its own.
    from archgen.passes.patterns.pattern_registry import find_wrong_passes

    return tuple(find_wrong_passes(loaded_project.files, loaded_project.sources))


def _judge_merged(
    merged_project: _MergedProject, analysis_memory: AnalysisMemory, part_memory: PartMemory | None = None
) -> CheckedProject:
    """Run the stages behind merging; what `part_memory` knows from another variant is not made anew."""
    linked_parts = part_memory.linked if part_memory else None
    loaded_project, merged_table = merged_project.loaded_project, merged_project.table
    merge_findings, reading_errors = merged_project.diagnostics, merged_project.reading_errors
    damaged_elements = merged_project.damaged_elements
    expansion = compose.expand_project(
        merged_table, loaded_project.incomplete_libraries, loaded_project.describe_missing_type
    )
    outline = element_outline.build_outline(expansion, linked_parts)
    declared_types = declare_project_types(loaded_project, merged_table, expansion, outline, damaged_elements)
    known_interfaces, interface_findings = _load_interfaces(loaded_project, merged_table, declared_types)
    linked_architecture, link_findings = link.link_project(
        expansion,
        outline,
        default_id=loaded_project.id,
        default_title=loaded_project.title,
        declared_types=declared_types,
        interfaces=known_interfaces,
        lost_keys=loaded_project.lost_keys,
        damaged_elements=damaged_elements,
        is_partial=loaded_project.partial,
        memory=linked_parts,
    )
    # A project of one file is a whole: like its `sources`, what it names lies elsewhere.
    is_folder = loaded_project.first_file == project.PROJECT_FILE
    read_parameters = parameter_reading.read_node_parameters(
        merged_table, linked_architecture, loaded_project.files if is_folder else None
    )
    for path, text in read_parameters.texts.items():
        loaded_project.sources.add_text(path, text)
    architecture = derivation.derive_low_level(
        read_parameters.architecture, part_memory.derived if part_memory else None
    )
    commit_day = find_commit_day(loaded_project.files, architecture)
    if commit_day is not None:
        architecture = replace(architecture, commit_day=commit_day)
    analysis = analyses.analyse_timing(architecture, analysis_memory)
    project_chapters, chapter_findings = report_chapters.read_chapters(merged_table, loaded_project.files)
    missing_pictures = chapter_pictures.find_missing_pictures(
        project_chapters, report_chapters.locate_packed_texts(merged_table), loaded_project.sources
    )
    files_by_element = tuple(
        named_files.list_named_files(merged_table, part_memory.named_files if part_memory else None)
    )
    project_chapters = replace(project_chapters, image_paths=named_files.list_image_paths(files_by_element))
    named_file_findings = named_files.find_missing_files(files_by_element, project_chapters, is_folder=is_folder)
    missing_files = (
        tuple(parameter_files.find_missing_parameter_files(merged_table, loaded_project.files)) if is_folder else ()
    )
    missing_verifications = verification_files.find_missing_verifications(
        linked_architecture, loaded_project.files if is_folder else None
    )
    wrong_hints = tuple(hint_checks.find_wrong_hints(linked_architecture, loaded_project.files)) if is_folder else ()
    linking_errors = _list_structural_errors((*merge_findings, *interface_findings, *link_findings))
    waiting_rules = error_aftermath.list_waiting_rules(
        (*reading_errors, *linking_errors), loaded_project.lost_keys, is_partial=loaded_project.partial
    )
    rule_options, option_findings = option_settings.read_rule_options(loaded_project.rule_options, _RULES_BY_NAME)
    all_diagnostics = (
        *title_guesses.add_title_guesses(
            (*loaded_project.diagnostics, *link_findings), architecture, loaded_project.sources
        ),
        *merge_findings,
        *interface_findings,
        *chapter_findings,
        *missing_pictures,
        *missing_files,
        *named_file_findings,
        *missing_verifications,
        *wrong_hints,
        *read_parameters.diagnostics,
        *error_aftermath.drop_aftermath(
            analyses.check_architecture(architecture, analysis, rule_options), reading_errors, waiting_rules
        ),
        *option_findings,
        *rule_table.check_rule_settings(loaded_project.rule_spans.items(), _RULES_BY_NAME),
    )
    raw_diagnostics = instance_findings.gather_instance_findings(
        all_diagnostics,
        architecture,
        [entry.value.span for entry in expansion.type_entries.values()],
        frozenset(library.at for library in loaded_project.libraries if library.is_shipped),
    )
    ignores = [ignore for file_ignores in loaded_project.ignores.values() for ignore in file_ignores]
    ignores += (*read_parameters.ignores, *loaded_project.library_ignores)
    # Only projects that ignore something pay for this.
    first_lines = ignore_comments.find_first_lines(architecture) if ignores else {}
    settled_findings = settle_diagnostics(
        ignore_comments.apply_ignores(
            raw_diagnostics,
            ignores,
            _RULES_BY_NAME,
            first_lines,
            shared_files=frozenset(loaded_project.library_files),
            is_complete=not waiting_rules,
        ),
        _RULES_BY_NAME,
        loaded_project.rule_settings,
    )
    reported_findings = finding_limit.limit_findings(settled_findings)
    silenced_findings = (
        _find_silenced(raw_diagnostics, settled_findings, loaded_project.rule_settings)
        if ignores or Severity.OFF in loaded_project.rule_settings.values()
        else ()
    )
    return CheckedProject(
        loaded_project,
        merged_table,
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


def _list_structural_errors(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    return [d for d in diagnostics if _RULES_BY_NAME[d.rule].fixed and d.severity in {None, Severity.ERROR}]


def _find_silenced(
    raw_diagnostics: Iterable[Diagnostic], settled_findings: Iterable[Diagnostic], settings: Mapping[str, Severity]
) -> tuple[Diagnostic, ...]:
    """Return the findings that only comments, or settings that switch a rule off, keep out of the settled ones."""
    shown_findings = frozenset(settled_findings)
    all_findings = settle_diagnostics(
        raw_diagnostics,
        _RULES_BY_NAME,
        {rule: severity for rule, severity in settings.items() if severity != Severity.OFF},
    )
    return tuple(finding for finding in all_findings if finding not in shown_findings)


def _load_interfaces(
    loaded_project: LoadedProject, merged_table: MappingNode, declared_types: DeclaredTypes
) -> tuple[Interfaces, tuple[Diagnostic, ...]]:
    """Read the project's own interface definitions, which override the shipped ones: files, `ros.definitions`, types."""
    texts, diagnostics = read_interface_files(loaded_project)
    ros_section = merged_table.get("ros")
    inline_table = ros_section.get("definitions") if isinstance(ros_section, MappingNode) else None
    entries = inline_table if isinstance(inline_table, MappingNode) else ()
    inline_definitions = {e.key: (e.value.text, e.value.span) for e in entries if isinstance(e.value, ScalarNode)}
    known_interfaces, load_diagnostics = interface_sources.load_interfaces(
        guess_distro(loaded_project.distro),
        tuple(texts.items()),
        inline_definitions,
        TypeMessages(declared_types.definitions, declared_types.message_mentions),
    )
    return known_interfaces, (*diagnostics, *load_diagnostics)


def read_interface_files(loaded_project: LoadedProject) -> tuple[dict[str, str], tuple[Diagnostic, ...]]:
    """Read the interface files that the project names; return their texts by path, and what could not be read."""
    texts, diagnostics = {}, []
    for file in loaded_project.interface_files:
        read_file = project_files.read_text_file(loaded_project.files, file)
        if read_file.problem:
            diagnostics.append(read_file.problem)
        else:
            texts[file] = read_file.text
            loaded_project.sources.add_text(file, read_file.text)
    return texts, tuple(diagnostics)
