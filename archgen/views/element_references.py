"""The page that a name leads to, and who owns what a finding is about."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.diagnostics import Diagnostic, Span
from archgen.language.language_tables import SECTION_KINDS
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.message_types import full_message_name
from archgen.timing.chains.chain_advice import find_deciding_term
from archgen.views import inline_text
from archgen.views.lookup import Lookup
from archgen.views.shapes import Inlines, Text, split_anchor

_SHARED_IDS = ("component_type", "node", "group", "requirement", "chain")
"""Kinds that are meant by an id which others share, in this order."""
_LAST_KINDS = frozenset({"type", "partner"})
"""Kinds that are meant by an id only where no other is."""
_PLACELESS_SECTIONS = frozenset({"libraries", "properties", "policies", "views", "resources"})
"""Sections whose elements have no place of their own on the site."""
_OTHER_KINDS = [
    kind
    for section, kind in SECTION_KINDS.items()
    if section not in _PLACELESS_SECTIONS and kind not in {*_SHARED_IDS, *_LAST_KINDS}
]
_REFERABLE_KINDS = (*_SHARED_IDS, *_OTHER_KINDS, *sorted(_LAST_KINDS, reverse=True))


def find_reference(architecture: Architecture, name: str) -> str | None:
    """Return the anchor of the element with this id; of a port that of its component. None for a name of nothing."""
    for kind, elements in _list_referable(architecture):
        if name in elements:
            return f"{kind}:{name}"
    port = architecture.inputs.get(name) or architecture.outputs.get(name)
    if port:
        return f"component:{port.component}"
    if shell := _find_shell(architecture, name):
        return f"component:{shell.id}"
    # A short name is none: `my_group/Part` may be anything.
    return f"message:{name}" if full_message_name(name) == name else None


def _list_referable(architecture: Architecture) -> Iterator[tuple[str, Mapping[str, object]]]:
    """Yield elements by kind, in the order in which an id that several kinds share is found."""
    sections = {kind: section for section, kind in SECTION_KINDS.items()}
    yield "component", architecture.components
    yield "component", architecture.shells
    for kind in _REFERABLE_KINDS:
        yield kind, getattr(architecture, sections[kind])
    yield "topic", architecture.topics
    yield "channel", architecture.channels


def _find_shell(architecture: Architecture, port_id: str) -> Component | None:
    """Return the composed component that a port belongs to."""
    holder, _, name = port_id.rpartition(".")
    shell = architecture.shells.get(holder)
    return shell if shell and (name in shell.inputs or name in shell.outputs) else None


def message_link(message: str) -> Text:
    """Link to a message, service or action, by its full name."""
    return Text(message, ref=f"message:{message}", code=True)


def find_owners(architecture: Architecture, element_id: str | None) -> tuple[str, ...]:
    """Return the partners who own an element; of a port those of its component. Empty where nobody does."""
    name = element_id or ""
    port = architecture.inputs.get(name) or architecture.outputs.get(name)
    component = architecture.components.get(port.component if port else name)
    component = component or architecture.shells.get(name) or _find_shell(architecture, name)
    element = component or architecture.nodes.get(name) or architecture.groups.get(name)
    link = architecture.links.get(name)
    return element.owners if element else link.owners if link else ()


def answering_cell(lookup: Lookup, element_id: str | None, place: Span) -> Inlines:
    """Return links to the partners who have to act on what is said of an element at a place; where nobody can be named,
    the question that decides it. Empty in a project without partners.
    """
    architecture, name = lookup.architecture, element_id or ""
    if not architecture.partners:
        return ()
    if owners := find_answering(lookup, name, place):
        return inline_text.owner_links(architecture, owners)
    reference = find_reference(architecture, name) if name else None
    what = f"the {split_anchor(reference)[0].replace('_', ' ')} {name}" if reference else place.file or "this"
    return (Text(f"who answers for {what}?", muted=True),)


def find_answering(lookup: Lookup, name: str, place: Span) -> tuple[str, ...]:
    """Return the partners who have to act on what is said of an element at a place; empty where nobody can be named."""
    architecture = lookup.architecture
    for owners in (
        find_owners(architecture, name),
        _find_concerned(lookup, name),
        _find_file_owners(architecture, place.file),
        tuple(architecture.partners) if len(architecture.partners) == 1 else (),
    ):
        if owners:
            return tuple(dict.fromkeys(owners))
    return ()


def _find_concerned(lookup: Lookup, name: str) -> tuple[str, ...]:
    """Return who has to act on an element that nobody owns: who takes most of a chain's time, gives a type, sends on a
    topic, runs on a host alone, or serves a requirement.
    """
    architecture = lookup.architecture
    results = (result for result in (lookup.timing.chains if lookup.timing else ()) if result.id == name)
    if (result := next(results, None)) and result.terms and lookup.timing:
        return list_activity_owners(lookup, find_deciding_term(result).activity)
    if name in architecture.chains:
        return next(
            (
                owners
                for point in architecture.chains[name].through[::-1]
                if (owners := find_owners(architecture, point.id))
            ),
            (),
        )
    if name in architecture.types:
        outputs = [each.id for each in architecture.outputs.values() if each.type == name]
        inputs = [each.id for each in architecture.inputs.values() if each.type == name]
        return next((owners for port in (*outputs, *inputs) if (owners := find_owners(architecture, port))), ())
    if name in architecture.topics:
        topic = architecture.topics[name]
        ends = topic.writers or topic.readers
        return tuple(owner for end in ends for owner in list_node_owners(architecture, end.node))
    if name in architecture.hosts:
        nodes = [node.id for node in architecture.nodes.values() if node.host == name]
        host_owners = tuple(dict.fromkeys(owner for node in nodes for owner in list_node_owners(architecture, node)))
        return host_owners if len(host_owners) == 1 else ()
    servers = lookup.components_for_requirement.get(name, ())
    return tuple(owner for component in servers for owner in component.owners)


def list_node_owners(architecture: Architecture, node_id: str) -> tuple[str, ...]:
    """Return who owns a node: those that it names, else the owners of what it implements."""
    node = architecture.nodes.get(node_id)
    if node is None:
        return ()
    components = (architecture.components.get(name) for name in node.implements)
    return node.owners or tuple(dict.fromkeys(owner for each in components if each for owner in each.owners))


def list_activity_owners(lookup: Lookup, activity_id: str) -> tuple[str, ...]:
    """Return who owns what an activity belongs to."""
    activity = lookup.timing.analysis.system.activities.get(activity_id) if lookup.timing else None
    return list_node_owners(lookup.architecture, activity.node) if activity else ()


def _find_file_owners(architecture: Architecture, file: str) -> tuple[str, ...]:
    """Return the partner whose groups alone stand in a file."""
    owners = list(
        dict.fromkeys(group.owners for group in architecture.groups.values() if file and group.at.file == file)
    )
    return owners[0] if len(owners) == 1 else ()


def link_message(architecture: Architecture, finding: Diagnostic) -> Inlines:
    """Return a finding's message, with a link at each name that it quotes and that is an element's."""
    return tuple(_link_run(architecture, finding, run) for run in inline_text.message_to_inlines(finding.message))


def link_names(architecture: Architecture, sentence: str) -> Inlines:
    """Return a sentence with a link at each name that it quotes and that is an element's."""
    return tuple(
        Text(run.text, ref=reference, code=True)
        if run.code and (reference := find_reference(architecture, run.text))
        else run
        for run in inline_text.message_to_inlines(sentence)
    )


def link_help(architecture: Architecture, finding: Diagnostic) -> Inlines:
    """Return a finding's help, muted, with a link at each name that it quotes and that is an element's."""
    runs = inline_text.message_to_inlines(finding.help or "", muted=True)
    return tuple(_link_run(architecture, finding, run) for run in runs)


def _link_run(architecture: Architecture, finding: Diagnostic, run: Text) -> Text:
    """Return a quoted name as a link; any other run as it is."""
    if not run.code:
        return run
    reference = find_reference(architecture, run.text)
    # A port is called by its own name where its component is named beside it.
    if reference is None and finding.element and finding.element.endswith(f".{run.text}"):
        reference = find_reference(architecture, finding.element)
    return Text(run.text, ref=reference, code=True, muted=run.muted) if reference else run


def place_cell(lookup: Lookup, finding: Diagnostic) -> Inlines:
    """Return file and line of a finding; empty where it has no place."""
    return (place,) if (place := place_run(lookup, finding.span)) else ()


def place_run(lookup: Lookup, span: Span) -> Text | None:
    """Return file and line of a span, with the address in the repository where one is configured; None for no place."""
    if not span.file:
        return None
    address = lookup.repository.file_address(span.file, span.line) if lookup.repository else None
    return Text(f"{span.file}:{span.line}", url=address, code=True, is_place=True)
