"""The resolved model as plain data, for other programs and code generators (`schemas/resolved.schema.json`).

Elements are keyed by their full ids, and what is not known is left out. A quantity has the text as written (`text`),
the number (`value`) and its unit (`unit`): ns, Hz, B or bit/s.
"""

from __future__ import annotations

from archgen.model.architecture import Architecture, Chain
from archgen.model.component import Group
from archgen.model.port_media import ROS, is_physical
from archgen.model.requirement import Requirement
from archgen.views.lookup import Lookup
from archgen.views.records.carrier_record import record_carriers
from archgen.views.records.component_record import record_component, record_composition
from archgen.views.records.deployment_record import record_container, record_host, record_link, record_resources
from archgen.views.records.frame_record import record_frames
from archgen.views.records.node_record import record_node
from archgen.views.records.parameter_record import record_values
from archgen.views.records.record_values import drop_unknown, pick_fields, record_annotations, record_quantity
from archgen.views.records.type_record import record_type
from archgen.views.records.use_case_record import record_use_cases
from archgen.views.shapes import Record

RECORD_VERSION = 1
"""Version of the format, written as `archgen_resolved`."""


def make_record(lookup: Lookup) -> Record:
    """Return the architecture, or the part in scope, as dicts, lists and scalars."""
    architecture, is_shown = lookup.architecture, lookup.scope.shows_component
    return {
        "archgen_resolved": RECORD_VERSION,
        "project": pick_fields(architecture.project, "id", "title", "version", "description")
        | drop_unknown(
            {
                "middleware": None if architecture.project.middleware == ROS else architecture.project.middleware,
                "distro": architecture.distro,
                "parameters": record_values(architecture.ros_parameters),
            }
        ),
        # Groups, components, connections, edges, nodes and topics are cut to the scope; all else is given in full.
        "partners": {
            p.id: pick_fields(p, "title", "description", "contact", "reviewers") | record_annotations(p)
            for p in architecture.partners.values()
        },
        "use_cases": record_use_cases(lookup),
        "requirements": {r.id: _record_requirement(lookup, r) for r in architecture.requirements.values()},
        **_record_vocabulary(architecture),
        "groups": {name: _record_group(lookup, architecture.groups[name]) for name in lookup.shown_groups()},
        "components": {c.id: record_component(lookup, c) for c in architecture.components.values() if is_shown(c.id)},
        **record_composition(lookup),
        "connections": [
            pick_fields(c, "input", "kind", "target", "outputs", "shell_port")
            | drop_unknown({"is_made": c.is_made or None})
            for c in architecture.connections
            if is_shown(architecture.inputs[c.input].component)
        ],
        "edges": [
            drop_unknown({"from": e.output, "to": e.input, **_record_flow(lookup, e.output)})
            for e in architecture.edges
            if is_shown(architecture.inputs[e.input].component) or is_shown(architecture.outputs[e.output].component)
        ],
        "nodes": {node.id: record_node(lookup, node) for node in lookup.shown_nodes()},
        **record_carriers(lookup),
        "types": {
            t.name: record_type(t, architecture.interfaces) | record_annotations(t) for t in architecture.types.values()
        },
        "hosts": {host.id: record_host(host) for host in architecture.hosts.values()},
        "containers": {container.id: record_container(container) for container in architecture.containers.values()},
        **record_resources(architecture),
        "links": {link.id: record_link(link) for link in architecture.links.values()},
        **record_frames(architecture),
        "chains": {chain.id: _record_chain(chain) for chain in architecture.chains.values()},
        **_record_variants(architecture),
    }


def _record_variants(architecture: Architecture) -> dict[str, object]:
    """Return the section of variants, empty in a project without any, and in one as it stands in one of them."""
    variants = {
        each.id: pick_fields(each, "title", "description", "of", "without", "drop")
        | drop_unknown({"changes": {change.path: change.value for change in each.changes}})
        for each in architecture.variants.values()
    }
    return drop_unknown({"variants": variants})


def _record_vocabulary(architecture: Architecture) -> dict[str, object]:
    """Return the declared properties and the glossary, nothing in a project without them."""
    properties = {
        each.id: pick_fields(each, "title", "description", "of", "type", "unit", "choices")
        | drop_unknown(
            {
                "range": [str(limit) for limit in each.range] if each.range else None,
                "required": each.required or None,
            }
        )
        for each in architecture.properties.values()
    }
    return drop_unknown(
        {"properties": properties, "glossary": {t.term: t.text for t in architecture.glossary.values()}}
    )


def _record_requirement(lookup: Lookup, requirement: Requirement) -> dict[str, object]:
    servers = {
        "served_by": [component.id for component in lookup.components_for_requirement.get(requirement.id, ())],
        "served_by_chains": [chain.id for chain in lookup.chains_for_requirement.get(requirement.id, ())],
        "urls": dict(requirement.urls),
        **record_annotations(requirement),
        "parent": list(requirement.parents),
        "verified_by": [{"kind": each.kind, "text": each.text} for each in requirement.verified_by],
    }
    known_fields = pick_fields(
        requirement, "title", "description", "kind", "priority", "rationale", "source", "use_cases", "tags"
    )
    return known_fields | drop_unknown(dict(servers))


def _record_group(lookup: Lookup, group: Group) -> dict[str, object]:
    component_ids = [component.id for component in lookup.shown_components(group.id)]
    fields = pick_fields(group, "title", "description", "owner", "co_owners", "tags")
    return fields | drop_unknown({"components": component_ids, "urls": dict(group.urls), **record_annotations(group)})


def _record_chain(chain: Chain) -> dict[str, object]:
    through = [{"kind": point.kind, "id": point.id} for point in chain.through]
    fields = {"through": through, "deadline": record_quantity(chain.deadline, "ns")}
    return pick_fields(chain, "title", "requirements") | drop_unknown(dict(fields)) | record_annotations(chain)


def _record_flow(lookup: Lookup, output_id: str) -> dict[str, object]:
    """Return what flows along an edge: type and message of the output, and whether it is physical."""
    port = lookup.architecture.outputs[output_id]
    return {"type": port.type, "message": lookup.architecture.message_of(port), "physical": is_physical(port) or None}
