"""Requirements that ask for something else or that nobody serves any more, policies that keep less away, and outputs that
promise less to those who read them, have another version, or are going away.

What counts is the port that a reader names: of a composed component its own output, not what is inside.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from functools import cached_property

from archgen.compare.comparison import Change
from archgen.compare.key_phrases import format_value
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss, tick_name
from archgen.compare.losses.lost_connections import find_output_causes
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.text_meaning import differs_in_meaning, quote_difference
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture, Policy
from archgen.model.component import ComponentType, Output
from archgen.model.component_nesting import list_relied_outputs
from archgen.model.message_types import ConceptualType
from archgen.model.project_settings import BreakCategory
from archgen.model.promise import Deprecation, Promise, format_range
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
    owners = (context.owner_before(kind, context.matched_ids.common_id(kind, name)) for kind, name in sorted(elements))
    return {owner for owner in owners if owner}


class _PolicyReach(NamedTuple):
    """What a policy is about, by common ids: a component that leaves a `kept` set, or enters `let_pass`, has less of it."""

    kept: tuple[frozenset[str], ...]
    let_pass: frozenset[str]


def find_weakened_policies(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find policies that are gone or keep less apart than before, and the partners whose components they were about."""
    if not context.before.policies:
        return
    old_evaluator, new_evaluator = SelectorEvaluator(context.before), SelectorEvaluator(context.after)
    # What is gone needs no policy, and what is new was under none.
    present = {name for kind, name in context.versions.elements_after if kind == "component"}
    new_names = {name for _, name in context.versions.elements_after.keys() - context.versions.elements_before.keys()}
    for old_policy in context.before.policies.values():
        policy_id = context.matched_ids.common_id("policy", old_policy.id)
        policy = context.after.policies.get(policy_id)
        before = _find_reach(old_evaluator, old_policy, context.matched_ids)
        after = _find_reach(new_evaluator, policy, MatchedIds()) if policy else _PolicyReach((), frozenset())
        is_whole = len(before.kept) == len(after.kept)
        left = frozenset[str]().union(*(old - new for old, new in zip(before.kept, after.kept, strict=False))) & present
        if is_whole and not left and after.let_pass <= before.let_pass | new_names:
            continue
        # A component may leave what a policy selects without a word about the policy; one that moves is another part.
        causes = context.change_indices("policy", policy_id) or [
            index for name in sorted(left) for index in context.indices_by_change_kind("component", name, "changed")
        ]
        parts: dict[str, list[str]] = defaultdict(list)
        for component in sorted(frozenset[str]().union(*before.kept)):
            if owner := context.owner_before("component", component):
                parts[owner].append(component)
        if len(parts) > 1:
            verb = "takes something out of" if policy else "takes away"
            title = format_value(old_policy.title)
            reason_text = f"{verb} the policy {tick_name(policy_id)} ({title}); {{}} under it"
            yield from context.shared_losses(dict.fromkeys(causes), parts, reason_text, "is")


def _find_reach(evaluator: SelectorEvaluator, policy: Policy, matched_ids: MatchedIds) -> _PolicyReach:
    def select(text: str) -> frozenset[str]:
        components = evaluator.evaluate(text)[0].components if text else ()
        return frozenset(matched_ids.common_id("component", each) for each in components)

    accepted = frozenset(matched_ids.common_id("input", each) for each in policy.accepted)
    if policy.require is None:
        return _PolicyReach((select(policy.forbid_from), select(policy.forbid_to)), accepted)
    guard = frozenset({f"guarded by {policy.require.guarded_by}"} if policy.require.guarded_by else ())
    return _PolicyReach((select(policy.require.of),), select(policy.require.inputs_from) | accepted | guard)


def list_policy_partners(
    before: Architecture, after: Architecture, matched_ids: MatchedIds
) -> Mapping[str, frozenset[str]]:
    """Return for each policy, by common id, the partners whose components it is about in either version."""
    partners: dict[str, frozenset[str]] = {}
    for architecture, ids in ((before, matched_ids), (after, MatchedIds())):
        evaluator = SelectorEvaluator(architecture)
        for policy in architecture.policies.values():
            components = frozenset[str]().union(*_find_reach(evaluator, policy, MatchedIds()).kept)
            owners = {owner for each in components for owner in architecture.components[each].owners}
            name = ids.common_id("policy", policy.id)
            partners[name] = partners.get(name, frozenset()) | {ids.common_id("partner", owner) for owner in owners}
    return partners


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


class _Weakening(NamedTuple):
    """What is promised less, in words: it stands behind the name of the output. `key` is what says it."""

    words: str
    key: str
    category: BreakCategory = "promise"


_Living = Output | ConceptualType | ComponentType
_Reading = tuple[str, str]
"""An input and the leaf's output that it reads, by common ids."""


def find_weakened_words(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find outputs of which less is promised than before, that have another version, or are deprecated now."""
    if not any(
        output.promise is not None or output.version is not None or output.deprecated is not None
        for output in _list_outputs(context.before)
    ) and not any(output.deprecated for output in _list_outputs(context.after)):
        return
    yield from _WordComparison(context).list_losses()


def _list_outputs(architecture: Architecture) -> Iterator[Output]:
    yield from architecture.outputs.values()
    yield from (output for shell in architecture.shells.values() for output in shell.outputs.values())


class _WordComparison:
    """What is said of outputs in two versions, as their readers see it."""

    def __init__(self, context: ChangeContext) -> None:
        self._context = context

    def list_losses(self) -> Iterator[PartnerLoss]:
        """Yield what partners lose, output by output."""
        context = self._context
        for leaf, new_leaf, inputs_by_partner in context.lasting_outputs:
            readers: dict[tuple[str, str], dict[str, list[str]]] = defaultdict(lambda: defaultdict(list))
            for partner, inputs in inputs_by_partner.items():
                for reader in inputs:
                    old_port = self._ports_before.get((reader, leaf))
                    new_port = self._find_new_port(reader, leaf, new_leaf, old_port)
                    if old_port is not None and new_port is not None:
                        readers[old_port.id, new_port.id][partner].append(reader)
            for (old_id, new_id), parts in readers.items():
                old_port, new_port = self._outputs_before[old_id], self._outputs_after[new_id]
                for weakening in _find_weakenings(context.matched_ids, old_port, new_port):
                    causes = self._find_causes(leaf, new_port, weakening.key)
                    reason_text = f"{weakening.words.replace('{}', tick_name(old_id), 1)}; {{}} it"
                    yield from context.shared_losses(causes, parts, reason_text, "reads", weakening.category)

    @cached_property
    def _ports_before(self) -> Mapping[_Reading, Output]:
        return _index_readings(self._context.before, self._context.matched_ids)

    @cached_property
    def _ports_after(self) -> Mapping[_Reading, Output]:
        return _index_readings(self._context.after, MatchedIds())

    @cached_property
    def _outputs_before(self) -> Mapping[str, Output]:
        # Composed ones last: what is open of one has its id, and the same words.
        return {output.id: output for output in _list_outputs(self._context.before)}

    @cached_property
    def _outputs_after(self) -> Mapping[str, Output]:
        return {output.id: output for output in _list_outputs(self._context.after)}

    def _find_new_port(self, reader: str, leaf: str, new_leaf: str, old_port: Output | None) -> Output | None:
        """Return the port that a reader counts on now; if it reads no more, the one that it counted on before."""
        if (reader, new_leaf) in self._ports_after:
            return self._ports_after[reader, new_leaf]
        if old_port is None or old_port.id == self._context.old_id("output", leaf):
            return self._outputs_after.get(new_leaf)
        component_id, _, name = old_port.id.rpartition(".")
        common_id = f"{self._context.matched_ids.common_id('composed', component_id)}.{name}"
        return self._outputs_after.get(common_id) or self._outputs_after.get(new_leaf)

    def _find_causes(self, leaf: str, new_port: Output, key: str) -> list[int]:
        """Return the indices of the changes that say it: at the output, at the composed component, or what it passes on."""
        context = self._context
        group = key.partition(".")[0]
        shell, _, name = new_port.id.rpartition(".")
        for kind, element, beginning in (
            ("output", new_port.id, key),
            ("composed", shell, f"outputs.{name}:{key}"),
            ("output", leaf, key),
            ("output", new_port.id, group),
            ("composed", shell, f"outputs.{name}:{group}"),
        ):
            if indices := context.indices_below(kind, element, beginning):
                return indices
        return find_output_causes(context, leaf)


def _index_readings(architecture: Architecture, matched_ids: MatchedIds) -> dict[_Reading, Output]:
    readings: dict[_Reading, Output] = {}
    for counted in list_relied_outputs(architecture):
        if counted.reader.id in architecture.inputs:
            reading = (
                matched_ids.common_id("input", counted.reader.id),
                matched_ids.common_id("output", counted.leaf.id),
            )
            readings.setdefault(reading, counted.port)
    return readings


def _find_weakenings(matched_ids: MatchedIds, old: Output, new: Output) -> Iterator[_Weakening]:
    yield from _compare_promises(matched_ids, old.promise or Promise(), new.promise or Promise())
    yield from compare_lives(old, new)


def compare_lives(old: _Living, new: _Living) -> Iterator[_Weakening]:
    """Yield that something has another version, is deprecated now, or until an earlier day; `{}` stands for its name."""
    if old.version is not None and old.version != new.version:
        after = f"the version {tick_name(new.version)}" if new.version else "no version any more"
        yield _Weakening(f"gives {{}} {after} instead of {tick_name(old.version)}", "version", "meaning")
    yield from _compare_deprecations(old.deprecated, new.deprecated)


def _compare_deprecations(old: Deprecation | None, new: Deprecation | None) -> Iterator[_Weakening]:
    if new is None:
        return
    until = f"until {new.until}" if new.until else "without a day"
    instead = f", and names {tick_name(new.use)} instead" if new.use else ""
    if old is None:
        yield _Weakening(
            f"keeps {{}} {until} only{instead}" if new.until else f"deprecates {{}} {until}{instead}",
            "deprecated.until",
        )
    elif new.until and (old.until is None or new.until < old.until):
        before = f"instead of {old.until}" if old.until else "only"
        yield _Weakening(f"keeps {{}} {until} {before}", "deprecated.until")


def _compare_promises(matched_ids: MatchedIds, old: Promise, new: Promise) -> Iterator[_Weakening]:
    for key, noun in (("rate", "rate"), ("max_gap", "largest gap"), ("max_age", "greatest age")):
        before, after = getattr(old, key), getattr(new, key)
        if before is None:
            continue
        if after is None:
            yield _Weakening(f"promises for {{}} no {noun} any more (it was {before})", f"promise.{key}")
        elif (after.value < before.value) if key == "rate" else (after.value > before.value):
            yield _Weakening(f"promises for {{}} a {noun} of {after} instead of {before}", f"promise.{key}")
    if old.range is not None and (new.range is None or new.range[0] < old.range[0] or new.range[1] > old.range[1]):
        before = format_range(old.range, old.unit)
        if new.range is None:
            yield _Weakening(f"promises for {{}} no range any more (it was {before})", "promise.range")
        else:
            yield _Weakening(
                f"promises for {{}} values of {format_range(new.range, new.unit)} instead of {before}", "promise.range"
            )
    if old.unit is not None and new.unit != old.unit:
        after = f"in {tick_name(new.unit)}" if new.unit else "in no named unit"
        yield _Weakening(f"gives {{}} {after} instead of {tick_name(old.unit)}", "promise.unit", "meaning")
    if old.frame is not None and matched_ids.common_id("frame", old.frame) != new.frame:
        after = f"in the frame {tick_name(new.frame)}" if new.frame else "in no named frame"
        yield _Weakening(f"gives {{}} {after} instead of {tick_name(old.frame)}", "promise.frame", "meaning")
