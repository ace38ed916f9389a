"""Cards of all other kinds: the fields that an element has, and who uses it."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compare.kinds import PLAIN_KINDS
from archgen.language.language_tables import KEYS
from archgen.model.architecture import UseCase
from archgen.model.parameter import format_parameter
from archgen.model.requirement import Requirement, Verification
from archgen.views import requirement_servers, timing_words
from archgen.views.elements import promise_words
from archgen.views.elements.annotation_facts import (
    ElementCard,
    drop_empty_lists,
    format_fact,
    known_facts,
    list_finding_lines,
)
from archgen.views.elements.element_names import elements_by_kind
from archgen.views.elements.frame_users import list_frame_users
from archgen.views.elements.type_fields import list_field_lines
from archgen.views.lookup import Lookup
from archgen.views.requirement_servers import describe_chain_state
from archgen.views.sequences.sequence_charts import explain_total, list_step_lines

_CARD_KEYS = (
    *("message", "size", "comment", "description", "use_cases", "host", "cores", "address", "threads", "scheduling"),
    "discovery_server",
    *("connects", "devices", "owner", "protocol", "bandwidth", "frame", "parent", "by", "rate", "deadline", "show"),
    *("of", "without", "drop"),
)
"""One list of field names for all kinds that say which; those that an element lacks are empty and dropped."""


def make_use_case_card(lookup: Lookup, use_case: UseCase) -> ElementCard:
    """Make the card of a use case."""
    facts = [
        ("description", " ".join((use_case.description or "").split())),
        ("actors", ", ".join(f"{actor.id} ({actor.title})" for actor in use_case.actors.values())),
        ("time", explain_total(lookup, use_case.id)),
    ]
    requirement_ids = tuple(r.id for r in lookup.architecture.requirements.values() if use_case.id in r.use_cases)
    lists = (
        *drop_empty_lists(("steps", tuple(list_step_lines(lookup, use_case)))),
        ("requirements", requirement_ids),
        *drop_empty_lists(("findings", tuple(list_finding_lines(lookup, use_case.id)))),
    )
    return ElementCard("use case", use_case.id, use_case.title, use_case.at, known_facts(facts), lists)


def make_generic_card(lookup: Lookup, kind: str, element_id: str) -> ElementCard:
    """Make the card of a kind without a card of its own: fields that exist, and who uses the element."""
    architecture = lookup.architecture
    element = elements_by_kind(architecture)[kind][element_id]
    facts = [
        (
            key,
            lookup.format_size(element)
            if kind == "type" and key == "size"
            else format_fact(getattr(element, key, None)),
        )
        for key in ([key for key in KEYS[kind] if key != "title"] if kind in PLAIN_KINDS else _CARD_KEYS)
    ]
    lists: list[tuple[str, tuple[str, ...]]] = []
    if kind == "type":
        facts += promise_words.list_card_facts(element)
        facts += [("values", format_fact(element.values)), ("generic", format_fact(element.generic))]
        field_lines = tuple(list_field_lines(element))
        lists += [("fields", field_lines)] if field_lines else []
        lists.append(("produced by", tuple(output.id for output in lookup.outputs_of_type.get(element_id, ()))))
    elif kind == "requirement":
        requirement = architecture.requirements[element_id]
        facts += _list_requirement_facts(lookup, requirement)
        lists += _list_requirement_parts(lookup, requirement)
    elif kind == "partner":
        facts += [("contact", element.contact or ""), ("reviewers", ", ".join(element.reviewers))]
        ownable_elements = (
            ("groups", architecture.groups),
            ("components", architecture.components),
            ("nodes", architecture.nodes),
        )
        lists += [
            (kind, owned_ids)
            for kind, elements in ownable_elements
            if (owned_ids := tuple(item.id for item in elements.values() if element_id in item.owners))
        ]
    elif kind in {"host", "container"}:
        if kind == "host":
            facts.append(("scheduling", timing_words.format_core_orders(element)))
        else:
            is_named = element.name is not None or element.namespace != "/"
            facts += [
                ("ROS name", element.full_name if is_named else ""),
                ("package", element.package or ""),
                ("executable", element.executable or ""),
                ("parameters", format_parameter(element.parameters) if element.parameters else ""),
            ]
        # `kind` names the node's field here: `Node.host` or `Node.container`.
        lists.append(
            ("nodes", tuple(node.id for node in architecture.nodes.values() if getattr(node, kind) == element_id))
        )
    elif kind == "resource":
        lists.append(("used by", tuple(node.id for node in architecture.nodes_using(element_id))))
    elif kind == "frame":
        facts.append(("static", "yes" if element.static else ""))
        lists += list_frame_users(architecture, element)
    elif kind == "variant":
        lists.append(("changes", tuple(f"{change.path}: {change.value}" for change in element.changes)))
    elif kind == "chain":
        chain = architecture.chains[element_id]
        facts += [("state", describe_chain_state(lookup, chain)), ("requirements", "; ".join(chain.requirements))]
        lists.append(("through", tuple(point.id for point in chain.through)))
    return ElementCard(
        kind, element_id, getattr(element, "title", element_id), element.at, known_facts(facts), tuple(lists)
    )


def _list_requirement_facts(lookup: Lookup, requirement: Requirement) -> Iterator[tuple[str, str]]:
    """Yield the facts of a requirement by their keys; empty where nothing is known."""
    yield "state", lookup.requirement_trace.judge(requirement.id)
    yield "parent", ", ".join(requirement.parents)
    for key in ("kind", "priority", "rationale", "source"):
        yield key, " ".join((getattr(requirement, key) or "").split())
    yield "tags", ", ".join(requirement.tags)


def _list_requirement_parts(lookup: Lookup, requirement: Requirement) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the lists below a requirement's card: its parts, what serves it, what verifies it."""
    parts = lookup.requirement_trace.parts.get(requirement.id, ())
    if parts:
        yield "parts", tuple(_name_part(lookup, part) for part in parts)
    yield "served by", tuple(requirement_servers.list_server_words(lookup, requirement))
    verifiers = [_name_verification(lookup, each) for each in requirement.verified_by]
    verifiers += filter(None, [requirement_servers.describe_part_verification(lookup, requirement)])
    if verifiers or lookup.requirement_trace.is_verification_told:
        yield "verified by", tuple(verifiers)


def _name_part(lookup: Lookup, part_id: str) -> str:
    part = lookup.architecture.requirements[part_id]
    title = "" if part.title == part.id else f" {part.title}"
    return f"{part.id}{title} ({lookup.requirement_trace.judge(part_id)})"


def _name_verification(lookup: Lookup, verification: Verification) -> str:
    chain = lookup.architecture.chains.get(verification.text) if verification.kind == "chain" else None
    if chain:
        return f"the chain {requirement_servers.name_chain(lookup, chain)}"
    return f"the use case {verification.text}" if verification.kind == "use_case" else verification.text
