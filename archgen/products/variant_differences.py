"""What is different in each variant of a project, by comparing it with the project itself."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import phrase_severity_counts
from archgen.model.variant import BASE_NAME
from archgen.pipeline import CheckedProject, keep_variant_findings, stand_in_variants
from archgen.products.compared_versions import ProjectVersion, compare_named_versions
from archgen.views.pages.variant_chapter import VariantDifference


def find_variant_differences(checked_project: CheckedProject) -> dict[str, VariantDifference]:
    """Return what is different in each variant, by its id; nothing for a project without variants."""
    if not checked_project.variants:
        return {}
    base = ProjectVersion(BASE_NAME, stand_in_variants(checked_project, [BASE_NAME]))
    differences: dict[str, VariantDifference] = {}
    for name, variant in checked_project.variants.items():
        comparison = compare_named_versions(base, ProjectVersion(name, variant))
        sentences = tuple(change.text for change in comparison.changes)
        holding_findings = keep_variant_findings(checked_project, [name]).findings
        findings = ", ".join(phrase_severity_counts(holding_findings)) or "none"
        differences[name] = VariantDifference(sentences, findings)
    return differences
