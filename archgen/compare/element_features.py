"""The features by which an element is recognised after its id changed: text, ports, partners, neighbours, nodes.

References count by the element they refer to if that is matched already; new and removed elements say nothing. The
weights are the first argument of each `Feature`.
"""

from __future__ import annotations

from archgen.compare.element_likeness import Feature, FeatureMap, letter_pairs, word_set
from archgen.compare.element_relations import ElementRelations, ports_of
from archgen.model.path_resolver import title_from_id


def _feature_marks(*values: object) -> frozenset[str]:
    return frozenset(str(value) for value in values if value not in {None, ""})


def _name_features(name: str, title: str) -> FeatureMap:
    return {
        "name": Feature(2, letter_pairs(name)),
        "title": Feature(2, word_set(title), title in {title_from_id(name), name}),
    }


def describe_partner(relations: ElementRelations, name: str) -> FeatureMap:
    """Return the features of a partner."""
    element = relations.architecture.partners[name]
    return {**_name_features(name, element.title), "owns": Feature(4, frozenset(relations.elements_by_owner[name]))}


def describe_group(relations: ElementRelations, name: str) -> FeatureMap:
    """Return the features of a group."""
    element = relations.architecture.groups[name]
    return {
        **_name_features(name, element.title),
        # The names of its components outweigh all else: a group is what it holds.
        "components": Feature(8, frozenset(element.components)),
        "text": Feature(2, word_set(element.description)),
        "owner": Feature(0.5, relations.common_ids("partner", [element.owner])),
    }


def describe_component(relations: ElementRelations, name: str) -> FeatureMap:
    """Return the features of a component."""
    element = relations.architecture.components[name]
    # The direction is part of the mark, so that an input and an output of one name are not alike.
    ports = [f"> {port.name}" for port in element.inputs.values()]
    ports += [f"{port.name} >" for port in element.outputs.values()]
    types = [port.type for port in ports_of(element)]
    neighbours = [
        source.rpartition(".")[0]
        for port in element.inputs.values()
        for source in relations.outputs_by_input.get(port.id, ())
    ]
    neighbours += [
        reader.rpartition(".")[0]
        for port in element.outputs.values()
        for reader in relations.readers_by_output.get(port.id, ())
    ]
    timing = element.timing
    return {
        **_name_features(element.name, element.title),
        "ports": Feature(4, _feature_marks(*ports, *types)),
        "text": Feature(3, word_set(element.functionality) | word_set(element.description)),
        "near": Feature(3, relations.common_ids("component", neighbours)),
        "nodes": Feature(3, relations.common_ids("node", relations.nodes_by_place.get(f"component:{name}", ()))),
        "group": Feature(0.5, relations.common_ids("group", [element.group])),
        "owner": Feature(0.5, relations.common_ids("partner", [element.owner])),
        "requirements": Feature(1, _feature_marks(*(use.text for use in element.requirements))),
        "performance": Feature(
            1,
            _feature_marks(
                *(
                    f"{performance.id} {performance.accuracy} {performance.execution_time}"
                    for performance in element.performance
                )
            ),
        ),
        "timing": Feature(1, _feature_marks(timing.behaviour, timing.rate, timing.wcet) if timing else frozenset()),
        "tags": Feature(0.5, frozenset(element.tags)),
    }


def describe_output(relations: ElementRelations, name: str) -> FeatureMap:
    """Return the features of an output."""
    element = relations.architecture.outputs[name]
    readers = [reader.rpartition(".")[0] for reader in relations.readers_by_output.get(name, ())]
    return {
        "name": Feature(2, letter_pairs(element.name)),
        "type": Feature(4, _feature_marks(element.type)),
        # `topics_by_port` is a defaultdict: a port that no node names has no marks.
        "topics": Feature(3, frozenset(relations.topics_by_port[name])),
        "readers": Feature(5, relations.common_ids("component", readers)),
        "text": Feature(1, word_set(element.description) | word_set(element.external)),
    }


def describe_input(relations: ElementRelations, name: str) -> FeatureMap:
    """Return the features of an input."""
    element = relations.architecture.inputs[name]
    return {
        "name": Feature(2, letter_pairs(element.name)),
        "type": Feature(4, _feature_marks(element.type)),
        "topics": Feature(3, frozenset(relations.topics_by_port[name])),
        "sources": Feature(5, relations.common_ids("output", relations.outputs_by_input.get(name, ()))),
        "text": Feature(1, word_set(element.description) | word_set(element.external)),
    }


def describe_type(relations: ElementRelations, name: str) -> FeatureMap:
    """Return the features of a conceptual type."""
    element = relations.architecture.types[name]
    ports = relations.users_by_element.get(f"type:{name}", ())
    return {
        "name": Feature(2, letter_pairs(name)),
        "message": Feature(3, _feature_marks(element.message)),
        "users": Feature(5, relations.common_ids("output", ports) | relations.common_ids("input", ports)),
        "text": Feature(1, word_set(element.comment)),
        "size": Feature(1, _feature_marks(element.size)),
        "inside": Feature(2, _feature_marks(element.request, element.response, element.feedback)),
    }


def describe_message(relations: ElementRelations, name: str) -> FeatureMap:
    """Return the features of an interface that the project defines."""
    definition = relations.architecture.interfaces.definitions.get(name)
    fields = [f"{field.name} {field.type}" for part in definition.parts for field in part] if definition else []
    users = [
        conceptual_type.name
        for conceptual_type in relations.architecture.types.values()
        if conceptual_type.message == name
    ]
    return {
        "name": Feature(2, letter_pairs(name.rpartition("/")[2])),
        "package": Feature(1, _feature_marks(name.rpartition("/")[0])),
        "fields": Feature(5, _feature_marks(*fields)),
        "users": Feature(4, relations.common_ids("type", users)),
    }


def describe_node(relations: ElementRelations, name: str) -> FeatureMap:
    """Return the features of a node."""
    element = relations.architecture.nodes[name]
    return {
        **_name_features(name, element.title),
        "implements": Feature(4, relations.common_ids("component", element.implements)),
        "package": Feature(2, _feature_marks(element.package)),
        "program": Feature(2, _feature_marks(element.executable, element.plugin)),
        "ports": Feature(2, _feature_marks(*(f"{use.use} {use.key}" for use in element.uses))),
        "topics": Feature(1, _feature_marks(*(topic for use in element.uses for topic in use.topics))),
        "place": Feature(1, _feature_marks(element.host, element.container)),
        "parameters": Feature(1, frozenset(element.parameters)),
        "text": Feature(1, word_set(element.description)),
    }


def describe_container(relations: ElementRelations, name: str) -> FeatureMap:
    """Return the features of a container."""
    element = relations.architecture.containers[name]
    return {
        **_name_features(name, element.title),
        "nodes": Feature(5, relations.common_ids("node", relations.nodes_by_place.get(f"container:{name}", ()))),
        "host": Feature(1, _feature_marks(element.host)),
        "threads": Feature(1, _feature_marks(element.threads)),
    }


def describe_host(relations: ElementRelations, name: str) -> FeatureMap:
    """Return the features of a host."""
    element = relations.architecture.hosts[name]
    container_ids = [
        held_container.id
        for held_container in relations.architecture.containers.values()
        if held_container.host == name
    ]
    return {
        **_name_features(name, element.title),
        "nodes": Feature(8, relations.common_ids("node", relations.nodes_by_place.get(f"host:{name}", ()))),
        "containers": Feature(2, relations.common_ids("container", container_ids)),
        "cores": Feature(1, _feature_marks(element.cores)),
        "text": Feature(1, word_set(element.description)),
    }


def describe_link(relations: ElementRelations, name: str) -> FeatureMap:
    """Return the features of a link."""
    element = relations.architecture.links[name]
    return {
        **_name_features(name, element.title),
        "connects": Feature(4, relations.common_ids("host", element.connects)),
        "figures": Feature(2, _feature_marks(element.bandwidth, f"best {element.best}", f"worst {element.worst}")),
    }


def describe_chain(relations: ElementRelations, name: str) -> FeatureMap:
    """Return the features of a chain."""
    element = relations.architecture.chains[name]
    through = (relations.common_ids(point.kind, [point.id]) for point in element.through)
    return {
        **_name_features(name, element.title),
        "through": Feature(6, frozenset[str]().union(*through)),
        "deadline": Feature(1, _feature_marks(element.deadline)),
    }


def describe_requirement(relations: ElementRelations, name: str) -> FeatureMap:
    """Return the features of a requirement."""
    element = relations.architecture.requirements[name]
    return {
        "name": Feature(1, letter_pairs(name)),
        # Unlike elsewhere the title weighs more than the id, here and for use cases.
        "title": Feature(4, word_set(element.title), element.title == name),
        "users": Feature(
            3, relations.common_ids("component", relations.users_by_element.get(f"requirement:{name}", ()))
        ),
        "text": Feature(2, word_set(element.description)),
    }


def describe_use_case(relations: ElementRelations, name: str) -> FeatureMap:
    """Return the features of a use case."""
    element = relations.architecture.use_cases[name]
    return {
        "name": Feature(1, letter_pairs(name)),
        "title": Feature(4, word_set(element.title), element.title == name),
        "users": Feature(
            3, relations.common_ids("requirement", relations.users_by_element.get(f"use_case:{name}", ()))
        ),
        "text": Feature(2, word_set(element.description)),
    }


def describe_view(relations: ElementRelations, name: str) -> FeatureMap:
    """Return the features of a view."""
    element = relations.architecture.views[name]
    return {**_name_features(name, element.title), "show": Feature(5, word_set(element.show))}


def describe_policy(relations: ElementRelations, name: str) -> FeatureMap:
    """Return the features of a policy."""
    element = relations.architecture.policies[name]
    return {
        **_name_features(name, element.title),
        "forbids": Feature(5, _feature_marks(f"{element.forbid_from} > {element.forbid_to}")),
    }
