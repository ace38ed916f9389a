"""What nodes exchange over other media than ROS, gathered as topics are: by medium, and by the name that is written."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from archgen.derivation.port_endpoints import NodePart, filter_uses
from archgen.frozen import dataclass, field
from archgen.grouping import group_pairs
from archgen.model.architecture import Architecture, PortEdge
from archgen.model.component import Input, Output
from archgen.model.node import Endpoint, FlowKind, Topic
from archgen.model.port_media import make_channel_key, nature_of
from archgen.model.quantity import Quantity


@dataclass(slots=True)
class _ChannelUsers:
    """The nodes that use one channel."""

    medium: str
    name: str
    flow: FlowKind
    writers: list[Endpoint] = field(default_factory=list)
    readers: list[Endpoint] = field(default_factory=list)


def derive_channels(architecture: Architecture, node_parts: Mapping[str, tuple[NodePart, ...]]) -> dict[str, Topic]:
    """Return the channels by medium and name; of a port without a `topic` the name is the port's id.

    As with topics, the only node of a component carries all of its ports, several nodes what each lists.
    """
    edges = [edge for edge in architecture.edges if _is_other_edge(architecture, edge)]
    written_outputs = [each for each in architecture.outputs.values() if nature_of(each) == "other"]
    if not (edges or written_outputs):
        return {}
    parts_by_component = group_pairs((part.component.id, part) for parts in node_parts.values() for part in parts)
    channels: dict[str, _ChannelUsers] = {}
    keys_by_output: dict[str, dict[str, None]] = {}
    for output in dict.fromkeys([*(each.id for each in written_outputs), *(edge.output for edge in edges)]):
        written_output = architecture.outputs[output]
        writing_parts = parts_by_component.get(written_output.component, ())
        _add_writers(architecture, written_output, writing_parts, channels, keys_by_output)
    for edge in edges:
        entry = architecture.inputs[edge.input]
        for part in _carrying_parts(parts_by_component.get(entry.component, ()), entry):
            for key in keys_by_output.get(edge.output, ()):
                _add_reader(architecture, edge, part, channels[key])
    return {
        key: Topic(
            users.name,
            users.flow,
            messages=(),
            types=tuple(dict.fromkeys(each.type for each in users.writers if each.type)),
            writers=tuple(users.writers),
            readers=tuple(users.readers),
            size=_find_size(architecture, users.writers),
            medium=users.medium,
        )
        for key, users in channels.items()
    }


def _is_other_edge(architecture: Architecture, edge: PortEdge) -> bool:
    natures = nature_of(architecture.outputs[edge.output]), nature_of(architecture.inputs[edge.input])
    return "other" in natures and "physical" not in natures


def _carrying_parts(parts: Iterable[NodePart], port: Input | Output) -> Iterator[NodePart]:
    """Yield the nodes that carry a port: the only one of its component, or those that list it."""
    use_kinds = {"publishes", "serves"} if isinstance(port, Output) else {"subscribes", "calls"}
    for part in parts:
        if part.is_only_node or any(use.use in use_kinds for use in part.uses_by_port.get(port.id, ())):
            yield part


def _add_writers(
    architecture: Architecture,
    output: Output,
    parts: Iterable[NodePart],
    channels: dict[str, _ChannelUsers],
    keys_by_output: dict[str, dict[str, None]],
) -> None:
    medium = _find_medium(architecture, output)
    flow = architecture.flow_of(output)
    for part in _carrying_parts(parts, output):
        uses = filter_uses(part.uses_by_port.get(output.id, ()), {"publishes", "serves"})
        names = [topic for use in uses for topic in use.topics]
        for name in names or [output.id]:
            full_name = f"{medium} {name}"
            key = make_channel_key(full_name, flow)
            users = channels.setdefault(key, _ChannelUsers(medium, full_name, flow))
            users.writers.append(
                Endpoint(
                    node=part.node.id,
                    use="publishes" if flow == "topic" else "serves",
                    name=full_name,
                    flow=flow,
                    port=output.id,
                    component=output.component,
                    type=output.type,
                    written=bool(uses),
                    name_written=bool(names),
                    medium=medium,
                    at=uses[0].at if uses else output.at,
                )
            )
            keys_by_output.setdefault(output.id, {})[key] = None


def _find_medium(architecture: Architecture, output: Output) -> str:
    """Return what an output travels over; of one on ROS that is read otherwise, what its readers read it over."""
    if nature_of(output) == "other":
        return output.medium
    readers = (architecture.inputs[edge.input] for edge in architecture.edges if edge.output == output.id)
    return next(reader.medium for reader in readers if nature_of(reader) == "other")


def _add_reader(architecture: Architecture, edge: PortEdge, part: NodePart, users: _ChannelUsers) -> None:
    entry = architecture.inputs[edge.input]
    same = next((n for n, each in enumerate(users.readers) if (each.node, each.port) == (part.node.id, entry.id)), None)
    sources = users.readers[same].sources if same is not None else ()
    reader = Endpoint(
        node=part.node.id,
        use="subscribes" if users.flow == "topic" else "calls",
        name=users.name,
        flow=users.flow,
        port=entry.id,
        component=entry.component,
        type=entry.type or architecture.outputs[edge.output].type,
        sources=(*sources, edge.output),
        medium=users.medium,
        at=entry.at,
    )
    if same is None:
        users.readers.append(reader)
    else:
        users.readers[same] = reader


def _find_size(architecture: Architecture, writers: Iterable[Endpoint]) -> Quantity | None:
    types = (architecture.types.get(each.type or "") for each in writers)
    return max((each.size for each in types if each and each.size), key=lambda size: size.value, default=None)
