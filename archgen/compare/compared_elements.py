"""List one version as flat elements in normal form: equal elements mean the same, however they are written.

The first version is listed under the ids of the second, so that whatever merely follows a rename is equal.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.element_relations import project_messages
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.node_elements import list_node_elements, nodes_by_component, single_node_components, timing_values
from archgen.compare.normal_values import drop_unset_values, normalize_text, normalize_title, unordered_values
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Input, Output
from archgen.model.known_interfaces import Interface
from archgen.model.node import Node
from archgen.model.review_settings import ReviewSettings

SOME_PORTS = "some"
"""Value of the keys "inputs" and "outputs" of a component that has ports: these are elements of their own."""
MAPPED_KEY = "mapped"
"""Key of a component that says whether somebody wrote a node for it."""
ElementKey = tuple[str, str]
"""A kind of element and a common id."""


@dataclass(frozen=True, slots=True)
class ComparedElement:
    """One element. `id` is the common id, `own_id` the one in its version; `parent_key` is the element that it is added
    and removed with.

    `owner` is a partner; `is_declared` is False for what exists without a declaration (a type that is only used).
    """

    kind: str
    id: str
    own_id: str
    values: Mapping[str, object]
    parent_key: ElementKey | None = None
    owner: str | None = None
    is_declared: bool = True
    component_refs: tuple[str, ...] = ()
    """Common ids of the components behind it; for a port of a node, the id of the component's port."""


def list_elements(
    before: ArchitectureVersion, after: ArchitectureVersion, matched_ids: MatchedIds
) -> tuple[dict[ElementKey, ComparedElement], dict[ElementKey, ComparedElement]]:
    """List all elements of both versions under the ids of the second one."""
    # A component with one node in one version and several in the other is compared by its nodes in both versions: else
    # its timing and ports would change their place, not their meaning.
    components_before = {
        matched_ids.common_id("component", name) for name in single_node_components(before.architecture)
    }
    split_components = components_before ^ single_node_components(after.architecture)
    split_components &= set(after.architecture.components) & set(matched_ids.new_ids.get("component", {}).values())
    return _list_version_elements(before, matched_ids, frozenset(split_components)), _list_version_elements(
        after, MatchedIds(), frozenset(split_components)
    )


def _list_version_elements(
    version: ArchitectureVersion, matched_ids: MatchedIds, split_components: frozenset[str]
) -> dict[ElementKey, ComparedElement]:
    architecture = version.architecture
    elements = (
        *_project_elements(version, matched_ids),
        *_context_elements(architecture, matched_ids),
        *_group_elements(architecture, matched_ids, split_components),
        *_type_elements(architecture, matched_ids),
        *(ComparedElement(*element) for element in list_node_elements(architecture, matched_ids, split_components)),
        *_deployment_elements(architecture, matched_ids),
        *_chain_and_view_elements(architecture, matched_ids),
    )
    # Values hold no spans: elements that move between files have not changed.
    return {(element.kind, element.id): element for element in elements}


def _project_elements(version: ArchitectureVersion, matched_ids: MatchedIds) -> Iterator[ComparedElement]:
    architecture, project = version.architecture, version.architecture.project
    values = {
        "id": None if "id" in version.unnamed_keys else project.id,
        "title": None if "title" in version.unnamed_keys else project.title,
        "version": project.version,
        "description": normalize_text(project.description),
        "distro": architecture.distro,
        "shared_topics": unordered_values(architecture.shared_topics),
        "layout": architecture.layout.direction,
        "chapters": version.chapter_order,
        **_review_values(architecture.review),
        **{f"rules.{name}": value for name, value in version.rule_settings.items()},
    }
    yield ComparedElement(
        "project", matched_ids.common_id("project", project.id), project.id, drop_unset_values(values)
    )
    for path, text in version.chapters.items():
        yield ComparedElement("chapter", path, path, {"text": normalize_text(text)})
    for name in project_messages(architecture):
        definition = architecture.interfaces.definitions.get(name)
        yield ComparedElement(
            "message",
            matched_ids.common_id("message", name),
            name,
            {"fields": _field_lines(definition) if definition else ()},
        )


def _field_lines(definition: Interface) -> tuple[str, ...]:
    """Return the fields of an interface as ROS writes them, with `---` between the parts of a service or action."""
    parts = [[f"{field.type}{field.array} {field.name}" for field in part] for part in definition.parts]
    return tuple(parts[0]) + tuple(line for part in parts[1:] for line in ("---", *part)) if parts else ()


def _review_values(review: ReviewSettings) -> dict[str, object]:
    return {
        "review.main": review.main,
        "review.breaking": review.breaking and str(review.breaking),
        "review.backends": unordered_values(review.backends),
        **{
            f"review.accepted.{name}": f"{entry.reason} ({entry.key})" if entry.key else entry.reason
            for name, entry in review.accepted.items()
        },
    }


def _context_elements(architecture: Architecture, matched_ids: MatchedIds) -> Iterator[ComparedElement]:
    for partner in architecture.partners.values():
        values: dict[str, object] = {
            "title": normalize_title(partner.id, partner.title),
            "description": normalize_text(partner.description),
            "contact": partner.contact,
            "reviewers": unordered_values(partner.reviewers),
        }
        name = matched_ids.common_id("partner", partner.id)
        yield ComparedElement("partner", name, partner.id, drop_unset_values(values), owner=name)
    for use_case in architecture.use_cases.values():
        values = {
            "title": normalize_title(use_case.id, use_case.title),
            "description": normalize_text(use_case.description),
        }
        yield ComparedElement(
            "use_case", matched_ids.common_id("use_case", use_case.id), use_case.id, drop_unset_values(values)
        )
    for requirement in architecture.requirements.values():
        values = {
            "title": normalize_title(requirement.id, requirement.title),
            "description": normalize_text(requirement.description),
            "use_cases": unordered_values(
                matched_ids.common_id("use_case", use_case) for use_case in requirement.use_cases
            ),
            "tags": unordered_values(requirement.tags),
            **_url_values(requirement.urls),
        }
        yield ComparedElement(
            "requirement",
            matched_ids.common_id("requirement", requirement.id),
            requirement.id,
            drop_unset_values(values),
        )


def _group_elements(
    architecture: Architecture, matched_ids: MatchedIds, split_components: frozenset[str]
) -> Iterator[ComparedElement]:
    component_nodes = nodes_by_component(architecture)
    for group in architecture.groups.values():
        name = matched_ids.common_id("group", group.id)
        owner = _common_owner(matched_ids, group.owner)
        values: dict[str, object] = {
            "title": normalize_title(group.id, group.title),
            "description": normalize_text(group.description),
            "owner": owner,
            "co_owners": unordered_values(
                matched_ids.common_id("partner", partner_id) for partner_id in group.co_owners
            ),
            "tags": unordered_values(group.tags),
            "layout": group.layout.direction,
            **_url_values(group.urls),
        }
        yield ComparedElement("group", name, group.id, drop_unset_values(values), owner=owner)
        for component in group.components.values():
            yield from _component_elements(
                component, component_nodes.get(component.id, ()), matched_ids, split_components
            )


def _component_elements(
    component: Component, component_nodes: Sequence[Node], matched_ids: MatchedIds, split_components: frozenset[str]
) -> Iterator[ComparedElement]:
    name = matched_ids.common_id("component", component.id)
    owner = _common_owner(matched_ids, component.owner)
    key = ("component", name)
    values = {
        "title": normalize_title(component.name, component.title),
        "functionality": normalize_text(component.functionality),
        "description": normalize_text(component.description),
        "owner": owner,
        "co_owners": unordered_values(
            matched_ids.common_id("partner", partner_id) for partner_id in component.co_owners
        ),
        "role": component.role,
        "requirements": unordered_values(
            matched_ids.common_id("requirement", use.text) for use in component.requirements
        ),
        "tags": unordered_values(component.tags),
        "layout": component.layout.direction,
        "inputs": SOME_PORTS if component.inputs else "none" if component.inputs_known else None,
        "outputs": SOME_PORTS if component.outputs else "none" if component.outputs_known else None,
        **_url_values(component.urls),
        **_performance_values(component),
        **timing_values(component, component_nodes, matched_ids, split_components),
        MAPPED_KEY: any(node.written for node in component_nodes) or None,
    }
    yield ComparedElement(
        "component",
        name,
        component.id,
        drop_unset_values(values),
        ("group", matched_ids.common_id("group", component.group)),
        owner,
        component_refs=(name,),
    )
    for output in component.outputs.values():
        port_id = matched_ids.common_id("output", output.id)
        yield ComparedElement(
            "output",
            port_id,
            output.id,
            drop_unset_values(_port_values(output, matched_ids)),
            key,
            owner,
            component_refs=(name,),
        )
    for port in component.inputs.values():
        port_id = matched_ids.common_id("input", port.id)
        values = {**_port_values(port, matched_ids), "optional": port.optional or None}
        yield ComparedElement("input", port_id, port.id, drop_unset_values(values), key, owner, component_refs=(name,))


def _port_values(port: Input | Output, matched_ids: MatchedIds) -> dict[str, object]:
    return {
        "type": matched_ids.common_id("type", port.type) if port.type else None,
        "medium": "physical" if port.physical else None,
        "external": normalize_text(port.external),
        "description": normalize_text(port.description),
    }


def _performance_values(component: Component) -> dict[str, object]:
    return {
        f"performance.{performance.id}.{key}": value
        for performance in component.performance
        for key, value in (
            ("title", normalize_title(performance.id, performance.title)),
            ("accuracy", performance.accuracy),
            ("execution_time", performance.execution_time),
        )
    }


def _type_elements(architecture: Architecture, matched_ids: MatchedIds) -> Iterator[ComparedElement]:
    for conceptual_type in architecture.types.values():
        if conceptual_type.origin == "message" and not conceptual_type.at.file:
            continue
        name = matched_ids.common_id("type", conceptual_type.name)
        inner_types = {key: getattr(conceptual_type, key) for key in ("request", "response", "feedback")}
        values: dict[str, object] = {
            "message": matched_ids.common_id("message", conceptual_type.message) if conceptual_type.message else None,
            "comment": normalize_text(conceptual_type.comment),
            "size": conceptual_type.size,
            # Defaults count as not written: writing them out is no change.
            "status": None if conceptual_type.status == "existing" else conceptual_type.status,
            **{key: matched_ids.common_id("type", value) if value else None for key, value in inner_types.items()},
        }
        yield ComparedElement(
            "type",
            name,
            conceptual_type.name,
            drop_unset_values(values),
            is_declared=conceptual_type.origin == "project" and bool(conceptual_type.at.file),
        )


def _deployment_elements(architecture: Architecture, matched_ids: MatchedIds) -> Iterator[ComparedElement]:
    for host in architecture.hosts.values():
        values: dict[str, object] = {
            "title": normalize_title(host.id, host.title),
            "cores": host.cores,
            "description": normalize_text(host.description),
            "tags": unordered_values(host.tags),
        }
        yield ComparedElement("host", matched_ids.common_id("host", host.id), host.id, drop_unset_values(values))
    for container in architecture.containers.values():
        values = {
            "title": normalize_title(container.id, container.title),
            "host": matched_ids.common_id("host", container.host) if container.host else None,
            "threads": container.threads,
        }
        yield ComparedElement(
            "container", matched_ids.common_id("container", container.id), container.id, drop_unset_values(values)
        )
    for link in architecture.links.values():
        values = {
            "title": normalize_title(link.id, link.title),
            "connects": unordered_values(matched_ids.common_id("host", host) for host in link.connects),
            "bandwidth": link.bandwidth,
            "latency.best": link.best,
            "latency.worst": link.worst,
        }
        yield ComparedElement("link", matched_ids.common_id("link", link.id), link.id, drop_unset_values(values))


def _chain_and_view_elements(architecture: Architecture, matched_ids: MatchedIds) -> Iterator[ComparedElement]:
    """Yield chains, views and policies."""
    for chain in architecture.chains.values():
        values: dict[str, object] = {
            "title": normalize_title(chain.id, chain.title),
            "through": tuple(matched_ids.common_id(point.kind, point.id) for point in chain.through),
            "deadline": chain.deadline,
            "requirements": unordered_values(
                matched_ids.common_id("requirement", requirement_id) for requirement_id in chain.requirements
            ),
        }
        yield ComparedElement("chain", matched_ids.common_id("chain", chain.id), chain.id, drop_unset_values(values))
    for view in architecture.views.values():
        values = {
            "title": normalize_title(view.id, view.title),
            "show": matched_ids.rename_in_text(" ".join(view.show.split())),
            "colour": view.colour,
            "level": None if view.level == "functional" else view.level,
            "layout": view.layout.direction,
        }
        yield ComparedElement("view", matched_ids.common_id("view", view.id), view.id, drop_unset_values(values))
    for policy in architecture.policies.values():
        values = {
            "title": normalize_title(policy.id, policy.title),
            "forbid.from": matched_ids.rename_in_text(" ".join(policy.forbid_from.split())),
            "forbid.to": matched_ids.rename_in_text(" ".join(policy.forbid_to.split())),
        }
        yield ComparedElement(
            "policy", matched_ids.common_id("policy", policy.id), policy.id, drop_unset_values(values)
        )


def _common_owner(matched_ids: MatchedIds, owner: str | None) -> str | None:
    return matched_ids.common_id("partner", owner) if owner else None


def _url_values(urls: Mapping[str, str]) -> dict[str, object]:
    return {f"urls.{name}": url for name, url in urls.items()}
