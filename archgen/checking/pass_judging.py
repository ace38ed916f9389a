"""What passes make of a checked project is judged again, and what they left in comments is read back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from archgen.checking.checked_project import CheckedProject
from archgen.checking.merged_project import merge_project
from archgen.checking.variant_judging import judge_in_variants, stand_in_variants
from archgen.frozen import replace
from archgen.model.variant import BASE_NAME
from archgen.timing.run_analysis import AnalysisMemory

if TYPE_CHECKING:
    from archgen.passes import Pass


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
    before_passes = merge_project(checked_project.loaded_project)
    diagnostics = (*before_passes.diagnostics, *transformed.findings)
    merged_project = replace(before_passes, table=transformed.root, diagnostics=diagnostics)
    judged_project = judge_in_variants(merged_project, analysis_memory or AnalysisMemory(), None)
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
