"""Search entries of the functional level: groups, components, ports, connections, requirements, partners, chains."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.model.architecture import Annotated
from archgen.model.component import Component, Connection, Group, Input, Output
from archgen.model.component_nesting import find_component
from archgen.views import inline_text
from archgen.views.elements import port_tables
from archgen.views.elements.element_names import join_surrounding_titles
from archgen.views.lookup import Lookup
from archgen.views.search.search_entry import SearchEntry, join_entry_parts, to_plain_text


def list_owner_titles(lookup: Lookup, owners: Iterable[str]) -> str:
    """Return the titles of partners, joined by commas."""
    return ", ".join(lookup.architecture.partners[owner].title for owner in owners)


def make_owner_keys(owners: Iterable[str], tags: Iterable[str] = ()) -> tuple[str, ...]:
    """Return the words that selectors have for owners and tags."""
    return (*(f"owner:{owner}" for owner in owners), *(f"tag:{tag}" for tag in tags))


def make_property_keys(element: Annotated) -> tuple[str, ...]:
    """Return the words that selectors have for the properties of an element."""
    return tuple(f"property:{name}={text}" for name, text in element.annotations.properties.items())


def make_vocabulary_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield the declared properties, and the terms of the glossary."""
    for each in lookup.architecture.properties.values():
        line = join_entry_parts("property", ", ".join(kind.replace("_", " ") for kind in each.of), each.unit)
        keys = (each.id, f"property:{each.id}")
        text = to_plain_text(each.description)
        yield SearchEntry("property", each.title, line, (f"property:{each.id}", "page:properties"), keys, text)
    for term in lookup.architecture.glossary.values():
        refs = (f"term:{term.term}", "page:glossary")
        yield SearchEntry("term", term.term, "term of the glossary", refs, text=" ".join(term.text.split()))


def make_group_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield the shown groups."""
    for group_id in lookup.shown_groups():
        group = lookup.architecture.groups[group_id]
        size = f"group of {inline_text.count_noun(len(group.components), 'component')}"
        yield SearchEntry(
            "group",
            group.title,
            join_entry_parts(size, list_owner_titles(lookup, group.owners)),
            (f"group:{group.id}",),
            (group.id, *make_owner_keys(group.owners, group.tags), *make_property_keys(group)),
            to_plain_text(group.description),
        )


def make_component_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield the shown components."""
    for group, component in _shown_components(lookup):
        if component.id in lookup.architecture.shells:
            continue
        tags = dict.fromkeys((*component.tags, *group.tags))
        yield SearchEntry(
            "component",
            component.title,
            join_entry_parts(_join_place(lookup, component), list_owner_titles(lookup, component.owners)),
            (f"component:{component.id}",),
            (component.id, *make_owner_keys(component.owners, tags), *make_property_keys(component)),
            to_plain_text(
                component.functionality,
                component.description,
                *component.parameters,
                *component.operations,
                component.contact,
            ),
        )


def make_composed_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield the composed components of which something is shown."""
    for shell in lookup.architecture.shells.values():
        if lookup.shows_part(shell.id):
            leaves = [leaf for leaf in lookup.architecture.leaves_of(shell.id) if leaf != shell.id]
            yield SearchEntry(
                "component",
                shell.title,
                join_entry_parts(
                    f"composed of {inline_text.count_noun(len(leaves), 'component')}",
                    _join_place(lookup, shell),
                    list_owner_titles(lookup, shell.owners),
                ),
                (f"component:{shell.id}",),
                (shell.id, *make_owner_keys(shell.owners, shell.tags), *make_property_keys(shell)),
                to_plain_text(shell.functionality, shell.description, shell.contact),
            )


def make_component_type_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield the component types."""
    for component_type in lookup.architecture.component_types.values():
        yield SearchEntry(
            "component type",
            component_type.title,
            join_entry_parts("type of components", *port_tables.list_text_remarks(component_type)),
            (f"component_type:{component_type.id}",),
            (component_type.id, f"is:{component_type.id}", *make_property_keys(component_type)),
            to_plain_text(component_type.functionality, component_type.description),
        )


def _join_place(lookup: Lookup, component: Component) -> str:
    """Return the titles of a component's group and of what it is inside of."""
    return join_entry_parts(
        lookup.architecture.groups[component.group].title, join_surrounding_titles(lookup, component)
    )


def make_port_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield the inputs and outputs of the shown components."""
    for group, component in _shown_components(lookup):
        suffix = join_entry_parts(group.title, list_owner_titles(lookup, component.owners))
        ports: tuple[tuple[str, Input | Output], ...] = (
            *(("input", port) for port in component.inputs.values()),
            *(("output", port) for port in component.outputs.values()),
        )
        for direction, port in ports:
            yield SearchEntry(
                "port",
                _port_title(component, port.name),
                join_entry_parts(
                    f"{direction} of {suffix}",
                    port.type,
                    *(port_tables.list_text_remarks(port) if isinstance(port, Output) else ()),
                ),
                (f"table:{direction}s/{component.id}", f"component:{component.id}"),
                (),
                to_plain_text(port.description, port.external),
            )


def make_connection_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield the connections. One that has an end in scope leads to its reader, or to its source."""
    architecture = lookup.architecture
    for connection in architecture.connections:
        reader = architecture.inputs[connection.input]
        component = architecture.components[reader.component]
        sources = dict.fromkeys(architecture.outputs[output].component for output in connection.outputs)
        types = dict.fromkeys(architecture.outputs[output].type for output in connection.outputs)
        yield SearchEntry(
            "connection",
            f"{_source_title(lookup, connection)} → {_port_title(component, reader.name)}",
            join_entry_parts("connection", *types),
            (f"table:inputs/{component.id}", *(f"table:outputs/{source}" for source in sources)),
        )


def make_requirement_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield use cases and requirements, also those that components state in their own words."""
    architecture = lookup.architecture
    for use_case in architecture.use_cases.values():
        yield SearchEntry(
            "use case",
            f"{use_case.id} {use_case.title}",
            "use case",
            (f"use_case:{use_case.id}",),
            text=to_plain_text(
                use_case.description,
                *(actor.title for actor in use_case.actors.values()),
                *(step.say for step in use_case.steps),
            ),
        )
    for requirement in architecture.requirements.values():
        servers = lookup.components_for_requirement.get(requirement.id, ())
        names = [component.title for component in servers]
        names += [chain.title for chain in lookup.chains_for_requirement.get(requirement.id, ())]
        is_whole = not names and requirement.id in lookup.requirement_trace.served
        served_by = f"served by {', '.join(names)}" if names else "served by its parts" if is_whole else ""
        yield SearchEntry(
            "requirement",
            f"{requirement.id} {requirement.title}",
            join_entry_parts(
                ", ".join(requirement.use_cases),
                *(each for each in (requirement.kind, requirement.priority) if each),
                served_by or "served by no component",
            ),
            (f"requirement:{requirement.id}",),
            make_owner_keys((), requirement.tags),
            " ".join(filter(None, map(to_plain_text, (requirement.description, requirement.rationale)))),
        )
    for _, component in _shown_components(lookup):
        for use in component.requirements:
            if not use.is_id:
                yield SearchEntry(
                    "requirement", use.text, f"of {component.title}, in its own words", (f"component:{component.id}",)
                )


def make_partner_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield the partners."""
    for partner in lookup.architecture.partners.values():
        line = join_entry_parts("partner", partner.contact)
        keys = (partner.id, *make_owner_keys((partner.id,)))
        text = to_plain_text(partner.description)
        yield SearchEntry("partner", partner.title, line, (f"partner:{partner.id}",), keys, text)


def make_chain_entries(lookup: Lookup) -> Iterator[SearchEntry]:
    """Yield chains of effect, variants and views."""
    architecture = lookup.architecture
    for chain in architecture.chains.values():
        deadline = f"deadline {chain.deadline_text}" if chain.deadline_text else ""
        line = join_entry_parts("chain of effect", deadline, ", ".join(chain.requirements))
        yield SearchEntry("chain", chain.title, line, (f"chain:{chain.id}", "page:chains"), (chain.id,))
    for variant in architecture.variants.values():
        line = join_entry_parts("variant", f"without {variant.without}" if variant.without else "")
        text = to_plain_text(variant.description)
        yield SearchEntry("variant", variant.title, line, (f"variant:{variant.id}",), (variant.id,), text)
    for view in architecture.views.values():
        line = join_entry_parts("view", view.show)
        yield SearchEntry("view", view.title, line, (f"figure:views/{view.id}", "page:views"), (view.id,))


def _shown_components(lookup: Lookup) -> Iterator[tuple[Group, Component]]:
    for group_id in lookup.shown_groups():
        for component in lookup.shown_components(group_id):
            yield lookup.architecture.groups[group_id], component


def _port_title(component: Component, name: str) -> str:
    return f"{component.title} · {name}"


def _source_title(lookup: Lookup, connection: Connection) -> str:
    """Return what a connection comes from: an output, or all of a component or group."""
    architecture = lookup.architecture
    if connection.kind == "group":
        return architecture.groups[connection.target].title
    if connection.kind == "component":
        return find_component(architecture, connection.target).title
    output = architecture.outputs[connection.target]
    return _port_title(architecture.components[output.component], output.name)
