"""The terms of an interface as plain text, under the ids by which two revisions are compared.

Which element is which is the comparison's answer (`compare.match_elements`), so that `diff` and an agreement never
disagree about a rename. Most terms are derived (rates, gaps, chains) and no element has them: their texts are compared.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping

from archgen.compare.matched_ids import MatchedIds
from archgen.frozen import dataclass, field
from archgen.model.agreed_terms import INTERFACE_TERMS
from archgen.timing.analysis import ChainResult
from archgen.timing.figures.figure_wording import format_duration
from archgen.views.agreement.interface_terms import InterfaceEnd, InterfaceTerms
from archgen.views.agreement.promise_rows import MAX_GAP, RATE, PromiseRow, PromiseStrength
from archgen.views.graphs.element_boxes import join_owner_titles
from archgen.views.inline_text import join_runs
from archgen.views.lookup import Lookup
from archgen.views.timing import value_format

_NODE_TERMS = {RATE.key, MAX_GAP.key, "response"}
"""Keys of terms that stay the same where their node is renamed."""
CONTRADICTION_KIND = "contradictions"
_FIGURE = re.compile(r"(?<![0-9])[0-9]++(?:\.[0-9]++)? [A-Za-z]+")


@dataclass(frozen=True, slots=True)
class PlainTerm:
    """A term for comparing: `kind` sums it up in a word or two, `name` and `text` are shown.

    `identity` is the text with the ids of the later revision: terms with one identity mean the same. `is_expected` is
    what nobody promises; `strength` is how much is promised.
    """

    kind: str
    name: str
    text: str
    identity: str
    is_expected: bool = False
    strength: PromiseStrength = field(default_factory=dict)


def list_plain_terms(
    lookup: Lookup, interface_terms: InterfaceTerms, matched_ids: MatchedIds
) -> Mapping[str, PlainTerm]:
    """Return the terms by a key that survives new titles and ids. For the later revision no ids are matched."""
    terms = {"": _unchanged_term("title", "Title", interface_terms.title)}
    terms |= _fact_terms(interface_terms, matched_ids)
    for promise_row in interface_terms.promise_rows:
        terms |= _promise_terms(promise_row, matched_ids)
    terms |= dict(_end_term(lookup, end, matched_ids) for end in interface_terms.ends)
    for row in interface_terms.field_rows or ():
        terms[f"field {row.path}"] = _unchanged_term("fields", f"Field {row.path}", row.terms)
    for chain in interface_terms.chains:
        title = lookup.architecture.chains[chain.id].title
        terms |= _chain_terms(chain, title, matched_ids.common_id("chain", chain.id))
    terms |= list_contradictions(interface_terms.contradictions, "Contradiction", matched_ids)
    for requirement_runs in interface_terms.requirements:
        requirement = requirement_runs[0].text
        key = f"requirement {matched_ids.common_id('requirement', requirement)}"
        text = join_runs(requirement_runs[1:]).strip()
        # Without the titles of the components, which are muted.
        identity = join_runs(tuple(run for run in requirement_runs[1:] if not run.muted))
        terms[key] = PlainTerm("requirements", f"Requirement {requirement}", text, identity)
    for name, words in interface_terms.agreed.items():
        text = " ".join(words.split())
        terms[f"agreed {name}"] = _unchanged_term("agreed words", INTERFACE_TERMS[name], text)
    return terms


def _unchanged_term(kind: str, name: str, text: str) -> PlainTerm:
    """Return a term without ids in its text."""
    return PlainTerm(kind, name, text, text)


def list_contradictions(sentences: Iterable[str], name: str, matched_ids: MatchedIds) -> Mapping[str, PlainTerm]:
    """Return contradictions, or what is not shown to be none, as terms."""
    # Another figure in it makes no other contradiction, nor does it that there is none, or who reads the oldest.
    return {
        f"contradiction {_FIGURE.sub('', matched_ids.rename_in_text(sentence)).partition(': ')[0]}": PlainTerm(
            CONTRADICTION_KIND, name, sentence.replace("`", ""), ""
        )
        for sentence in sentences
    }


def _fact_terms(interface_terms: InterfaceTerms, matched_ids: MatchedIds) -> Iterator[tuple[str, PlainTerm]]:
    interface = interface_terms.interface
    for key, title, value in interface_terms.facts:
        text = join_runs(value)
        identity = text
        if key == "type" and interface.type:
            identity = matched_ids.common_id("type", interface.type)
        elif key == "message" and interface.message:
            identity = text.replace(interface.message, matched_ids.common_id("message", interface.message), 1)
        elif key == "launch":
            identity = matched_ids.rename_in_text(text)
        elif key == "meaning":
            identity = " ".join(text.split())
        elif key == "other_readers":
            other_ids = {matched_ids.common_id("component", port.component) for port in interface.other_inputs}
            identity = ", ".join(sorted(other_ids))
        # Who else reads it binds neither of the two.
        yield key or title, PlainTerm(title.lower(), title, text, identity, is_expected=key == "other_readers")


def _promise_terms(row: PromiseRow, matched_ids: MatchedIds) -> Iterator[tuple[str, PlainTerm]]:
    node = row.name.node
    if node and row.name.key in _NODE_TERMS:
        node = matched_ids.common_id("node", node)
    key = f"{row.name.title} of {node}"
    name, kind = row.name.text, row.name.words
    if row.promised:
        text = join_runs(row.promised)
        identity = row.promise_identity or text
        yield f"promised {key}", PlainTerm(kind, f"{name} (promised)", text, identity, strength=row.strength)
    if row.expected:
        # "follows from the rate of NODE". A topic that is called after a renamed component is not treated so: whoever
        # subscribes to it has to follow.
        text = join_runs(row.expected)
        identity = matched_ids.rename_in_text(text)
        yield f"expected {key}", PlainTerm(kind, f"{name} (expected)", text, identity, is_expected=True)


def _end_term(lookup: Lookup, end: InterfaceEnd, matched_ids: MatchedIds) -> tuple[str, PlainTerm]:
    component_id = port_id = ""
    if end.component:
        component_id = matched_ids.common_id("component", end.component.id)
        port_kind = "input" if end.is_taker else "output"
        port_id = matched_ids.common_id(port_kind, f"{end.component.id}.{end.port}") if end.port else ""
    node_id = matched_ids.common_id("node", end.node) if end.node else ""
    name = f"{end.component.title} · {end.port}" if end.component else ""
    if end.node:
        name = f"{name} (node {end.node})" if name else f"Node {end.node}"
    # What is offered is a term of its own ("QoS offered").
    qos, qos_identity = (end.qos, end.qos_identity) if end.is_taker else ("", "")
    owner_ids = ", ".join(matched_ids.common_id("partner", owner) for owner in end.owners)
    text, identity = (
        "; ".join(filter(None, parts))
        for parts in (
            (end.role, join_owner_titles(lookup, end.owners), qos),
            (end.role, owner_ids, qos_identity),
        )
    )
    key = f"end {component_id} {port_id} {end.is_taker} {node_id}"
    return key, PlainTerm("who gives and takes", name, text, identity)


def _chain_terms(chain: ChainResult, title: str, common_id: str) -> Iterator[tuple[str, PlainTerm]]:
    """Yield the deadline of a chain, which is promised, and its bound, which is expected."""
    if chain.deadline and chain.deadline.value is not None:
        limit = value_format.display_duration(chain.deadline)
        text = f"{limit}, {chain.verdict}" if chain.verdict in {"missed", "not proven"} else limit
        strength: PromiseStrength = {
            "deadline": -chain.deadline.value,
            "in time": int(chain.verdict not in {"missed", "not proven"}),
        }
        yield f"deadline {common_id}", PlainTerm("chains", f"Deadline of {title}", text, limit, strength=strength)
    for each in chain.shares:
        limit, name = format_duration(each.limit), f"Deadline of {title} for {each.name} of its reactions"
        yield (
            f"deadline {common_id} {each.name}",
            PlainTerm("chains", name, limit, limit, strength={"deadline": -each.limit}),
        )
    text = f"{value_format.display_duration(chain.bound)}; {chain.verdict}"
    yield f"chain {common_id}", PlainTerm("chains", f"Chain {title} (expected)", text, text, is_expected=True)
