"""List one version as flat elements in normal form: equal elements mean the same, however they are written.

The first version is listed under the ids of the second, so that whatever merely follows a rename is equal.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from archgen.compare.described import own_messages
from archgen.compare.names import Names
from archgen.compare.nodes import alone, behind, nodes, timing_values
from archgen.compare.values import known, prose, title, words
from archgen.compare.version import Version
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Input, Output
from archgen.model.interfaces import Interface
from archgen.model.node import Node
from archgen.model.review import Review

SOME = "some"
"""Value of the keys "inputs" and "outputs" of a component that has ports: these are elements of their own."""
MAPPED = "mapped"
"""Key of a component that says whether somebody wrote a node for it."""
Key = tuple[str, str]
"""A kind of element and a common id."""


@dataclass(frozen=True, slots=True)
class Element:
    """One element. `id` is the common id, `own_id` the one in its version; `parent_key` is the element that it is added
    and removed with.

    `owner` is a partner; `is_declared` is False for what exists without a declaration (a type that is only used).
    """

    sort: str
    id: str
    own: str
    values: Mapping[str, object]
    parent: Key | None = None
    owner: str | None = None
    stated: bool = True
    refs: tuple[str, ...] = ()
    """Common ids of the components behind it; for a port of a node, the id of the component's port."""


def both(before: Version, after: Version, names: Names) -> tuple[dict[Key, Element], dict[Key, Element]]:
    """List all elements of both versions under the ids of the second one."""
    # A component with one node in one version and several in the other is compared by its nodes in both versions: else
    # its timing and ports would change their place, not their meaning.
    one = {names.to("component", name) for name in alone(before.architecture)}
    split = one ^ alone(after.architecture)
    split &= set(after.architecture.components) & set(names.ahead.get("component", {}).values())
    return _elements(before, names, frozenset(split)), _elements(after, Names(), frozenset(split))


def _elements(version: Version, names: Names, split: frozenset[str]) -> dict[Key, Element]:
    found = version.architecture
    listed = (
        *_project(version, names),
        *_around(found, names),
        *_groups(found, names, split),
        *_types(found, names),
        *(Element(*each) for each in nodes(found, names, split)),
        *_deployment(found, names),
        *_asked(found, names),
    )
    # Values hold no spans: elements that move between files have not changed.
    return {(each.sort, each.id): each for each in listed}


def _project(version: Version, names: Names) -> Iterator[Element]:
    found, project = version.architecture, version.architecture.project
    values = {
        "id": None if "id" in version.unnamed else project.id,
        "title": None if "title" in version.unnamed else project.title,
        "version": project.version,
        "description": prose(project.description),
        "distro": found.distro,
        "shared_topics": words(found.shared_topics),
        "layout": found.layout.direction,
        "chapters": version.order,
        **_review(found.review),
        **{f"rules.{rule}": severity for rule, severity in version.rules.items()},
    }
    yield Element("project", names.to("project", project.id), project.id, known(values))
    for path, text in version.chapters.items():
        yield Element("chapter", path, path, {"text": prose(text)})
    for name in own_messages(found):
        definition = found.interfaces.definitions.get(name)
        yield Element("message", names.to("message", name), name, {"fields": _fields(definition) if definition else ()})


def _fields(definition: Interface) -> tuple[str, ...]:
    """Return the fields of an interface as ROS writes them, with `---` between the parts of a service or action."""
    parts = [[f"{field.type}{field.array} {field.name}" for field in part] for part in definition.parts]
    return tuple(parts[0]) + tuple(line for part in parts[1:] for line in ("---", *part)) if parts else ()


def _review(review: Review) -> dict[str, object]:
    return {
        "review.main": review.main,
        "review.breaking": review.breaking and str(review.breaking),
        "review.backends": words(review.backends),
        **{
            f"review.accepted.{name}": f"{one.reason} ({one.key})" if one.key else one.reason
            for name, one in review.accepted.items()
        },
    }


def _around(found: Architecture, names: Names) -> Iterator[Element]:
    for partner in found.partners.values():
        values: dict[str, object] = {
            "title": title(partner.id, partner.title),
            "description": prose(partner.description),
            "contact": partner.contact,
            "reviewers": words(partner.reviewers),
        }
        name = names.to("partner", partner.id)
        yield Element("partner", name, partner.id, known(values), owner=name)
    for case in found.use_cases.values():
        values = {"title": title(case.id, case.title), "description": prose(case.description)}
        yield Element("use_case", names.to("use_case", case.id), case.id, known(values))
    for one in found.requirements.values():
        values = {
            "title": title(one.id, one.title),
            "description": prose(one.description),
            "use_cases": words(names.to("use_case", case) for case in one.use_cases),
            "tags": words(one.tags),
            **_urls(one.urls),
        }
        yield Element("requirement", names.to("requirement", one.id), one.id, known(values))


def _groups(found: Architecture, names: Names, split: frozenset[str]) -> Iterator[Element]:
    nodes_of = behind(found)
    for group in found.groups.values():
        name = names.to("group", group.id)
        owner = _owner(names, group.owner)
        values: dict[str, object] = {
            "title": title(group.id, group.title),
            "description": prose(group.description),
            "owner": owner,
            "co_owners": words(names.to("partner", other) for other in group.co_owners),
            "tags": words(group.tags),
            "layout": group.layout.direction,
            **_urls(group.urls),
        }
        yield Element("group", name, group.id, known(values), owner=owner)
        for component in group.components.values():
            yield from _component(component, nodes_of.get(component.id, ()), names, split)


def _component(
    component: Component, nodes_of: Sequence[Node], names: Names, split: frozenset[str]
) -> Iterator[Element]:
    name = names.to("component", component.id)
    owner = _owner(names, component.owner)
    key = ("component", name)
    values = {
        "title": title(component.name, component.title),
        "functionality": prose(component.functionality),
        "description": prose(component.description),
        "owner": owner,
        "co_owners": words(names.to("partner", other) for other in component.co_owners),
        "role": component.role,
        "requirements": words(names.to("requirement", use.text) for use in component.requirements),
        "tags": words(component.tags),
        "layout": component.layout.direction,
        "inputs": SOME if component.inputs else "none" if component.inputs_known else None,
        "outputs": SOME if component.outputs else "none" if component.outputs_known else None,
        **_urls(component.urls),
        **_performance(component),
        **timing_values(component, nodes_of, names, split),
        MAPPED: any(node.written for node in nodes_of) or None,
    }
    yield Element(
        "component",
        name,
        component.id,
        known(values),
        ("group", names.to("group", component.group)),
        owner,
        refs=(name,),
    )
    for output in component.outputs.values():
        own = names.to("output", output.id)
        yield Element("output", own, output.id, known(_port(output, names)), key, owner, refs=(name,))
    for port in component.inputs.values():
        own = names.to("input", port.id)
        values = {**_port(port, names), "optional": port.optional or None}
        yield Element("input", own, port.id, known(values), key, owner, refs=(name,))


def _port(port: Input | Output, names: Names) -> dict[str, object]:
    return {
        "type": names.to("type", port.type) if port.type else None,
        "medium": "physical" if port.physical else None,
        "external": prose(port.external),
        "description": prose(port.description),
    }


def _performance(component: Component) -> dict[str, object]:
    return {
        f"performance.{each.id}.{key}": value
        for each in component.performance
        for key, value in (
            ("title", title(each.id, each.title)),
            ("accuracy", each.accuracy),
            ("execution_time", each.execution_time),
        )
    }


def _types(found: Architecture, names: Names) -> Iterator[Element]:
    for one in found.types.values():
        if one.origin == "message" and not one.at.file:
            continue
        name = names.to("type", one.name)
        inside = {key: getattr(one, key) for key in ("request", "response", "feedback")}
        values: dict[str, object] = {
            "message": names.to("message", one.message) if one.message else None,
            "comment": prose(one.comment),
            "size": one.size,
            # Defaults count as not written: writing them out is no change.
            "status": None if one.status == "existing" else one.status,
            **{key: names.to("type", value) if value else None for key, value in inside.items()},
        }
        yield Element("type", name, one.name, known(values), stated=one.origin == "project" and bool(one.at.file))


def _deployment(found: Architecture, names: Names) -> Iterator[Element]:
    for host in found.hosts.values():
        values: dict[str, object] = {
            "title": title(host.id, host.title),
            "cores": host.cores,
            "description": prose(host.description),
            "tags": words(host.tags),
        }
        yield Element("host", names.to("host", host.id), host.id, known(values))
    for container in found.containers.values():
        values = {
            "title": title(container.id, container.title),
            "host": names.to("host", container.host) if container.host else None,
            "threads": container.threads,
        }
        yield Element("container", names.to("container", container.id), container.id, known(values))
    for link in found.links.values():
        values = {
            "title": title(link.id, link.title),
            "connects": words(names.to("host", host) for host in link.connects),
            "bandwidth": link.bandwidth,
            "latency.best": link.best,
            "latency.worst": link.worst,
        }
        yield Element("link", names.to("link", link.id), link.id, known(values))


def _asked(found: Architecture, names: Names) -> Iterator[Element]:
    """Yield chains, views and policies."""
    for chain in found.chains.values():
        values: dict[str, object] = {
            "title": title(chain.id, chain.title),
            "through": tuple(names.to(point.kind, point.id) for point in chain.through),
            "deadline": chain.deadline,
            "requirements": words(names.to("requirement", one) for one in chain.requirements),
        }
        yield Element("chain", names.to("chain", chain.id), chain.id, known(values))
    for view in found.views.values():
        values = {
            "title": title(view.id, view.title),
            "show": names.words(" ".join(view.show.split())),
            "colour": view.colour,
            "level": None if view.level == "functional" else view.level,
            "layout": view.layout.direction,
        }
        yield Element("view", names.to("view", view.id), view.id, known(values))
    for policy in found.policies.values():
        values = {
            "title": title(policy.id, policy.title),
            "forbid.from": names.words(" ".join(policy.forbid_from.split())),
            "forbid.to": names.words(" ".join(policy.forbid_to.split())),
        }
        yield Element("policy", names.to("policy", policy.id), policy.id, known(values))


def _owner(names: Names, owner: str | None) -> str | None:
    return names.to("partner", owner) if owner else None


def _urls(urls: Mapping[str, str]) -> dict[str, object]:
    return {f"urls.{name}": url for name, url in urls.items()}
