"""Outputs whose owner promises less than before: slower, with longer gaps, only on condition; and edits of what belongs to
somebody else.

Only what is written is a promise. A rate that follows from other components concerns its readers, and breaks nobody. What
takes only from the margin (a lower rate, more jitter), while all that is asked of it is still kept, breaks where the
project gives promises a severity of their own.

Of an edit the element's owner counts, whatever file it stands in, and what is written, not what follows from it: a
reference that goes with a rename, an instance that changes with its type, a connection that nobody wrote.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property

from archgen.compare.agreements import find_partner_id
from archgen.compare.comparison import Change
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss, tick_name, tick_sorted_names
from archgen.compare.losses.changed_definitions import MessageUsers
from archgen.compare.losses.lost_connections import find_output_causes
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.version_pair import ComparedElement, ElementKey
from archgen.diagnostics import Severity, join_words
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.declared_timing import OutputTiming, Timing
from archgen.model.project_settings import agreement_file
from archgen.model.quantity import Quantity
from archgen.timing.figures.figure_wording import format_duration, format_rate

_NS_PER_SECOND = 10**9


class OutputPromise(NamedTuple):
    """What the owner of an output says of when it is sent, all its nodes together; rate in Hz, durations in ns."""

    rate: Fraction | None
    is_steady: bool
    gap: Fraction | None
    every: int
    throttle: Fraction
    jitter: Fraction | None
    response: Fraction | None
    is_conditional: bool


class Weakening(NamedTuple):
    """What is promised less: in words, and the ends of the keys that may say it, most likely first.

    `is_margin`: nothing that is asked of it need suffer. `period` (ns) is the new one, where a lower rate is what is less.
    """

    words: str
    keys: tuple[str, ...]
    is_margin: bool = False
    period: Fraction | None = None


_SharedWeakening = tuple[tuple[int, ...], str]
"""The indices of the changes, and the words: one slower component is one loss, however many outputs it has."""


def find_weakened_outputs(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find outputs of which partners were promised more than now."""
    old_version, new_version = _PromisedOutputs(context.before), _PromisedOutputs(context.after)
    outputs: dict[_SharedWeakening, dict[str, Mapping[str, list[str]]]] = defaultdict(dict)
    for output, new_output, inputs_by_partner in context.lasting_outputs:
        old_id = context.old_id("output", output)
        old_promise, new_promise = old_version.read_promise(old_id), new_version.read_promise(new_output)
        # Of what could not be read nobody knows what it promises.
        if old_promise == new_promise or (new_promise.rate is None and context.after.unread_keys):
            continue
        for weakening in _compare_promises(old_promise, new_promise):
            losers = inputs_by_partner
            if weakening.is_margin and not context.guards_margins:
                askers = _find_askers(context, old_id, old_promise.rate, weakening.period)
                losers = {partner: inputs for partner, inputs in inputs_by_partner.items() if partner in askers}
            if losers:
                indices = tuple(_find_causes(context, output, new_output, weakening.keys))
                outputs[indices, weakening.words][old_id] = losers
    for (indices, words), readers_by_output in outputs.items():
        parts: dict[str, list[str]] = defaultdict(list)
        for inputs_by_partner in readers_by_output.values():
            for partner, inputs in inputs_by_partner.items():
                parts[partner] += inputs
        pronoun = "it" if len(readers_by_output) == 1 else "them"
        reason_text = f"promises for {tick_sorted_names(readers_by_output)} {words}; {{}} {pronoun}"
        yield from context.shared_losses(indices, parts, reason_text, "reads")


def _find_askers(
    context: ChangeContext, output_id: str, old_rate: Fraction | None, new_period: Fraction | None
) -> frozenset[str]:
    """Return the partners whose subscriptions ask for a message more often than it comes now, and got it before."""
    if not old_rate or new_period is None:
        return frozenset()
    old_period = Fraction(_NS_PER_SECOND) / old_rate
    return frozenset(
        context.matched_ids.common_id("partner", owner)
        for endpoint in context.before.endpoints
        if endpoint.use == "subscribes" and output_id in endpoint.sources
        if endpoint.qos.deadline is not None and old_period <= endpoint.qos.deadline.value < new_period
        if (owner := context.before.nodes[endpoint.node].owner) is not None
    )


class _PromisedOutputs:
    """The promises of one version."""

    def __init__(self, architecture: Architecture) -> None:
        self._architecture = architecture

    @cached_property
    def _nodes_by_output(self) -> Mapping[str, Sequence[str]]:
        nodes: dict[str, list[str]] = defaultdict(list)
        for endpoint in self._architecture.endpoints:
            if endpoint.port and endpoint.use in {"publishes", "serves"}:
                nodes[endpoint.port].append(endpoint.node)
        return nodes

    def read_promise(self, output_id: str) -> OutputPromise:
        """Return what is written of an output, whether its component says it or its nodes."""
        component_id = output_id.rpartition(".")[0]
        own_timing = self._architecture.components[component_id].timing or Timing()
        node_ids = dict.fromkeys(self._nodes_by_output.get(output_id, ()))
        nodes = [self._architecture.nodes[node_id] for node_id in node_ids]
        timings = [node.timing.get(component_id) or own_timing for node in nodes] or [own_timing]
        outputs = [timing.outputs.get(output_id, OutputTiming()) for timing in timings]
        rates = [_effective_rate(timing) for timing in timings]
        return OutputPromise(
            rate=sum((rate for rate in rates if rate), Fraction(0)) if all(rates) else None,
            is_steady=all(timing.behaviour in {None, "periodic"} for timing in timings),
            gap=_find_largest(output.max_gap for output in outputs),
            every=max(timing.every or 1 for timing in timings),
            throttle=_find_largest(timing.throttle for timing in timings) or Fraction(0),
            jitter=_find_largest(timing.jitter for timing in timings),
            response=_find_largest(timing.response for timing in timings),
            is_conditional=any(output.conditional for output in outputs),
        )


def _effective_rate(timing: Timing) -> Fraction | None:
    if timing.period is not None and timing.period.value:
        return Fraction(_NS_PER_SECOND) / timing.period.value
    return timing.rate.value if timing.rate else None


def _find_largest(quantities: Iterable[Quantity | None]) -> Fraction | None:
    return max((Fraction(quantity.value) for quantity in quantities if quantity is not None), default=None)


def _compare_promises(old: OutputPromise, new: OutputPromise) -> Iterator[Weakening]:
    """Yield what is weaker in the second promise."""
    if old.rate and (new.rate is None or new.rate < old.rate):
        words = (
            f"{format_rate(new.rate)} instead of {format_rate(old.rate)}"
            if new.rate
            else f"no rate any more (it was {format_rate(old.rate)})"
        )
        period = Fraction(_NS_PER_SECOND) / new.rate if new.rate else None
        yield Weakening(words, (".rate", ".behaviour"), new.rate is not None, period)
    if old.rate and old.is_steady and new.rate and not new.is_steady:
        yield Weakening("no steady rate any more, but messages when something makes it run", (".behaviour",))
    if new.is_conditional and not old.is_conditional:
        yield Weakening("messages only on condition, no longer at each run", (".conditional",))
    old_gap = old.gap
    if old.rate and new.gap and not (old_gap or old.is_conditional):
        # Where no gap was written, each run sends something. A run may come late; a longer gap leaves one out.
        old_gap = 2 * Fraction(_NS_PER_SECOND) / old.rate
    if old_gap and (new.gap or old_gap) > old_gap:
        yield Weakening(
            f"gaps of {format_duration(new.gap or old_gap)} instead of {format_duration(old_gap)}", (".max_gap",)
        )
    if old.gap and new.gap is None and (new.is_conditional or not new.rate):
        yield Weakening(f"no longest gap any more (it was {format_duration(old.gap)})", (".max_gap",))
    if new.every > old.every:
        yield Weakening(f"a message for {new.every} arrivals instead of {old.every}", (".every",), is_margin=True)
    if new.throttle > old.throttle:
        yield Weakening(f"at most a message in {format_duration(new.throttle)}", (".throttle",), is_margin=True)
    yield from _compare_durations("jitter", old.jitter, new.jitter)
    yield from _compare_durations("response", old.response, new.response)


def _compare_durations(name: str, before: Fraction | None, after: Fraction | None) -> Iterator[Weakening]:
    """Yield a duration that grew. One that was not written, or is not any more, is only unknown."""
    if before is not None and after is not None and after > before:
        noun = {"jitter": "a jitter", "response": "a response time"}[name]
        words = f"{noun} of {format_duration(after)} instead of {format_duration(before)}"
        yield Weakening(words, (f".{name}",), is_margin=True)


def _find_causes(context: ChangeContext, old_output: str, new_output: str, keys: tuple[str, ...]) -> list[int]:
    """Return the indices of the changes that weakened a promise: of its key, else of its nodes, or of the output."""
    if old_output != new_output:
        return find_output_causes(context, old_output)
    component = new_output.rpartition(".")[0]
    nodes = {
        name
        for elements in context.versions.elements
        for (kind, name), element in elements.items()
        if kind == "node" and component in element.component_refs
    }
    elements = [("component", component), *(("node", name) for name in sorted(nodes))]
    output_part = f".outputs.{new_output.rpartition('.')[2]}." if keys[0] in {".conditional", ".max_gap"} else ""
    for ending in keys:
        indices = [
            index
            for kind, name in elements
            for index, change in context.find_changes(kind, name)
            if change.key and change.key.endswith(ending) and output_part in change.key
        ]
        if indices:
            return list(dict.fromkeys(indices))
    # A node that came or went, or that carries something else now.
    return list(dict.fromkeys(index for kind, name in elements for index in context.change_indices(kind, name)))


def find_weakened_sizes(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find types whose written size grew, or is no longer written: where promises have a severity of their own."""
    if not context.guards_margins:
        return
    changes = [
        (index, change)
        for index, change in enumerate(context.changes)
        if (change.element_kind, change.kind, change.key) == ("type", "changed", "size") and change.before is not None
    ]
    users = MessageUsers(context) if changes else None
    for index, change in changes:
        old_size, new_size = map(_read_size, context.versions.find_both("type", change.element_id))
        if old_size is not None and (new_size is None or new_size > old_size):
            promise = (
                f"{change.after} instead of {change.before}"
                if change.after
                else f"no size any more (it was {change.before})"
            )
            partners = users.partners_using_type(change.element_id) if users else []
            reason_text = f"promises for {tick_name(change.element_id)} {promise}; {{}} it"
            yield from context.losses_of_users([index], partners, reason_text, "uses", "promise")


def _read_size(element: ComparedElement | None) -> Fraction | None:
    value = element.values.get("size") if element else None
    return Fraction(value.value) if isinstance(value, Quantity) else None


_AGREEMENT_KEYS = "review.accepted."


class _OwnedEdit(NamedTuple):
    """What an edit changes of one element: who owned it before, the one who answers for it first; nobody's: nobody."""

    change_index: int
    owners: tuple[str, ...]


def find_foreign_edits(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find the edits of elements of partners for whom their author does not stand.

    Where all that is changed belongs to one partner, and nobody can say who did it, that is a warning.
    """
    if context.followers is None or context.facts.is_decided:
        return
    edits = list(_list_edits(context))
    standing = {
        owner: context.facts.stands_for(find_partner_id(owner, context.matched_ids), context.before.partners)
        for owner in sorted({owner for edit in edits for owner in edit.owners})
    }
    everywhere = set(standing).intersection(*(edit.owners for edit in edits))
    losses: dict[PartnerLoss, None] = {}
    for edit in edits:
        if edit.owners and not any(standing[owner] for owner in edit.owners):
            may_be_own = any(standing[owner] is None for owner in everywhere.intersection(edit.owners))
            partner = _choose_partner(edit, context)
            reason = _describe_reason(partner, context, may_be_own=may_be_own)
            severity = Severity.WARNING if may_be_own else Severity.ERROR
            losses[PartnerLoss(edit.change_index, partner, reason, "foreign", at_most=severity)] = None
    yield from losses


def _describe_reason(partner: str, context: ChangeContext, *, may_be_own: bool) -> str:
    name = context.name_partner(partner)
    lead = f"edits what belongs to {name}"
    if may_be_own:
        return f"{lead}, and nobody can say whether the author stands for {name}"
    people = sorted({min(author) for author in context.facts.requesters or context.facts.authors if author})
    return f"{lead}, for whom {join_words([f'`{each}`' for each in people]) or 'the author'} does not stand"


def _choose_partner(edit: _OwnedEdit, context: ChangeContext) -> str:
    """Return the owner who said something of an edit, else the first one: one of several suffices."""
    change = context.changes[edit.change_index]
    files = {entry.at.file for entry in context.after.review.accepted if entry.element == change.element_id}
    speakers = [each for each in edit.owners if agreement_file(find_partner_id(each, context.matched_ids)) in files]
    return (speakers or edit.owners)[0]


def _list_edits(context: ChangeContext) -> Iterator[_OwnedEdit]:
    """Yield what is edited of each element that was there before; what is new in nobody's is no edit."""
    for index, change in enumerate(context.changes):
        if id(change) in (context.followers or ()) or (change.key or "").startswith(_AGREEMENT_KEYS):
            continue
        if change.element_kind == "connection":
            if _is_written(change, context):
                yield _OwnedEdit(index, _list_owners(("input", context.common_id(change)), context))
            continue
        for each in context.walk_change(change):
            if each.element_kind != "connection":
                for key in _find_edited(each, context):
                    owners = _list_owners(key, context)
                    if owners or each.kind != "added":
                        yield _OwnedEdit(index, owners)


def _find_edited(change: Change, context: ChangeContext) -> Iterator[ElementKey]:
    """Yield the elements that a change edits: itself, and in which something new stands, or something moved."""
    key = (change.element_kind, context.common_id(change))
    is_new = key not in context.versions.elements_before
    if not is_new:
        yield key
    element = context.versions.elements_after.get(key)
    # A port of which a node said nothing before is new, too.
    if element and (is_new or change.kind == "moved"):
        holders = [element.parent_key] if element.parent_key else []
        if element.kind == "node":
            holders += (("component", each) for each in element.component_refs)
        yield from (each for each in holders if each in context.versions.elements_before)


def _list_owners(key: ElementKey, context: ChangeContext) -> tuple[str, ...]:
    """Return who owned an element before the change, first who answers for it; of what is in another element, the owners
    of that, and of a node those of its components.
    """
    elements = context.versions.elements_before
    element = elements.get(key)
    if element and element.kind == "message" and element.file:
        # Its fields stand at a type, and belong to who owns that.
        types = [key for key, each in elements.items() if key[0] == "type" and each.values.get("message") == element.id]
        return tuple(owner for each in types for owner in _list_owners(each, context))
    if element is None or not element.owner:
        return ()
    co_owners = element.values.get("co_owners")
    owners = [element.owner, *(sorted(co_owners) if isinstance(co_owners, frozenset) else ())]
    holders = [element.parent_key] if element.kind in {"input", "output", "port"} else []
    holders += (("component", each) for each in element.component_refs if element.kind == "node")
    for holder in holders:
        holder_owners = _list_owners(holder, context) if holder else ()
        # A node may belong to somebody else than its component.
        owners += holder_owners if element.owner in holder_owners else ()
    return tuple(dict.fromkeys(owners))


def _is_written(change: Change, context: ChangeContext) -> bool:
    """Whether somebody wrote another source of an input, and not only what lives on elsewhere under its new name."""
    input_id = context.common_id(change)
    before = _list_written_sources(context.before, context.old_id("input", input_id), context.matched_ids)
    after = _list_written_sources(context.after, input_id, MatchedIds())
    return {context.output_heirs.get(each, each) for each in before} != after


def _list_written_sources(architecture: Architecture, input_id: str, matched_ids: MatchedIds) -> set[str]:
    """Return what an input names as its sources, by common ids."""
    port = architecture.inputs.get(input_id)
    return {
        matched_ids.common_id(connection.kind, connection.target)
        for connection in (port.connections if port else ())
        if not connection.is_made
    }
