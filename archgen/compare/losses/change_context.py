"""Both versions with the changes between them: who changed what, and who owns it.

Outputs that live on under another id that no likeness explains: a component was split or merged, and the wire stayed.

What programs see are topics, messages and QoS. So an output that is new and offers all that a removed one offered is its
heir, however the diff presents it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from archgen.compare.comparison import Change
from archgen.compare.key_phrases import name_partner, shorten_text, tick_names
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.review_facts import ReviewFacts
from archgen.compare.version_pair import ElementKey, VersionPair
from archgen.diagnostics import Severity, join_words, order_naturally
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint
from archgen.model.project_settings import BreakCategory

Wire = frozenset[tuple[object, ...]]
"""What the nodes of an output offer: names, messages, QoS, and whether a program does so or only a plan."""


def find_wire_heirs(
    versions: VersionPair, architectures: tuple[Architecture, Architecture], matched_ids: MatchedIds
) -> Mapping[str, str]:
    """Return for each removed output that somebody read the new output on the same wire, if there is exactly one."""
    old_elements, new_elements = versions.elements_before, versions.elements_after
    # Only what is new: a topic that another output offered already loses one of its publishers.
    new_outputs = [element for key, element in new_elements.items() if key[0] == "output" and key not in old_elements]
    lost_outputs = [
        name for name in versions.connections_before.readers_by_output if versions.is_removed("output", name)
    ]
    if not (new_outputs and lost_outputs):
        return {}
    wires_before = _collect_wires(architectures[0], matched_ids)
    wires_after = _collect_wires(architectures[1], MatchedIds())
    heirs = {}
    for name in lost_outputs:
        wire: Wire = wires_before.get(name, frozenset())
        candidates = [
            each.id
            for each in new_outputs
            if all(old_elements["output", name].values.get(key) == each.values.get(key) for key in ("type", "medium"))
            and _continues_wire(name, wire, each.id, wires_after.get(each.id, frozenset()))
        ]
        if len(candidates) == 1:
            heirs[name] = candidates[0]
    return heirs


def _collect_wires(architecture: Architecture, matched_ids: MatchedIds) -> Mapping[str, Wire]:
    """Return the wire of each output of a written node, by common id."""
    wires: dict[str, set[tuple[object, ...]]] = {}
    for endpoint in architecture.endpoints:
        node = architecture.nodes[endpoint.node]
        if endpoint.use in {"publishes", "serves"} and endpoint.port and node.written:
            wire = wires.setdefault(matched_ids.common_id("output", endpoint.port), set())
            qos = endpoint.qos
            durations = [each and each.value for each in (qos.deadline, qos.lifespan, qos.lease_duration)]
            kept_qos = (qos.reliability, qos.durability, qos.history, qos.depth, qos.liveliness)
            is_planned = node.status == "planned"
            wire.add((endpoint.label, endpoint.flow, endpoint.message, *kept_qos, *durations, is_planned))
    return {port: frozenset(wire) for port, wire in wires.items()}


def _continues_wire(old_id: str, old_wire: Wire, new_id: str, new_wire: Wire) -> bool:
    if old_wire:
        # A program may take the place of a plan, but no plan that of a program.
        planned_wire = {(*offer[:-1], True) for offer in new_wire}
        return old_wire <= new_wire | planned_wire
    # Without a node there is no wire yet, and no program: then the name says what it is.
    return old_id.rpartition(".")[2] == new_id.rpartition(".")[2]


_MAX_NAMES = 4
"""Maximal number of elements named in one sentence; the rest is counted."""


def tick_name(name: object) -> str:
    """Return a name in backticks, whatever it contains."""
    return f"`{shorten_text(str(name))}`"


def tick_sorted_names(names: Iterable[str]) -> str:
    """Return sorted names in backticks, joined for a sentence: `a`, `b` and `c`; the surplus is counted."""
    return tick_names(sorted(names, key=order_naturally), _MAX_NAMES)


def _decline_verb(verb: str, *, plural: bool) -> str:
    """Return a verb for one or for several."""
    if not plural:
        return verb
    return "are" if verb == "is" else verb.removesuffix("s")


WRITING_USES = frozenset({"publishes", "serves"})


@dataclass(frozen=True, slots=True)
class PartnerLoss:
    """What a partner loses by the change at an index of `ChangeContext.changes`; the rest is that of `PartnerBreak`."""

    change_index: int
    partner: str
    reason: str
    category: BreakCategory = "wire"
    fallen: tuple[str, str] | None = None
    hash: str = ""
    at_most: Severity = Severity.ERROR


class LastingOutput(NamedTuple):
    """An output that is there in both versions, by its common id before and after: these differ if it has an heir."""

    id: str
    new_id: str
    inputs_by_partner: Mapping[str, list[str]]


@dataclass
class ChangeContext:
    """Both versions with their changes. Elements have their common ids; changes are known by their index at the top
    level.
    """

    before: Architecture
    after: Architecture
    matched_ids: MatchedIds
    versions: VersionPair
    changes: Sequence[Change]
    facts: ReviewFacts = field(default_factory=ReviewFacts)
    followers: Collection[int] | None = None
    """The changes, by identity, that only follow a component type; None where nobody asks whose edits they are."""
    _changes_by_key: dict[ElementKey, list[tuple[int, Change]]] = field(default_factory=lambda: defaultdict(list))

    def __post_init__(self) -> None:
        for index, change in enumerate(self.changes):
            for inner_change in self.walk_change(change):
                common_id = self.common_id(inner_change)
                self._changes_by_key[inner_change.element_kind, common_id].append((index, inner_change))
                if inner_change.element_kind == "port":
                    # A pseudo kind: what is said of the ports of a node is looked up by the node.
                    self._changes_by_key["ports of", common_id.partition(".")[0]].append((index, inner_change))

    def walk_change(self, change: Change) -> Iterator[Change]:
        """Yield a change and all its parts, at any depth."""
        yield change
        for part in change.parts:
            yield from self.walk_change(part)

    def common_id(self, change: Change) -> str:
        """Return the common id of the changed element, as `versions` has it."""
        if change.kind != "removed":
            return change.element_id
        return self.matched_ids.common_id(
            "input" if change.element_kind == "connection" else change.element_kind, change.element_id
        )

    def find_changes(self, kind: str, name: str) -> Sequence[tuple[int, Change]]:
        """Return the changes of an element, each with the index of the top-level change that contains it."""
        return self._changes_by_key.get((kind, name), ())

    def change_indices(self, kind: str, name: str, *keys: str) -> list[int]:
        """Return the indices of an element's changes: of the given keys, or all."""
        return self.list_indices(kind, name, lambda change: not keys or change.key in keys)

    def indices_by_change_kind(self, kind: str, name: str, *change_kinds: str) -> list[int]:
        """Return the indices of an element's changes of certain kinds ("removed", "renamed")."""
        return self.list_indices(kind, name, lambda change: change.kind in change_kinds)

    def indices_below(self, kind: str, name: str, beginning: str) -> list[int]:
        """Return the indices of an element's changes of the keys that begin so."""
        return self.list_indices(kind, name, lambda change: (change.key or "").startswith(beginning))

    def list_indices(self, kind: str, name: str, is_meant: Callable[[Change], bool]) -> list[int]:
        """Return the indices of those changes of an element that are meant, each once."""
        return list(dict.fromkeys(index for index, change in self.find_changes(kind, name) if is_meant(change)))

    def owners_of_change(self, change_index: int) -> frozenset[str]:
        """Return the partner who owns what changed, nobody if nobody owns it."""
        change = self.changes[change_index]
        if change.element_kind == "type":
            return frozenset()  # whom it breaks, those say who write what is of the type (`MessageUsers`)
        return self.lasting_owners(
            "input" if change.element_kind == "connection" else change.element_kind, self.common_id(change)
        )

    def lasting_owners(self, kind: str, name: str) -> frozenset[str]:
        """Return the partner who owns an element in all versions that have it.

        An element that changes hands is nobody's: otherwise naming a new owner would be enough to change it quietly.
        """
        owner_ids = {element.owner for element in self.versions.find_both(kind, name) if element}
        return frozenset(owner for owner in owner_ids if owner and len(owner_ids) == 1)

    def shared_losses(
        self,
        indices: Iterable[int],
        parts_by_partner: Mapping[str, Collection[str]],
        reason_template: str,
        verb: str,
        category: BreakCategory = "promise",
    ) -> Iterator[PartnerLoss]:
        """Yield one loss for each partner who does not own a change; the last `{}` of the template becomes
        their parts and `verb`.

        Most of what partners share are promises: deadlines, hosts, links.
        """
        # The last braces: what is quoted in front of them may have some of its own.
        lead, _, rest = reason_template.rpartition("{}")

        def write_reason(partners: Sequence[str]) -> str:
            phrases = [
                f"{tick_sorted_names(parts_by_partner[partner])} of {self.name_partner(partner)}"
                for partner in partners
            ]
            has_many = sum(len(parts_by_partner[partner]) for partner in partners) != 1
            return f"{lead}{join_words(phrases)} {_decline_verb(verb, plural=has_many)}{rest}"

        yield from self._losses_of_others(indices, parts_by_partner, write_reason, category)

    def losses_of_readers(
        self, indices: Iterable[int], parts_by_partner: Mapping[str, Collection[str]], lead: str, rest: str
    ) -> Iterator[PartnerLoss]:
        """Yield one loss for each partner who does not own a change: between `lead` and `rest` stand all of them with
        their parts, as those from whom something is taken.
        """

        def write_reason(partners: Sequence[str]) -> str:
            readers = [
                f"{self.name_partner(partner)} ({tick_sorted_names(parts_by_partner[partner])})" for partner in partners
            ]
            return f"{lead} {join_words(readers)}{rest}"

        yield from self._losses_of_others(indices, parts_by_partner, write_reason, "wire")

    def losses_of_users(
        self,
        indices: Iterable[int],
        partners: Iterable[str],
        reason_template: str,
        verb: str,
        category: BreakCategory = "wire",
    ) -> Iterator[PartnerLoss]:
        """Yield one loss for each partner who does not own a change; the last `{}` of the template becomes all of them
        and `verb`, if any.
        """
        lead, _, rest = reason_template.rpartition("{}")

        def write_reason(users: Sequence[str]) -> str:
            names = join_words([self.name_partner(user) for user in users])
            return f"{lead}{f'{names} {_decline_verb(verb, plural=len(users) != 1)}'.rstrip()}{rest}"

        yield from self._losses_of_others(indices, partners, write_reason, category)

    def _losses_of_others(
        self,
        indices: Iterable[int],
        partners: Iterable[str],
        write_reason: Callable[[Sequence[str]], str],
        category: BreakCategory,
    ) -> Iterator[PartnerLoss]:
        """Yield the losses by each change of the partners who do not own it, all with the same reason."""
        sorted_partners = sorted(partners, key=order_naturally)
        for change_index in indices:
            owners = self.owners_of_change(change_index)
            others = [partner for partner in sorted_partners if partner not in owners]
            reason_text = write_reason(others)
            yield from (PartnerLoss(change_index, partner, reason_text, category) for partner in others)

    def name_partner(self, partner: str) -> str:
        """Return what people call a partner."""
        return name_partner(partner, self.versions.partner_names)

    def owner_before(self, kind: str, name: str) -> str | None:
        """Return the partner who owned an element before the change; for a new element, who owns it."""
        # The first version decides: who loses something is who had it.
        return self.versions.find_owner(kind, name)

    def needs_source(self, input_id: str) -> bool:
        """Whether an input existed before the change and was not optional.

        The second version is not asked: otherwise a branch could take the reader away, or make it optional, together
        with what it reads (docs/decisions/0007-breaking-changes.md).
        """
        element = self.versions.elements_before.get(("input", input_id))
        return element is not None and not element.values.get("optional")

    def old_id(self, kind: str, name: str) -> str:
        """Return the id that an element had before the change."""
        element = self.versions.elements_before.get((kind, name))
        return element.own_id if element else name

    @cached_property
    def offered_endpoints(
        self,
    ) -> tuple[Mapping[tuple[str, str], list[Endpoint]], Mapping[tuple[str, str], list[Endpoint]]]:
        """Return what written nodes publish and serve, before and after, by common node and port ("" for internal
        ones).
        """
        old_endpoints = self._collect_offered(self.before, self.matched_ids)
        # Where a program was, a plan offers nothing. What was only planned all along is held against its plan.
        real_keys = {
            key
            for (node_id, port), ends in old_endpoints.items()
            for key in (node_id, port)
            if any(self.before.nodes[end.node].status != "planned" for end in ends)
        }
        # What stands in a part that could not be read offers what it offered.
        unread_endpoints = {
            key: ends for key, ends in old_endpoints.items() if self.versions.may_be_unread(("node", key[0]))
        }
        return old_endpoints, unread_endpoints | {
            (node_id, port): ends
            for (node_id, port), ends in self._collect_offered(self.after, MatchedIds()).items()
            if self.after.nodes[node_id].status != "planned" or real_keys.isdisjoint({node_id, port} - {""})
        }

    def _collect_offered(
        self, architecture: Architecture, matched_ids: MatchedIds
    ) -> Mapping[tuple[str, str], list[Endpoint]]:
        endpoints: dict[tuple[str, str], list[Endpoint]] = defaultdict(list)
        for endpoint in architecture.endpoints:
            if endpoint.use in WRITING_USES and architecture.nodes[endpoint.node].written:
                port = matched_ids.common_id("output", endpoint.port) if endpoint.port else ""
                endpoints[matched_ids.common_id("node", endpoint.node), port].append(endpoint)
        return endpoints

    def find_new_ends(self, end: Endpoint) -> Sequence[Endpoint]:
        """Return what took the place of an end: at its node, else at the port's node, under its name if there is one."""
        port = self.common_port(end)
        found = self._new_ends.get((self.matched_ids.common_id("node", end.node), port), ())
        if not found and end.port:
            found = self._new_ends.get(("", self.output_heirs.get(port, port)), ())
        return [each for each in found if each.name == end.name] or found

    def common_port(self, end: Endpoint) -> str:
        """Return the common id of the port of an end of the first version, its name where it has none."""
        kind = "output" if end.use in WRITING_USES else "input"
        return self.matched_ids.common_id(kind, end.port) if end.port else end.label

    @cached_property
    def _new_ends(self) -> Mapping[tuple[str, str], list[Endpoint]]:
        """Return the ends of written nodes by node and port (a topic's name for internal ones), and by the port alone."""
        ends: dict[tuple[str, str], list[Endpoint]] = defaultdict(list)
        for end in self.after.endpoints:
            if self.after.nodes[end.node].written:
                ends[end.node, end.port or end.label].append(end)
                if end.port:
                    ends["", end.port].append(end)
        return ends

    @property
    def guards_margins(self) -> bool:
        """Whether a promise breaks as soon as it is weaker, though all that is asked of it is still kept."""
        return self.before.review.guards_margins or self.after.review.guards_margins

    @cached_property
    def output_heirs(self) -> Mapping[str, str]:
        """Return the removed outputs that live on as new ones on the same wire, with the ids of these."""
        return find_wire_heirs(self.versions, (self.before, self.after), self.matched_ids)

    @cached_property
    def lasting_outputs(self) -> Sequence[LastingOutput]:
        """Return the outputs that partners other than their owner needed, and that are still there or have an heir."""
        outputs = (
            LastingOutput(output, self.output_heirs.get(output, output), self.foreign_readers(output, readers))
            for output, readers in sorted(self.versions.connections_before.readers_by_output.items())
        )
        return [
            output
            for output in outputs
            if output.inputs_by_partner and ("output", output.new_id) in self.versions.elements_after
        ]

    def foreign_readers(self, output_id: str, readers: Iterable[str]) -> Mapping[str, list[str]]:
        """Return those of the inputs that needed an output, by partner, without the partner who owns the output."""
        lasting_owners = self.lasting_owners("output", output_id)
        inputs_by_partner = sorted(self.group_readers(readers).items())
        return {partner: inputs for partner, inputs in inputs_by_partner if partner not in lasting_owners}

    def group_readers(self, readers: Iterable[str]) -> Mapping[str, list[str]]:
        """Return those of some inputs that needed what they read, by partner."""
        inputs_by_partner: dict[str, list[str]] = defaultdict(list)
        for reader in sorted(filter(self.needs_source, readers)):
            partner = self.owner_before("input", reader)
            if partner:
                inputs_by_partner[partner].append(reader)
        return inputs_by_partner

    def port_change_indices(self, node_id: str, port_id: str, *keys: str) -> list[int]:
        """Return the indices of changes of what a node says of a component's port, or of its internal ones if `port` is
        empty.
        """

        def is_meant(change: Change) -> bool:
            name = self.common_id(change)
            element = self.versions.find_latest("port", name)
            component_refs = element.component_refs if element else ()
            is_asked_port = port_id in component_refs if port_id else name.startswith(f"{node_id}.internal.")
            return is_asked_port and (not keys or change.key in keys or change.kind != "changed")

        return self.list_indices("ports of", node_id, is_meant)
