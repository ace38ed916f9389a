"""An architecture with the reverse look-ups that describing its elements for matching needs."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Group, list_component_ports


def project_messages(architecture: Architecture) -> list[str]:
    """Return the sorted names of the interfaces that the project defines itself."""
    project_packages = architecture.interfaces.project_packages
    return (
        sorted(name for name in architecture.interfaces.names if name.partition("/")[0] in project_packages)
        if project_packages
        else []
    )


@dataclass
class ElementRelations:
    """An architecture with reverse look-ups; `find_common_id` returns the id after the comparison's matching, None if
    unmatched.
    """

    architecture: Architecture
    find_common_id: Callable[[str, str], str | None]

    def common_ids(self, kind: str, ids: Iterable[str | None]) -> frozenset[str]:
        """Return the common ids of those elements that are matched already."""
        return frozenset(
            common_id
            for element_id in ids
            if element_id is not None and (common_id := self.find_common_id(kind, element_id)) is not None
        )

    @cached_property
    def readers_by_output(self) -> Mapping[str, list[str]]:
        """Return for each output the inputs that read it."""
        return group_pairs((edge.output, edge.input) for edge in self.architecture.edges)

    @cached_property
    def outputs_by_input(self) -> Mapping[str, list[str]]:
        """Return for each input the outputs that it reads."""
        return group_pairs((edge.input, edge.output) for edge in self.architecture.edges)

    @cached_property
    def nodes_by_place(self) -> Mapping[str, list[str]]:
        """Return the written nodes of components (`component:ID`), hosts (`host:ID`) and containers."""
        return group_pairs(
            (place, node.id)
            for node in self.architecture.nodes.values()
            if node.written
            for place in (
                *(f"component:{each}" for each in node.implements),
                f"host:{node.host}",
                f"container:{node.container}",
            )
        )

    @cached_property
    def topics_by_port(self) -> Mapping[str, list[str]]:
        """Return for each port the topics on which nodes carry it, as written."""
        uses = (use for node in self.architecture.nodes.values() for use in node.uses)
        return group_pairs((use.port, topic) for use in uses if use.port for topic in use.topics)

    @cached_property
    def users_by_element(self) -> Mapping[str, list[str]]:
        """Return the users of types (`type:ID`: ports), frames (ports), requirements (components) and use cases
        (requirements), and the frames below others (`below:ID`).
        """
        user_ids: dict[str, list[str]] = defaultdict(list)
        for component in self.architecture.components.values():
            for port in list_component_ports(component):
                if port.type:
                    user_ids[f"type:{port.type}"].append(port.id)
                if port.frame:
                    user_ids[f"frame:{port.frame}"].append(port.id)
            for use in component.requirements:
                user_ids[f"requirement:{use.text}"].append(component.id)
        for requirement in self.architecture.requirements.values():
            for case in requirement.use_cases:
                user_ids[f"use_case:{case}"].append(requirement.id)
        for frame in self.architecture.frames.values():
            user_ids[f"below:{frame.parent}"].append(frame.id)
        return user_ids

    @cached_property
    def elements_by_owner(self) -> Mapping[str, list[str]]:
        """Return for each partner the groups and components that it owns."""
        elements: list[Group | Component] = [
            *self.architecture.groups.values(),
            *self.architecture.components.values(),
        ]
        return group_pairs((element.owner, element.id) for element in elements if element.owner)
