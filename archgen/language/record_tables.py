"""How the resolved record is written. Made by `make language` from the description in `language/`: edit that, never this.

What stands at a key: `flag` where only true is written, a unit for a quantity in it, the name of a part with keys of its
own (`part[]` for a list of such, `part{}` for a mapping by id), `annotations`; an empty text for plain data.
"""

# fmt: off
from __future__ import annotations

from collections.abc import Mapping

RECORD_SECTIONS: Mapping[str, str] = {
    "archgen_resolved": "", "project": "project", "partners": "partner{}", "use_cases": "use_case{}",
    "requirements": "requirement{}", "properties": "property_declaration{}", "glossary": "", "groups": "group{}",
    "components": "component{}", "composed": "composed{}", "component_types": "component_type{}",
    "connections": "connection[]", "edges": "edge[]", "nodes": "node{}", "topics": "topic[]", "channels": "channel[]",
    "types": "type{}", "hosts": "host{}", "containers": "container{}", "resources": "resource{}", "links": "link{}",
    "frames": "frame{}", "chains": "chain{}", "variants": "variant{}", "milestones": "milestone{}",
}
"""The members of the record in their order, and what stands there."""
LASTING_SECTIONS: frozenset[str] = frozenset({
    "archgen_resolved", "chains", "components", "connections", "containers", "edges", "groups", "hosts", "links",
    "nodes", "partners", "project", "requirements", "topics", "types", "use_cases",
})
"""Those that are written where they are empty, too."""
RECORD_KEYS: Mapping[str, Mapping[str, str]] = {
    "project": {
        "id": "", "title": "", "version": "", "description": "", "license": "", "middleware": "", "distro": "",
        "parameters": "", "environment": "", "discovery": "",
    },
    "partner": {
        "title": "", "description": "", "contact": "", "reviewers": "", "properties": "annotations",
        "hints": "annotations",
    },
    "use_case": {
        "title": "", "description": "", "actors": "", "steps": "step[]", "properties": "annotations",
        "hints": "annotations",
    },
    "requirement": {
        "title": "", "description": "", "kind": "", "priority": "", "rationale": "", "source": "", "use_cases": "",
        "tags": "", "served_by": "", "served_by_chains": "", "urls": "", "properties": "annotations",
        "hints": "annotations", "parent": "", "verified_by": "verification[]",
    },
    "property_declaration": {
        "title": "", "description": "", "of": "", "type": "", "unit": "", "choices": "", "range": "",
        "required": "flag",
    },
    "group": {
        "title": "", "description": "", "owner": "", "co_owners": "", "tags": "", "components": "", "urls": "",
        "properties": "annotations", "hints": "annotations",
    },
    "component": {
        "title": "", "group": "", "parent": "", "is": "", "is_reference": "flag", "owner": "", "co_owners": "",
        "role": "", "functionality": "", "description": "", "requirements": "", "performance": "indicator{}",
        "inputs": "input{}", "outputs": "output{}", "parameters": "parameter{}", "open": "",
        "operations": "operation{}", "nodes": "", "timing": "timing", "tags": "", "urls": "", "status": "",
        "contact": "", "image": "", "properties": "annotations", "hints": "annotations",
    },
    "composed": {
        "title": "", "group": "", "parent": "", "is": "", "is_reference": "flag", "owner": "", "co_owners": "",
        "role": "", "functionality": "", "description": "", "requirements": "", "performance": "indicator{}",
        "inputs": "input{}", "outputs": "output{}", "parameters": "parameter{}", "open": "",
        "operations": "operation{}", "nodes": "", "timing": "timing", "tags": "", "urls": "", "status": "",
        "contact": "", "image": "", "properties": "annotations", "hints": "annotations", "components": "", "behind": "",
    },
    "component_type": {
        "title": "", "owner": "", "functionality": "", "description": "", "status": "", "contact": "", "image": "",
        "is": "", "generic": "", "abstract": "flag", "version": "", "deprecated": "deprecation", "inputs": "",
        "outputs": "", "components": "", "parameters": "parameter{}", "open": "", "operations": "operation{}",
        "frames": "frame{}", "properties": "annotations", "hints": "annotations",
    },
    "connection": {
        "input": "", "kind": "", "target": "", "outputs": "", "shell_port": "", "is_made": "flag",
    },
    "edge": {
        "from": "", "to": "", "type": "", "message": "", "physical": "flag",
    },
    "node": {
        "title": "", "description": "", "owner": "", "name": "", "namespace": "", "package": "", "executable": "",
        "plugin": "", "language": "", "container": "", "host": "", "threads": "", "scheduling": "", "status": "",
        "full_name": "", "kind": "", "command": "", "arguments": "", "remaps": "", "start": "start", "co_owners": "",
        "implements": "", "callback_groups": "", "reentrant": "flag", "derived": "flag", "endpoints": "endpoint[]",
        "timing": "timing{}", "parameters": "", "parameter_files": "", "parameter_commands": "",
        "effective_parameters": "effective_parameter{}", "own_name": "", "inner_nodes": "", "observed": "flag",
        "tags": "", "urls": "", "properties": "annotations", "hints": "annotations",
    },
    "topic": {
        "name": "", "flow": "", "messages": "", "types": "", "writers": "", "readers": "", "size": "B",
    },
    "channel": {
        "name": "", "medium": "", "flow": "", "types": "", "writers": "", "readers": "", "size": "B",
    },
    "type": {
        "message": "", "comment": "", "status": "", "request": "", "response": "", "feedback": "", "frame": "",
        "values": "", "generic": "", "version": "", "deprecated": "deprecation", "size": "B", "fields": "field[]",
        "part_fields": "part_fields", "constants": "constant{}", "properties": "annotations", "hints": "annotations",
    },
    "host": {
        "title": "", "description": "", "cores": "", "tags": "", "scheduling": "", "address": "",
        "discovery_server": "", "environment": "", "properties": "annotations", "hints": "annotations",
    },
    "container": {
        "title": "", "host": "", "threads": "", "scheduling": "", "name": "", "package": "", "executable": "",
        "namespace": "", "parameters": "", "properties": "annotations", "hints": "annotations",
    },
    "resource": {
        "title": "", "host": "", "scheduling": "", "properties": "annotations", "hints": "annotations",
    },
    "link": {
        "title": "", "connects": "", "devices": "", "protocol": "", "bandwidth": "bit/s", "best": "ns", "worst": "ns",
        "owner": "", "properties": "annotations", "hints": "annotations",
    },
    "frame": {
        "title": "", "parent": "", "by": "", "rate": "Hz", "static": "flag", "properties": "annotations",
        "hints": "annotations",
    },
    "chain": {
        "title": "", "requirements": "", "through": "waypoint[]", "deadline": "ns", "properties": "annotations",
        "hints": "annotations", "deadline_shares": "ns{}",
    },
    "variant": {
        "title": "", "description": "", "of": "", "without": "", "drop": "", "changes": "",
    },
    "milestone": {
        "title": "", "description": "", "date": "", "needs": "", "properties": "annotations", "hints": "annotations",
    },
    "step": {
        "from": "step_place", "to": "step_place", "say": "", "outputs": "", "inputs": "",
    },
    "verification": {
        "kind": "", "text": "",
    },
    "indicator": {
        "title": "", "accuracy": "", "execution_time": "ns",
    },
    "input": {
        "id": "", "type": "", "medium": "", "external": "", "frame": "", "description": "", "urls": "",
        "properties": "annotations", "hints": "annotations", "optional": "flag", "freshness": "ns", "sources": "",
    },
    "output": {
        "id": "", "type": "", "medium": "", "external": "", "frame": "", "description": "", "urls": "",
        "properties": "annotations", "hints": "annotations", "promise": "promise", "version": "",
        "deprecated": "deprecation", "message": "", "readers": "",
    },
    "parameter": {
        "type": "", "unit": "", "description": "", "visibility": "", "range": "", "choices": "", "value": "",
        "read_only": "flag", "from": "", "hints": "",
    },
    "operation": {
        "title": "", "call": "", "visibility": "", "description": "", "request": "", "response": "",
    },
    "timing": {
        "behaviour": "", "rate": "Hz", "period": "ns", "jitter": "ns", "wcet": "ns", "bcet": "ns", "throttle": "ns",
        "deadline": "ns", "response": "ns", "percentiles": "ns{}", "wcet_measured": "flag", "trigger": "trigger",
        "every": "", "dropped": "", "inputs": "timing_input{}", "outputs": "timing_output{}", "calls": "",
        "uses": "timing_use{}", "priority": "", "core": "", "cores": "",
    },
    "deprecation": {
        "text": "", "until": "", "use": "", "replacement": "",
    },
    "start": {
        "phase": "", "after": "", "ready": "start_ready", "respawn": "flag", "respawn_delay": "ns", "environment": "",
        "directory": "", "user": "", "once": "flag", "state": "", "by": "",
    },
    "endpoint": {
        "use": "", "name": "", "own_name": "", "program_name": "", "from": "evidence{}", "unknown": "", "flow": "",
        "message": "", "type": "", "port": "", "internal": "flag", "sources": "", "qos": "qos", "qos_override": "",
        "qos_if_ignored": "qos", "domain": "", "clock": "", "runs": "",
    },
    "effective_parameter": {
        "origin": "", "value": "",
    },
    "field": {
        "name": "", "type": "", "default": "", "unit": "", "comment": "", "ros_type": "",
    },
    "part_fields": {
        "request": "field[]", "response": "field[]", "feedback": "field[]",
    },
    "constant": {
        "type": "", "value": "", "comment": "",
    },
    "waypoint": {
        "kind": "", "id": "",
    },
    "step_place": {
        "kind": "", "id": "",
    },
    "promise": {
        "rate": "Hz", "max_gap": "ns", "max_age": "ns", "unit": "", "frame": "", "range": "value_range",
    },
    "trigger": {
        "mode": "", "inputs": "", "within": "ns",
    },
    "timing_input": {
        "wcet": "ns", "bcet": "ns", "stored": "", "memory": "",
    },
    "timing_output": {
        "conditional": "flag", "max_gap": "ns",
    },
    "timing_use": {
        "max": "ns", "min": "ns",
    },
    "start_ready": {
        "port": "", "file": "", "topic": "", "service": "", "log": "", "wait": "ns", "within": "ns",
    },
    "evidence": {
        "by": "", "rule": "", "at": "",
    },
    "qos": {
        "profile": "", "reliability": "", "durability": "", "history": "", "depth": "", "liveliness": "",
        "deadline": "ns", "lifespan": "ns", "lease_duration": "ns",
    },
    "value_range": {
        "text": "", "least": "", "greatest": "",
    },
}
"""The keys of each part in their order, and what stands there."""
