"""What holds where data is late or missing, as far as the model says it; nothing is added to that."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from archgen.model.node import Endpoint
from archgen.model.partner_interfaces import PartnerInterface, list_givers
from archgen.model.ros_distro import is_ros_1
from archgen.views.agreement.interface_timing import find_giver_timing
from archgen.views.agreement.output_promises import CountedPort
from archgen.views.lookup import Lookup


def list_missing_data_duties(
    lookup: Lookup, interface: PartnerInterface, ports: Sequence[CountedPort], giver: str, taker: str
) -> Iterator[str]:
    """Yield sentences on what each side, named by its title, promises or bears where data does not come in time.

    `ports` are the outputs whose word counts for its readers.
    """
    architecture = lookup.architecture
    givers = list_givers(lookup.architecture, interface)
    sentences: dict[str, None] = {}
    for endpoint in givers:
        output_timing = find_giver_timing(lookup, endpoint).outputs.get(endpoint.port or "")
        if interface.flow == "topic" and output_timing and output_timing.conditional:
            max_gap = output_timing.max_gap or next((each.promise.max_gap for each in ports), None)
            sentences[_describe_silence(giver, str(max_gap or ""))] = None
        if interface.flow == "topic" and not is_ros_1(architecture.distro):
            sentences |= dict.fromkeys(_describe_qos_limits(giver, endpoint))
    for promise in (each.promise for each in ports):
        if promise.max_gap and not any(f" {promise.max_gap} pass " in each for each in sentences):
            sentences[f"{giver} lets no more than {promise.max_gap} pass between two messages."] = None
        if promise.max_age:
            sentences[f"{giver} promises that what is read is no older than {promise.max_age}."] = None
    for input_port in interface.inputs:
        if input_port.optional:
            component = architecture.components[input_port.component].title
            sentences[f"{component} of {taker} works without it: its input `{input_port.name}` is optional."] = None
    yield from sentences


def _describe_silence(giver: str, max_gap: str) -> str:
    if max_gap:
        return f"It is sent only when there is something to send, but {giver} lets no more than {max_gap} pass between two messages."
    return f"It is sent only when there is something to send: {giver} does not promise how long it may be silent."


def _describe_qos_limits(giver: str, endpoint: Endpoint) -> Iterator[str]:
    """Yield what the quality of service promises: ROS 2 itself tells both sides where a deadline or lease is missed."""
    qos = endpoint.qos
    if qos.deadline:
        yield f"{giver} lets no more than {qos.deadline} pass between two messages (deadline of the quality of service)."
    if qos.lifespan:
        yield f"A message that is older than {qos.lifespan} is not delivered any more (lifespan)."
    if qos.lease_duration:
        yield f"{giver} counts as gone after {qos.lease_duration} without a sign of life (lease duration)."
