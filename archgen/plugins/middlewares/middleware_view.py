"""The view `middleware`: components with ports, methods, commands, parameters and periods, for any robotic middleware.

The rules are R1 to R5 of "A novel model-based approach to support development cycle of robotic arm applications".
"""

from __future__ import annotations

from archgen.plugin.findings import Diagnostic
from archgen.plugin.generating import GeneratedView, GenerationContext
from archgen.plugins.middlewares.middleware_classes import (
    collect_component_classes,
    list_classes,
    name_classes,
    record_inputs,
    record_outputs,
)
from archgen.plugins.middlewares.middleware_deployment import (
    connect_instances,
    number_interfaces,
    record_hosts,
    record_instance,
    require_interfaces,
)
from archgen.plugins.middlewares.middleware_names import drop_clashes, name_space
from archgen.plugins.middlewares.middleware_parameters import record_middleware_parameters
from archgen.plugins.middlewares.middleware_types import MiddlewareTypes


def make_view(context: GenerationContext) -> GeneratedView:
    """Return the classes with what they exchange, and what runs on which host.

    Names and connections are those of the whole architecture, also where only a part of it is asked for.
    """
    architecture = context.architecture
    types = MiddlewareTypes(architecture, name_space(architecture.project.id), context.backend)
    classes = collect_component_classes(context)
    unnamed, findings = name_classes(architecture, list_classes(classes))
    classes = {key: own for key, own in classes.items() if own.first.id not in unnamed}
    made = list_classes(classes)
    told: dict[str, list[Diagnostic]] = {}
    for own in made:
        told[own.words] = record_outputs(architecture, types, own)
        parameters, faults = record_middleware_parameters(context, own.components)
        own.record["parameters"] = parameters
        told[own.words] += faults
    for own in made:
        told[own.words] += record_inputs(architecture, types, own, classes)
    instances = {key: record_instance(context, architecture.components[key], own) for key, own in classes.items()}
    unplaced, clashes = drop_clashes(
        [(str(each["name"]), key, architecture.components[key].at) for key, each in instances.items()], "component"
    )
    instances = {key: each for key, each in instances.items() if key not in unplaced}
    for own in made:
        rates = [float(instances[each.id]["rate_hz"]) for each in own.components if each.id in instances]
        own.record["is_periodic"] = bool(rates) and all(rates)
        own.record["rate_hz"] = rates[0] if rates else 0.0
    number_interfaces(classes, instances.values())
    connections, unjoined = connect_instances(architecture, classes, instances)
    require_interfaces(context, instances, connections)
    hosts, host_clashes = record_hosts(context, instances.values(), connections)
    wanted = {key for key in context.wanted_components if key in instances}
    wanted_classes = [own for own in made if any(each.id in wanted for each in own.components)]
    wanted_hosts = [
        {**host, "instances": [each for each in host["instances"] if each["id"] in wanted]}
        for host in hosts
        if any(each["id"] in wanted for each in host["instances"])
    ]
    unjoined = [each for each in unjoined if architecture.inputs[str(each.element)].component in wanted]
    findings += clashes + unjoined + host_clashes + [each for own in wanted_classes for each in told[own.words]]
    data = {
        "title": architecture.project.title,
        "name": types.space,
        "records": types.records,
        "lists": types.lists,
        "timed": types.timed,
        "components": [own.record for own in wanted_classes],
        "instances": [each for key, each in instances.items() if key in wanted],
        "connections": [each for each in connections if {each["source_id"], each["target_id"]} & wanted],
        "hosts": wanted_hosts,
    }
    return GeneratedView(data, (*findings, *types.findings))
