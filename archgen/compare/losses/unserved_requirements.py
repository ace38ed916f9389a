"""Requirements that no component serves any more."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.compare.losses.change_context import ChangeContext, PartnerLoss


def find_unserved_requirements(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find requirements that lost their last component.

    Broken are the other partners who serve the same use cases, since these can no longer be achieved; if there are
    none, all other partners: the requirement is what all of them promised.
    """
    serving_before, serving_after = context.versions.serving_components
    for requirement in sorted(serving_before.keys() - serving_after.keys()):
        requirement_element = context.versions.elements_after.get(("requirement", requirement))
        if requirement_element is None:
            continue
        use_cases = requirement_element.values.get("use_cases")
        partners = _serving_partners(
            context, use_cases if isinstance(use_cases, frozenset) else frozenset(), serving_after
        )
        for index in _find_causes(context, requirement, serving_before[requirement]):
            other_partners = partners - context.owners_of_change(index)
            broken_partners = other_partners or frozenset(context.after.partners)
            use_case_note = (
                f", who serve{'s' if len(other_partners) == 1 else ''} the same use case" if other_partners else ""
            )
            reason_text = f"leaves `{requirement}` without a component, also for {{}}{use_case_note}"
            yield from context.losses_of_users([index], broken_partners, reason_text, "", "promise")


def _find_causes(context: ChangeContext, requirement: str, component_ids: frozenset[str]) -> list[int]:
    """Return the indices of the changes that took the last components away."""
    indices: list[int] = []
    for component_id in sorted(component_ids):
        if context.versions.may_be_unread(("component", component_id)):
            continue
        removal_indices = context.indices_by_change_kind("component", component_id, "removed")
        indices += removal_indices or [
            index
            for index in context.change_indices("component", component_id, "requirements")
            if _drops_requirement(context, index, requirement)
        ]
    return list(dict.fromkeys(indices))


def _drops_requirement(context: ChangeContext, change_index: int, requirement: str) -> bool:
    before, after = context.changes[change_index].before, context.changes[change_index].after
    old_requirements = before if isinstance(before, list) else []
    return requirement in old_requirements and requirement not in (after if isinstance(after, list) else [])


def _serving_partners(
    context: ChangeContext, use_cases: frozenset[str], serving_after: Mapping[str, frozenset[str]]
) -> frozenset[str]:
    """Return the partners whose components serve requirements of some of the use cases."""
    partners = set[str]()
    for requirement, components in serving_after.items():
        requirement_element = context.versions.elements_after.get(("requirement", requirement))
        served_cases = requirement_element.values.get("use_cases") if requirement_element else None
        if isinstance(served_cases, frozenset) and not served_cases.isdisjoint(use_cases):
            partners.update(
                owner for component_id in components if (owner := context.owner_before("component", component_id))
            )
    return frozenset(partners)
