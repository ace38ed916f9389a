"""A project is judged as it stands in each of its variants, and as passes make it; what these left in comments is read back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from archgen import project
from archgen.checking.checked_project import CheckedProject
from archgen.checking.linked_project import MergedProject, PartMemory, merge_project
from archgen.checking.project_judging import judge_merged_project
from archgen.diagnostics import did_you_mean, join_words
from archgen.findings import instance_findings
from archgen.frozen import replace
from archgen.link import mapping_values, slice_merging
from archgen.link.variants import variant_order
from archgen.model.variant import BASE_NAME
from archgen.project.project_loading import adopt_settings, changes_settings
from archgen.syntax.project_files import RememberedFiles
from archgen.syntax.yaml_tree import list_spans
from archgen.timing.run_analysis import AnalysisMemory

if TYPE_CHECKING:
    from archgen.passes import Pass


class UnknownVariantError(Exception):
    """A variant is asked for that the project does not have."""

    def __init__(self, name: str, known_names: Sequence[str]) -> None:
        """Take the name, and the variants that there are."""
        help_line = (
            did_you_mean(name, known_names) or f"there are {join_words([f'`{each}`' for each in known_names], 'and')}"
        )
        super().__init__(f"no variant named `{name}`: {help_line}")


def judge_in_variants(
    merged_project: MergedProject,
    analysis_memory: AnalysisMemory | None,
    variant_names: Sequence[str] | None,
    part_memory: PartMemory | None = None,
) -> CheckedProject:
    """Judge a merged project, and, where it has variants, as it stands in each of those that are asked for (None: all).

    What `part_memory` knows of other versions of the project is not made anew. Without `analysis_memory` timing is not judged.
    """
    if "variants" not in merged_project.table.entries:
        return judge_merged_project(merged_project, analysis_memory, part_memory)
    from archgen.findings import variant_findings

    part_memory = part_memory or PartMemory()
    loaded_project = merged_project.loaded_project
    merged_project = replace(
        merged_project, loaded_project=replace(loaded_project, files=RememberedFiles(loaded_project.files))
    )
    if analysis_memory:
        analysis_memory.make_room(len(mapping_values.get_mapping(merged_project.table, "variants").entries) + 1)
    checked_project = judge_merged_project(merged_project, analysis_memory, part_memory)
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
        loaded_project=loaded_project,
        findings=instance_findings.limit_findings(joined_findings),
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
    merged_project = merge_project(checked_project.loaded_project)
    judge = _VariantJudge(merged_project, checked_project, analysis_memory or AnalysisMemory())
    return judge.judge_steps(judge.list_steps(wanted_names))


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


class _VariantJudge:
    """Judges a project in its variants; steps that several have in common are laid over it once."""

    def __init__(
        self,
        merged_project: MergedProject,
        checked_project: CheckedProject,
        analysis_memory: AnalysisMemory | None,
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
        self._merged: dict[tuple[str, ...], MergedProject] = {(): base}
        self._checked: dict[tuple[str, ...], CheckedProject] = {(): checked_project}

    def list_steps(self, names: Sequence[str]) -> tuple[str, ...]:
        return self._order.list_steps(self._variants, names)

    def judge_steps(self, steps: tuple[str, ...]) -> CheckedProject:
        if steps not in self._checked:
            merged_project = self._lay_steps(steps)
            self._checked[steps] = replace(judge_merged_project(merged_project, self._memory, self._parts), steps=steps)
        return self._checked[steps]

    def _lay_steps(self, steps: tuple[str, ...]) -> MergedProject:
        for count in range(1, len(steps) + 1):
            if steps[:count] not in self._merged:
                self._merged[steps[:count]] = self._lay_step(steps[: count - 1], steps[count - 1])
        return self._merged[steps]

    def _lay_step(self, steps: tuple[str, ...], name: str) -> MergedProject:
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


def read_origins(checked_project: CheckedProject) -> CheckedProject:
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


def transform_project(
    checked_project: CheckedProject,
    pass_names: Sequence[str],
    known_passes: Mapping[str, Pass] | None = None,
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
    before_passes = merge_project(checked_project.loaded_project)
    diagnostics = (*before_passes.diagnostics, *transformed.findings)
    merged_project = replace(before_passes, table=transformed.root, diagnostics=diagnostics)
    judged_project = judge_in_variants(merged_project, AnalysisMemory(), None)
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
