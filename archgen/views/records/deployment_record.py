"""What the system runs on, in the resolved record: hosts, containers, resources and links."""

from __future__ import annotations

from archgen.model.architecture import Architecture
from archgen.model.deployment import Container, Host, Link
from archgen.views.records.record_values import drop_unknown, pick_fields, record_annotations, record_quantity, to_plain


def record_host(host: Host) -> dict[str, object]:
    """Return a host; `scheduling` is by core where single cores have an order of their own."""
    fields = pick_fields(host, "title", "description", "cores", "tags", "scheduling")
    by_core = {str(core): order for core, order in host.core_scheduling.items()}
    return fields | ({"scheduling": by_core} if by_core else {}) | record_annotations(host)


def record_container(container: Container) -> dict[str, object]:
    """Return a container; its namespace is left out where it is the root."""
    fields = pick_fields(container, "title", "host", "threads", "scheduling", "name", "package", "executable")
    own_namespace = {"namespace": container.namespace} if container.namespace != "/" else {}
    parameters = drop_unknown({"parameters": to_plain(container.parameters) or None})
    return fields | own_namespace | parameters | record_annotations(container)


def record_resources(architecture: Architecture) -> dict[str, object]:
    """Return the section of resources, empty in a project without any."""
    resources = architecture.resources.values()
    return drop_unknown(
        {
            "resources": {
                each.id: pick_fields(each, "title", "host", "scheduling") | record_annotations(each)
                for each in resources
            }
        }
    )


def record_link(link: Link) -> dict[str, object]:
    """Return a link with bandwidth (bit/s) and latency (ns)."""
    bandwidth = {"bandwidth": record_quantity(link.bandwidth, "bit/s")}
    latency = {"best": record_quantity(link.best, "ns"), "worst": record_quantity(link.worst, "ns")}
    return (
        pick_fields(link, "title", "connects", "devices", "protocol")
        | drop_unknown({**bandwidth, **latency})
        | record_annotations(link)
    )
