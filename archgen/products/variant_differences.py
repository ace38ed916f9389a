"""What is different in each variant of a project, by comparing it with the project itself."""

from __future__ import annotations

from archgen.compare.change_listing import list_changes
from archgen.diagnostics import phrase_severity_counts
from archgen.model.variant import BASE_NAME
from archgen.pipeline import CheckedProject, keep_variant_findings, stand_in_variants
from archgen.products.compared_versions import make_comparison_input
from archgen.views.pages.variant_chapter import VariantDifference


def find_variant_differences(checked_project: CheckedProject) -> dict[str, VariantDifference]:
    """Return what is different in each variant, by its id; nothing for a project without variants."""
    if not checked_project.variants:
        return {}
    base = make_comparison_input(stand_in_variants(checked_project, [BASE_NAME]))
    differences: dict[str, VariantDifference] = {}
    for name, variant in checked_project.variants.items():
        # Not a whole comparison: nobody asks what a variant breaks, and the bounds of its chains take most of the time.
        sentences = tuple(change.text for change in list_changes(base, make_comparison_input(variant)))
        holding_findings = keep_variant_findings(checked_project, [name]).findings
        findings = ", ".join(phrase_severity_counts(holding_findings)) or "none"
        differences[name] = VariantDifference(sentences, findings)
    return differences
