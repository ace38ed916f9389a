"""What two partners have still to settle about an interface, in words for a contract.

Only what stands between the two: the project's other findings are its own business, and no part of an agreement.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from archgen.analyses.port_types import is_expected_type
from archgen.analyses.qos_compatibility import find_qos_conflicts
from archgen.model.node import Endpoint
from archgen.model.partner_interfaces import PartnerInterface, list_givers
from archgen.model.ros_distro import is_ros_1
from archgen.timing.analysis import ChainResult
from archgen.timing.system.activity_builder import ActivityNames
from archgen.views.agreement.interface_timing import judge_sent_gaps
from archgen.views.agreement.promise_rows import QOS_OFFERED, RATE, TermName
from archgen.views.lookup import Lookup
from archgen.views.timing import value_format

_OPEN_SENTENCES = {
    "type": "The type of what flows is not agreed.",
    "message": "The message is not agreed.",
    "fields": "The fields of the message are not stated here: its definition is not at hand.",
    RATE.key: "No rate is promised{of_node}, and none can be expected from what is known.",
    "size": "The size of a message is not known.",
    "response": "Nobody promises within what time{of_node} an answer comes, and it cannot be told from what is known.",
    QOS_OFFERED.key: "No quality of service is promised: ROS's default counts.",
}
"""What to say of a term that is open, by its key."""


def describe_open_term(name: TermName) -> str:
    """Return a sentence about a term that is not settled, such as the rate or the rate of one of several nodes."""
    return _OPEN_SENTENCES[name.key].format(of_node=f" by `{name.node}`" if name.node else "")


def find_contradictions(lookup: Lookup, activity_names: ActivityNames, interface: PartnerInterface) -> Iterator[str]:
    """Yield a sentence for all in which both sides, or a promise and what is expected, do not fit together."""
    architecture = lookup.architecture
    output = interface.output
    for input_port in interface.inputs:
        if output and output.type and input_port.type and not is_expected_type(architecture, input_port.type, output):
            component = architecture.components[input_port.component].title
            yield f"{component} expects `{input_port.type}` as `{input_port.name}`, and is given `{output.type}`."
    if interface.flow == "topic" and not is_ros_1(architecture.distro):
        yield from _find_qos_clashes(lookup, interface)
    for endpoint in list_givers(lookup.architecture, interface):
        judged = judge_sent_gaps(lookup, activity_names, endpoint)
        yield from (each.sentence for each in judged if each.state == "broken")


def find_late_chains(lookup: Lookup, chains: Iterable[ChainResult]) -> Iterator[str]:
    """Yield a sentence for each chain that misses its deadline, or that nothing proves to meet it."""
    for chain in chains:
        if chain.verdict in {"missed", "not proven"} and chain.deadline:
            bound, deadline = value_format.display_duration(chain.bound), value_format.display_duration(chain.deadline)
            title = lookup.architecture.chains[chain.id].title
            yield f"{title} has to be done within {deadline}; expected at the latest: {bound}."


def _find_qos_clashes(lookup: Lookup, interface: PartnerInterface) -> Iterator[str]:
    for writer in _list_written(lookup, interface.giver_endpoints):
        for reader in _list_written(lookup, interface.taker_endpoints):
            conflicts = tuple(find_qos_conflicts(writer.qos, reader.qos)) if writer.label == reader.label else ()
            if conflicts:
                requests = " and ".join(conflict.requested for conflict in conflicts)
                offers = " and ".join(conflict.offered for conflict in conflicts)
                yield f"`{reader.node}` asks for {requests}, and `{writer.node}` offers {offers}: nothing arrives."


def _list_written(lookup: Lookup, endpoints: Iterable[Endpoint]) -> list[Endpoint]:
    return [endpoint for endpoint in endpoints if lookup.architecture.nodes[endpoint.node].written]
