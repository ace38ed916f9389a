"""Requirements that ask for something else, and policies that keep less apart: partners build on both, and nobody owns them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from archgen.compare.comparison import Change
from archgen.compare.key_phrases import format_value
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss
from archgen.compare.losses.loss_wording import tick_name
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.text_meaning import differs_in_meaning, quote_difference
from archgen.model.architecture import Architecture, Policy
from archgen.model.selector_evaluation import SelectorEvaluator

_DEMANDING_KEYS = ("title", "description", "priority")


def find_rewritten_requirements(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find requirements that are gone or have other words, and the partners who serve them, or have a part on a chain that
    verifies them. What concerns one of them alone breaks nobody.
    """
    for index, change in enumerate(context.changes):
        words = _describe_demand(change) if change.element_kind == "requirement" else ""
        partners = _list_bound_partners(context, change) if words else ()
        if len(partners) > 1:
            yield from context.losses_of_users([index], partners, f"{words}; {{}} for it", "answers", "meaning")


def _describe_demand(change: Change) -> str:
    """Say what becomes of a requirement; empty where it asks for the same, or for more in a place that was empty."""
    name = tick_name(change.element_id)
    if change.kind == "removed":
        return f"takes away the requirement {name}"
    before, after = (value if isinstance(value, str) else "" for value in (change.before, change.after))
    if change.key not in _DEMANDING_KEYS or not before or not differs_in_meaning(before, after):
        return ""
    old_words, new_words = quote_difference(before, after)
    return f"asks by {name} for {tick_name(new_words) if after else 'nothing more'} instead of {tick_name(old_words)}"


def _list_bound_partners(context: ChangeContext, change: Change) -> set[str]:
    """Return who serves a requirement of the first version, or has a part on a chain that verifies it."""
    old_id = context.old_id("requirement", context.common_id(change))
    requirement = context.before.requirements.get(old_id)
    if requirement is None:
        return set()
    elements = {
        ("component", component.id)
        for component in context.before.components.values()
        if any(use.text == old_id for use in component.requirements)
    }
    for chain_id in (each.text for each in requirement.verified_by if each.kind == "chain"):
        chain = context.before.chains.get(chain_id)
        elements |= {(point.kind, point.id) for point in (chain.through if chain else ())}
    owners = (context.owner_before(kind, context.matched_ids.common_id(kind, name)) for kind, name in elements)
    return {owner for owner in owners if owner}


@dataclass(frozen=True, slots=True)
class _PolicyReach:
    """What a policy is about, by common ids: a component that leaves a `kept` set, or enters `let_pass`, has less of it."""

    kept: tuple[frozenset[str], ...] = ()
    let_pass: frozenset[str] = frozenset()

    def is_weaker_than(self, other: _PolicyReach) -> bool:
        """Whether it keeps less apart than another one did."""
        pairs = zip(self.kept, other.kept, strict=False)
        return (
            len(self.kept) < len(other.kept)
            or any(old - new for new, old in pairs)
            or bool(self.let_pass - other.let_pass)
        )


def find_weakened_policies(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find policies that are gone or keep less apart than before, and the partners whose components they were about."""
    indices: dict[str, list[int]] = defaultdict(list)
    for index, change in enumerate(context.changes):
        if change.element_kind == "policy" and change.kind in {"removed", "changed"}:
            indices[context.common_id(change)].append(index)
    for policy_id, causes in indices.items():
        old_policy = context.before.policies.get(context.old_id("policy", policy_id))
        new_policy = context.after.policies.get(policy_id)
        if old_policy is None:
            continue
        old_reach = _find_reach(context.before, old_policy, context.matched_ids)
        if new_policy is None:
            verb = "takes away"
        elif _find_reach(context.after, new_policy, MatchedIds()).is_weaker_than(_keep_present(old_reach, context)):
            verb = "takes something out of"
        else:
            continue
        parts = _group_by_owner(context, frozenset[str]().union(*old_reach.kept))
        if len(parts) > 1:
            title = format_value(old_policy.title)
            reason_text = f"{verb} the policy {tick_name(policy_id)} ({title}); {{}} under it"
            yield from context.shared_losses(causes, parts, reason_text, "is")


def _find_reach(architecture: Architecture, policy: Policy, matched_ids: MatchedIds) -> _PolicyReach:
    evaluator = SelectorEvaluator(architecture)

    def select(text: str) -> frozenset[str]:
        components = evaluator.evaluate(text)[0].components if text else ()
        return frozenset(matched_ids.common_id("component", each) for each in components)

    accepted = frozenset(matched_ids.common_id("input", each) for each in policy.accepted)
    if policy.require is None:
        return _PolicyReach((select(policy.forbid_from), select(policy.forbid_to)), accepted)
    guard = frozenset({f"guarded by {policy.require.guarded_by}"} if policy.require.guarded_by else ())
    return _PolicyReach((select(policy.require.of),), select(policy.require.inputs_from) | accepted | guard)


def list_policy_partners(architecture: Architecture, matched_ids: MatchedIds) -> Mapping[str, frozenset[str]]:
    """Return for each policy, by common id, the partners whose components it is about."""
    partners = {}
    for policy in architecture.policies.values():
        components = frozenset[str]().union(*_find_reach(architecture, policy, MatchedIds()).kept)
        owners = {owner for each in components for owner in architecture.components[each].owners}
        common_id = matched_ids.common_id("policy", policy.id)
        partners[common_id] = frozenset(matched_ids.common_id("partner", owner) for owner in owners)
    return partners


def _keep_present(reach: _PolicyReach, context: ChangeContext) -> _PolicyReach:
    """Return what a policy was about of all that is still there: what is gone needs no policy."""
    present = {name for kind, name in context.versions.elements_after if kind == "component"}
    new_elements = context.versions.elements_after.keys() - context.versions.elements_before.keys()
    new_names = {name for kind, name in new_elements if kind in {"component", "input"}}
    return _PolicyReach(tuple(each & present for each in reach.kept), reach.let_pass | new_names)


def _group_by_owner(context: ChangeContext, components: Iterable[str]) -> Mapping[str, list[str]]:
    parts: dict[str, list[str]] = defaultdict(list)
    for component in sorted(components):
        if owner := context.owner_before("component", component):
            parts[owner].append(component)
    return parts
